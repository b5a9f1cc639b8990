"""Shell: what a page asks of the library, done beside the loop that samples share: play, rename, upload."""

from __future__ import annotations

import asyncio
import math
import os
import sys
from asyncio.subprocess import DEVNULL, PIPE
from collections.abc import Callable, Coroutine
from dataclasses import asdict
from pathlib import Path
from typing import Any

from app.formats.gpx import turned
from app.home.key import key
from app.motion.basics import InputError
from app.motion.commands import Play, Rename, SetDeclination, Share
from app.motion.status import Reference, ShelfFile
from app.outputs.files import beside
from app.settings import Settings
from app.shell.aside import aside
from app.shell.shelf import SHARED, TRACK, Shelf, track
from app.sources.glanced import glanced
from app.sources.opening import open_source
from app.sources.source import Source
from app.warm import warm_up

ROOT = Path(__file__).parent.parent.parent
#: Between looks at the folder.
LOOK_S = 2.0


class Librarian:
    """Belongs to one loop. ``say`` tells the person a line; ``opened`` gets a source that is to be played."""

    def __init__(
        self,
        folder: Path,
        say: Callable[[str], None],
        opened: Callable[[str, Source], None],
        reference: Reference | None = None,
        declination_deg: float = 0.0,
    ) -> None:
        self.shelf = Shelf(folder)
        self.reference, self._declination_deg = reference, declination_deg
        self.files: tuple[ShelfFile, ...] = ()
        self._say, self._opened = say, opened
        self._sharing = False
        self._errands: set[asyncio.Task[None]] = set()
        self._opening: asyncio.Task[None] | None = None

    async def look(self) -> None:
        """See what is in the folder, now and then, for as long as the program runs."""
        while True:
            self.files = await asyncio.to_thread(self.shelf.files)
            await asyncio.sleep(LOOK_S)

    def take(self, command: Play | Rename | Share | SetDeclination, settings: Settings) -> None:
        """Begin what is asked for; what becomes of it is said. ``settings`` are the main track's."""
        match command:
            case Play(name):
                self._say(f"Opening {name}")
                if name.lower().endswith(TRACK):
                    self._send(self._compare(name))
                else:
                    self._open_next(self._play(name))
            case Rename(name, to):
                self._send(self._rename(name, to))
            case Share(name):
                self._send(self._share(name, settings))
            case SetDeclination(degrees):
                self._declination_deg = degrees
                if self.reference is not None:
                    self.reference = turned(self.reference, math.radians(degrees))

    def _send(self, errand: Coroutine[Any, Any, None]) -> asyncio.Task[None]:
        task = asyncio.create_task(self._told(errand))
        self._errands.add(task)
        task.add_done_callback(self._errands.discard)
        return task

    def _open_next(self, errand: Coroutine[Any, Any, None]) -> None:
        """A recording that is still being read when another is asked for is not wanted any more."""
        if self._opening is not None:
            self._opening.cancel()
        self._opening = self._send(errand)

    async def _told(self, errand: Coroutine[Any, Any, None]) -> None:
        try:
            await errand
        except InputError as error:
            self._say(str(error))

    async def _play(self, name: str) -> None:
        spec = f"replay:{await asyncio.to_thread(self.shelf.path, name)}"
        soon = await asyncio.to_thread(glanced, spec)
        if soon is not None:
            self._opened(spec, soon)
        await self._open(spec, True)

    async def _open(self, spec: str, changes: bool) -> None:
        """Read it, which may take seconds, and have it played."""
        self._opened(spec, await aside(lambda: opened(spec, changes), "open"))
        self._say("")

    def open(self, spec: str, changes: bool) -> None:
        """Play what a SPEC names, as soon as it is read."""
        self._open_next(self._open(spec, changes))

    async def _compare(self, name: str) -> None:
        """A GPS track does not take the walk's place: it is shown beside it."""
        path = await asyncio.to_thread(self.shelf.path, name)
        self.reference = await asyncio.to_thread(track, path, self._declination_deg)
        self._say("")

    async def _share(self, name: str, settings: Settings) -> None:
        """In a process of its own: it is long work, and samples come first."""
        if self._sharing:
            raise InputError("a page to share is being made already, one at a time")
        path = await asyncio.to_thread(self.shelf.path, name)
        into = path.with_suffix(SHARED)
        into = beside(into, "shared") if into.exists() else into
        told = [f"--set={key}={value}" for key, value in asdict(settings).items()]
        command = ("-m", "app", "export", f"replay:{path}", "--format", "html", "--out", str(into), *told)
        self._say(f"Making {into.name}: a minute or two for a long walk")
        self._sharing = True
        try:
            await self._run(command)
        finally:
            self._sharing = False
        self.files = await asyncio.to_thread(self.shelf.files)
        self._say(f"{into.name} is in the library: download it, it plays without a network")

    async def _run(self, command: tuple[str, ...]) -> None:
        environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
        process = await asyncio.create_subprocess_exec(
            sys.executable, *command, env=environment, stdout=DEVNULL, stderr=PIPE
        )
        try:
            _, trouble = await process.communicate()
        finally:
            if process.returncode is None:
                process.kill()
        if process.returncode:
            lines = trouble.decode(errors="replace").strip().splitlines()
            raise InputError(lines[-1] if lines else "the page could not be made")

    async def _rename(self, name: str, to: str) -> None:
        new = await asyncio.to_thread(self.shelf.rename, name, to)
        self.files = await asyncio.to_thread(self.shelf.files)
        self._say(f"{name} is now {new}")


def opened(spec: str, changes: bool) -> Source:
    """The source of a SPEC, ready to be played."""
    source = open_source(spec, changes=changes, stretches=True, key=key())
    if source.settings is not None:
        warm_up(source.settings.estimator)
    return source
