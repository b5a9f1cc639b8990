"""Door: what is seen, as one file for an operator to keep: made anew each time it is asked for."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from urllib.parse import quote

from aiohttp import hdrs, web

from app.door.access import Visitor
from app.door.upstream import VISITOR, say
from app.motion.basics import InputError
from app.motion.door import HAND_IN


@dataclass
class HandIn:
    """``make`` gives the file's name and its bytes; it may block, and runs once at a time."""

    make: Callable[[], tuple[str, bytes]]
    _under_way: bool = False

    def add_routes(self, router: web.UrlDispatcher) -> None:
        """``GET /hand-in``."""
        router.add_get(HAND_IN, self.give)

    async def give(self, request: web.Request) -> web.StreamResponse:
        """The file."""
        if request[VISITOR] is not Visitor.OPERATOR:
            return say(403, "403: saving is for operators; this address only watches.")
        if self._under_way:
            return say(429, "429: it is being saved already; try again.")
        self._under_way = True
        try:
            name, body = await asyncio.to_thread(self.make)
        except InputError as error:
            return say(409, f"409: {error}")
        finally:
            self._under_way = False
        kept = f"attachment; filename*=UTF-8''{quote(name, safe='')}"
        headers = {hdrs.CONTENT_DISPOSITION: kept, hdrs.CONTENT_TYPE: "application/octet-stream"}
        return web.Response(body=body, headers=headers)
