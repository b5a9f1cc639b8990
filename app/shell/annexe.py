"""Shell: the town beside the walk: ``mover`` with simulated feet, a process behind the same locks."""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import sys
from asyncio.subprocess import DEVNULL, PIPE, Process
from collections.abc import Callable
from pathlib import Path
from urllib.parse import urlsplit

from app.door.access import Access
from app.motion.basics import InputError

ROOT = Path(__file__).parent.parent.parent
#: A first start compiles what hears the feet, but listens before.
PATIENCE_S = 60.0


class Annexe:
    """Belongs to one loop. ``say`` tells the person a line; ``address`` is where the town is, or empty."""

    def __init__(self, access: Access, say: Callable[[str], None]) -> None:
        self._access, self._say = access, say
        self.address = ""
        self._process: Process | None = None
        self._task: asyncio.Task[None] | None = None

    def open(self) -> None:
        """Begin to open the town; what becomes of it is said. One at a time."""
        if self._task is not None and not self._task.done():
            raise InputError(f"the town is open at {self.address}" if self.address else "the town is opening")
        self._say("Opening the town")
        self._task = asyncio.create_task(self._serve(), name="town")

    async def close(self) -> None:
        """End it with the walk."""
        if self._task is not None:
            self._task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._task

    async def _serve(self) -> None:
        """Until it ends: by itself, or with us."""
        command = ("-m", "app", "mover", "--no-open", "--port", "0", *door_arguments(self._access))
        env = environment(self._access)
        try:
            process = await asyncio.create_subprocess_exec(
                sys.executable, *command, env=env, stdin=DEVNULL, stdout=PIPE, stderr=DEVNULL
            )
        except OSError as error:
            self._say(f"The town could not be opened: {error.strerror}")
            return
        assert process.stdout is not None
        try:
            with contextlib.suppress(TimeoutError):
                first = await asyncio.wait_for(process.stdout.readline(), PATIENCE_S)
                self.address = address_in(first.decode("utf-8", "replace"))
            if not self.address:
                self._say("The town could not be opened: try `stridescope mover` in a terminal")
                return
            self._say("")
            while await process.stdout.read(4096):  # nobody reads the rest, and a full pipe would stop it
                pass
        finally:
            self.address = ""
            if process.returncode is None:
                process.terminate()
                await process.wait()


def address_in(line: str) -> str:
    """The address a greeting tells, without the token; empty where there is none."""
    found = re.search(r"https?://\S+", line)
    if found is None:
        return ""
    parts = urlsplit(found[0])
    return f"{parts.scheme}://{parts.netloc}/"


def door_arguments(access: Access) -> list[str]:
    """The same host and certificate."""
    chain = access.certificate
    locks = ["--tls-cert", str(chain.chain), "--tls-key", str(chain.key)] if chain else []
    return ["--host", access.host, *locks]


def environment(access: Access) -> dict[str, str]:
    """The same tokens: by the environment, which no list of processes shows."""
    tokens = {"STRIDESCOPE_TOKEN": access.operator, "STRIDESCOPE_VIEWER_TOKEN": access.viewer}
    path = os.pathsep.join([str(ROOT), *sys.path])
    others = {name: value for name, value in os.environ.items() if name not in tokens}
    return others | {name: token for name, token in tokens.items() if token} | {"PYTHONPATH": path}
