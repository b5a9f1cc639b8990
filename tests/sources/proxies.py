"""A network that can be cut: a TCP proxy on loopback whose connections stall, break and are refused."""

from __future__ import annotations

import asyncio
from contextlib import suppress


class Cable:
    """Carries bytes both ways between its own port and ``target`` while ``whole``.

    ``cut`` breaks what is connected and refuses more; ``stall`` keeps connections and carries nothing.
    """

    def __init__(self, target: int) -> None:
        self.port = 0
        self.connections = 0
        self._target = target
        self._server: asyncio.Server | None = None
        self._writers: list[asyncio.StreamWriter] = []
        self._flowing = asyncio.Event()
        self._flowing.set()

    async def plug_in(self) -> None:
        self._server = await asyncio.start_server(self._join, "127.0.0.1", self.port)
        self.port = self._server.sockets[0].getsockname()[1]

    def cut(self) -> None:
        assert self._server is not None
        self._server.close()
        for writer in self._writers:
            writer.transport.abort()
        self._writers = []

    def stall(self, on: bool) -> None:
        (self._flowing.clear if on else self._flowing.set)()

    async def _join(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.connections += 1
        there, back = await asyncio.open_connection("127.0.0.1", self._target)
        self._writers += [writer, back]
        with suppress(asyncio.CancelledError):  # the loop ends
            await asyncio.gather(self._carry(reader, back), self._carry(there, writer))

    async def _carry(self, source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
        with suppress(OSError):
            while data := await source.read(4096):
                await self._flowing.wait()
                sink.write(data)
                await sink.drain()
        sink.close()
