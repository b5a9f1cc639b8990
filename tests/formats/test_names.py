"""Whatever a browser calls a file, it stays in its folder."""

from __future__ import annotations

import unicodedata
from pathlib import Path, PurePosixPath, PureWindowsPath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.names import file_name, with_suffix_of
from app.motion.basics import InputError

nasty = st.text() | st.lists(
    st.sampled_from(["..", ".", "/", "\\", "a", "~", "\0", "\n", "C:", "é", " "])
).map("".join)


@given(nasty, nasty)
def test_a_name_never_leaves_its_folder(text: str, old: str) -> None:
    for name in (file_name, lambda typed: with_suffix_of(typed, old)):
        try:
            found = name(text)
        except InputError as error:
            assert "\n" not in str(error)
            continue
        for path in (PurePosixPath, PureWindowsPath):
            assert path("folder", found).parent == path("folder")
            assert path(found).name == found
        assert Path("/folder", found).resolve().parent == Path("/folder")
        assert found.isprintable()
        assert not found.startswith(".")
        assert file_name(found) == found


@pytest.mark.parametrize("name", ["walk.mcap", "2026-11-22T02-09-11_papers_demo.mcap", "Gehen mit Ä (2).csv"])
def test_an_honest_name_is_kept(name: str) -> None:
    assert file_name(name) == unicodedata.normalize("NFC", name)


@pytest.mark.parametrize(
    "name", ["", " ", ".", "..", ".hidden", "a/b", "a\\b", "a\0", "x" * 200, "a:b", "\ud800"]
)
def test_another_is_one_line(name: str) -> None:
    with pytest.raises(InputError, match="file name"):
        file_name(name)


def test_a_renamed_file_keeps_its_suffix() -> None:
    assert with_suffix_of("stairs", "walk.mcap") == "stairs.mcap"
    assert with_suffix_of("stairs.MCAP", "walk.mcap") == "stairs.MCAP"
    assert with_suffix_of("stairs.html", "walk.mcap") == "stairs.html.mcap"
