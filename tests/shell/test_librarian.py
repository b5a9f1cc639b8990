"""What a page asks of the library happens beside the loop, and every trouble is a line for the person."""

from __future__ import annotations

import asyncio
import threading
from pathlib import Path

import pytest

from app.motion.basics import InputError
from app.motion.commands import Play, Rename, Seek, SetDeclination, Share
from app.motion.source import Link
from app.settings import Settings
from app.shell.librarian import Librarian
from app.shell.librarian import opened as opened_by_us
from app.sources.glanced import Glanced
from app.sources.source import Source
from tests.formats.test_glance import WHOLE
from tests.formats.walks import random_samples, write

GPX = '<gpx><trk><trkseg><trkpt lat="48" lon="11"/><trkpt lat="48.001" lon="11"/></trkseg></trk></gpx>'


def asked(
    folder: Path, *commands: Play | Rename | Share | SetDeclination
) -> tuple[Librarian, list[str], list[Source]]:
    """Each command after the one before has come to its end."""
    said: list[str] = []
    opened: list[Source] = []

    async def ask() -> Librarian:
        librarian = Librarian(folder, said.append, lambda spec, source: opened.append(source))
        for command in commands:
            librarian.take(command, Settings())
            while librarian._errands:
                await asyncio.sleep(0.01)
        return librarian

    return asyncio.run(ask()), said, opened


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "walk.mcap").write_bytes(write(random_samples(40)))
    (tmp_path / "way.gpx").write_text(GPX)
    (tmp_path / "broken.csv").write_text("t_s,foot\nnothing")
    return tmp_path


def test_a_recording_is_opened_with_the_settings_it_holds(folder: Path) -> None:
    _, said, (source,) = asked(folder, Play("walk.mcap"))
    assert source.info.name == "walk.mcap"
    assert source.settings == Settings()
    assert said[-1] == ""


def test_a_large_recording_shows_its_trails_until_it_is_read(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.sources.glanced.LEAST_BYTES", 0)
    (folder / "hour.mcap").write_bytes(WHOLE)
    _, _, (soon, source) = asked(folder, Play("hour.mcap"))
    assert isinstance(soon, Glanced)
    assert soon.info.outline is not None
    assert soon.link is Link.WAITING
    with pytest.raises(InputError, match=r"seek: hour\.mcap is still being read"):
        soon.control(Seek(1.0))
    assert source.info.outline is None
    assert source.info.name == "hour.mcap"


def test_a_gps_track_leaves_the_walk_where_it_is(folder: Path) -> None:
    librarian, _, opened = asked(folder, Play("way.gpx"))
    assert opened == []
    assert librarian.reference is not None
    assert librarian.reference.length_m == pytest.approx(111.2, abs=0.1)


def test_a_declination_turns_the_track_shown_and_those_to_come(folder: Path) -> None:
    librarian, _, _ = asked(folder, Play("way.gpx"), SetDeclination(90.0))
    assert librarian.reference is not None
    assert librarian.reference.segments[-1, 1].tolist() == pytest.approx([0.0, -111.2], abs=0.1)
    librarian, _, _ = asked(folder, SetDeclination(90.0), Play("way.gpx"))
    assert librarian.reference is not None
    assert librarian.reference.segments[-1, 1].tolist() == pytest.approx([0.0, -111.2], abs=0.1)


@pytest.mark.parametrize("name", ["none.mcap", "broken.csv", "../walk.mcap"])
def test_trouble_is_one_line(folder: Path, name: str) -> None:
    _, said, opened = asked(folder, Play(name))
    assert opened == []
    assert said[-1]
    assert "\n" not in said[-1]


def test_a_file_is_renamed_and_listed_so(folder: Path) -> None:
    librarian, said, _ = asked(folder, Rename("walk.mcap", "stairs"))
    assert "stairs.mcap" in {file.name for file in librarian.files}
    assert said == ["walk.mcap is now stairs.mcap"]


def test_who_asks_for_another_before_the_first_is_read_gets_the_other(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "other.mcap").write_bytes((folder / "walk.mcap").read_bytes())
    go_on = threading.Event()

    def slowly(spec: str, changes: bool) -> Source:
        if spec.endswith("walk.mcap"):
            go_on.wait(60.0)
        return opened_by_us(spec, changes)

    monkeypatch.setattr("app.shell.librarian.opened", slowly)
    opened: list[str] = []

    async def ask() -> None:
        desk = Librarian(folder, lambda _: None, lambda spec, source: opened.append(source.info.name))
        desk.take(Play("walk.mcap"), Settings())
        await asyncio.sleep(0.2)
        desk.take(Play("other.mcap"), Settings())
        while not opened:
            await asyncio.sleep(0.01)
        go_on.set()
        await asyncio.sleep(0.5)

    asyncio.run(asyncio.wait_for(ask(), 60.0))
    assert opened == ["other.mcap"]
