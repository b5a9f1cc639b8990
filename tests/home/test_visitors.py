"""Visitors' thresholds on disk: as they were, and a word for every file that is none."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.home import visitors
from app.motion.basics import InputError

VALUES: dict[str, float | bool] = {"on_radps": 0.412, "off_radps": 0.206, "sure_rad": 0.05, "swapped": True}


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(visitors, "folder", lambda: tmp_path / "visitors")
    return tmp_path


def test_what_is_kept_comes_back() -> None:
    assert visitors.names() == ()
    visitors.save("Ada L", VALUES)
    assert visitors.names() == ("Ada L",)
    assert visitors.load("Ada L") == VALUES


@pytest.mark.parametrize("name", ["", "../x", "a/b", ".x", "a" * 50, "x\n"])
def test_a_name_is_a_plain_name(name: str) -> None:
    with pytest.raises(InputError, match="visitor"):
        visitors.save(name, VALUES)
    with pytest.raises(InputError, match="visitor"):
        visitors.load(name)


@pytest.mark.parametrize(
    "text",
    [
        "on_radps = nan",
        "on_radps = true",
        "other = 1",
        "swapped = 1",
        "not toml",
        "on_radps = -1",
        "x" * 5000,
    ],
)
def test_a_file_that_is_none_is_one_line(home: Path, text: str) -> None:
    visitors.save("x", VALUES)
    visitors.place("x").write_text(text, "utf-8")
    with pytest.raises(InputError, match="visitor") as caught:
        visitors.load("x")
    assert "\n" not in str(caught.value)


def test_nobody_of_that_name() -> None:
    with pytest.raises(InputError, match="cannot be read"):
        visitors.load("nobody")
