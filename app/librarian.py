"""Shell: what a page asks of the library, done beside the loop that samples share: play, rename, upload."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any

from app import motion as m
from app.shelf import Shelf
from app.sources.opening import open_source
from app.sources.source import Source
from app.warm import warm_up

#: Between looks at the folder.
LOOK_S = 2.0


class Librarian:
    """Belongs to one loop. ``say`` tells the person a line; ``opened`` gets a source that is to be played."""

    def __init__(
        self, folder: Path, say: Callable[[str], None], opened: Callable[[str, Source], None]
    ) -> None:
        self.shelf = Shelf(folder)
        self.files: tuple[m.ShelfFile, ...] = ()
        self._say, self._opened = say, opened
        self._errands: set[asyncio.Task[None]] = set()

    async def look(self) -> None:
        """See what is in the folder, now and then, for as long as the program runs."""
        while True:
            self.files = await asyncio.to_thread(self.shelf.files)
            await asyncio.sleep(LOOK_S)

    def take(self, command: m.Play | m.Rename) -> None:
        """Begin what is asked for; what becomes of it is said."""
        match command:
            case m.Play(name):
                self._say(f"Opening {name}")
                self._send(self._play(name))
            case m.Rename(name, to):
                self._send(self._rename(name, to))

    def _send(self, errand: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(self._told(errand))
        self._errands.add(task)
        task.add_done_callback(self._errands.discard)

    async def _told(self, errand: Coroutine[Any, Any, None]) -> None:
        try:
            await errand
        except m.InputError as error:
            self._say(str(error))

    async def _play(self, name: str) -> None:
        source = await asyncio.to_thread(self._open, name)
        self._opened(str(self.shelf.folder / name), source)
        self._say("")

    def _open(self, name: str) -> Source:
        source = open_source(f"replay:{self.shelf.path(name)}", stretches=True)
        if source.settings is not None:
            warm_up(source.settings.estimator)
        return source

    async def _rename(self, name: str, to: str) -> None:
        new = await asyncio.to_thread(self.shelf.rename, name, to)
        self.files = await asyncio.to_thread(self.shelf.files)
        self._say(f"{name} is now {new}")
