import os
from pathlib import Path

import pytest

from app.formats.plain import HEADER
from app.motion.basics import InputError
from app.sources import files
from app.sources.files import load

ROWS = "".join(f"{i / 100},foot,0,0,-9.8,0,0,0,,,\n" for i in range(50))


@pytest.fixture
def walk(tmp_path: Path) -> Path:
    path = tmp_path / "walk.csv"
    path.write_text(f"{HEADER}\n{ROWS}")
    return path


def test_a_recording_and_what_is_told_of_it(walk: Path) -> None:
    assert load(walk).name == "walk.csv"
    assert load(str(walk), {"foot": "left"}).sensors[0].sensor == "left"


def test_no_file_a_folder_a_bad_name(tmp_path: Path) -> None:
    for path, words in (
        (tmp_path / "none.csv", "no such file"),
        (tmp_path, "a folder"),
        (tmp_path / "a\0b", "no such file|cannot be read"),
        ("x" * 5000, "cannot be read|no such file"),
        ("/dev/null", "not a regular file"),
        ("two\nlines.csv", r"two\?lines.csv: no such file"),
        ("~nobody-at-all/walk.csv", "no such"),
    ):
        with pytest.raises(InputError, match=words) as error:
            load(path)
        assert "\n" not in str(error.value)


def test_a_file_nobody_may_read(walk: Path) -> None:
    if os.geteuid() == 0:
        pytest.skip("root may read everything")
    walk.chmod(0)
    with pytest.raises(InputError, match="cannot be read"):
        load(walk)


def test_a_file_that_is_too_large(walk: Path, monkeypatch) -> None:
    monkeypatch.setattr(files, "MOST_BYTES", 100)
    with pytest.raises(InputError, match="GB, expected at most"):
        load(walk)


def test_options_are_checked_before_the_file(walk: Path) -> None:
    with pytest.raises(InputError, match="rate='fast'"):
        load(walk, {"rate": "fast"})
