"""The library's folder: what is in it, and that nothing is overwritten or taken from elsewhere."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.motion.basics import InputError
from app.shell.shelf import Shelf, track
from tests.formats.walks import random_samples, write

WALK = write(random_samples(40))


@pytest.fixture
def shelf(tmp_path: Path) -> Shelf:
    folder = tmp_path / "recordings"
    folder.mkdir()
    (folder / "walk.mcap").write_bytes(WALK)
    (folder / ".upload-x.part").write_bytes(b"half")
    (folder / "notes.pdf").write_bytes(b"%PDF")
    (tmp_path / "secret.csv").write_text("secret")
    (folder / "link.csv").symlink_to(tmp_path / "secret.csv")
    return Shelf(folder)


def test_recordings_are_listed_and_nothing_else(shelf: Shelf) -> None:
    assert [(file.name, file.size_bytes) for file in shelf.files()] == [("walk.mcap", len(WALK))]


def test_a_folder_that_is_not_there_is_empty(tmp_path: Path) -> None:
    assert Shelf(tmp_path / "none").files() == ()


@pytest.mark.parametrize("name", ["../secret.csv", "link.csv", "none.mcap", "", "/etc/passwd"])
def test_only_its_own_files_are_given(shelf: Shelf, name: str) -> None:
    with pytest.raises(InputError):
        shelf.path(name)


def test_a_file_is_renamed_but_never_over_another(shelf: Shelf) -> None:
    assert shelf.rename("walk.mcap", "stairs") == "stairs.mcap"
    (shelf.folder / "walk.mcap").write_bytes(b"other")
    with pytest.raises(InputError, match="already"):
        shelf.rename("walk.mcap", "stairs.mcap")
    assert (shelf.folder / "stairs.mcap").read_bytes() == WALK
    assert (shelf.folder / "walk.mcap").read_bytes() == b"other"
    with pytest.raises(InputError):
        shelf.rename("walk.mcap", "../walk")


def test_an_upload_is_kept_under_a_free_name(shelf: Shelf) -> None:
    part = shelf.folder / ".upload-x.part"
    part.write_bytes(WALK)
    assert "40 samples" in shelf.receive(part, "walk.mcap")
    assert (shelf.folder / "walk_uploaded.mcap").read_bytes() == WALK


def test_an_upload_that_is_no_recording_is_told_by_its_own_name(shelf: Shelf) -> None:
    with pytest.raises(InputError, match=r"^photo\.csv: begins with 'half'"):
        shelf.receive(shelf.folder / ".upload-x.part", "photo.csv")
    assert not (shelf.folder / "photo.csv").exists()


def test_a_gps_track_is_kept_and_turned(shelf: Shelf) -> None:
    part = shelf.folder / ".upload-x.part"
    part.write_text(
        '<gpx><trk><trkseg><trkpt lat="48" lon="11"/><trkpt lat="48.001" lon="11"/></trkseg></trk></gpx>'
    )
    assert shelf.receive(part, "gps.gpx") == "gps.gpx: GPX track, 111 m"
    found = track(shelf.folder / "gps.gpx", 90.0)
    assert found.segments[-1, 1].tolist() == pytest.approx([0.0, -111.2], abs=0.1)
    with pytest.raises(InputError, match="declination"):
        track(shelf.folder / "gps.gpx", 999.0)
