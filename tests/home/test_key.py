"""The user's key: made once, kept, readable by the user only."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.home import key as keys


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(keys, "path", lambda: tmp_path / "stridescope" / "key")
    return tmp_path


def test_it_is_made_once_and_is_the_users(folder: Path) -> None:
    made = keys.key()
    assert len(made) == keys.LENGTH
    assert keys.key() == made == keys.path().read_bytes()
    assert keys.path().stat().st_mode & 0o077 == 0
    assert [path.name for path in keys.path().parent.iterdir()] == ["key"]


@pytest.mark.parametrize("content", [b"", b"short"])
def test_something_else_in_its_place_is_left_alone(content: bytes) -> None:
    keys.path().parent.mkdir()
    keys.path().write_bytes(content)
    assert len(keys.key()) == keys.LENGTH
    assert keys.key() == keys.key()
    assert keys.path().read_bytes() == content


def test_where_none_can_be_kept_there_is_one_for_this_run(folder: Path) -> None:
    (folder / "stridescope").write_text("a file where the folder should be")
    assert keys.key() == keys.key()
    assert len(keys.key()) == keys.LENGTH
