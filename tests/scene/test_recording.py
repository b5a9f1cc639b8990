"""The recording on the page: what is shown, and that names never become markup."""

from __future__ import annotations

from app.motion.status import RecorderState
from app.scene.recording import banner, line
from tests.scene.fakes import status

STATE = RecorderState("<b>x.mcap", True, 75.0, 3_400_000, 12_300_000_000)


def test_a_recording_shows_time_size_and_room() -> None:
    text = line(status(recording=STATE))
    for words in ("REC", "1:15", "3 MB", "12.3 GB free", "&lt;b&gt;x.mcap"):
        assert words in text
    assert "<b>" not in text


def test_no_recording_says_so() -> None:
    assert "Not recording" in line(status())
    assert banner(status()) == ""


def test_trouble_is_a_banner() -> None:
    assert "No space" in banner(status(recording=STATE._replace(trouble="No space <left>", on=False)))
    assert "<left>" not in banner(status(recording=STATE._replace(trouble="<left>")))
    assert "Recorded" in line(status(recording=STATE._replace(on=False)))
