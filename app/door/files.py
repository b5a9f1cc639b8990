"""Door: recordings out and in: a file of the library to an operator, and a file that one sends.

What comes in is streamed to a file of its own in the library's folder, at most so many bytes; what becomes
of it is for the shell to say. An upload is no simple request in a browser's eyes (its content type), and its
Origin has been judged like every other's.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

from aiohttp import hdrs, web

from app.door.access import Visitor
from app.door.upstream import VISITOR, say
from app.formats.names import file_name
from app.motion.basics import InputError

log = logging.getLogger(__name__)

MOST_BYTES = 1_000_000_000
#: An upload that brings nothing for so long is over.
SILENT_SECONDS = 30.0
AT_ONCE = 2
_PIECE = 256 * 1024
_KIND = "application/octet-stream"
_NOT_YOURS = "403: recordings are for operators; this address only watches."


@dataclass
class Files:
    """The library's folder. ``receive`` takes a whole uploaded file and the name it was given; it may block,
    says in one line what became of it, and raises ``InputError`` where it is nothing we can open."""

    folder: Path
    receive: Callable[[Path, str], str]
    most_bytes: int = MOST_BYTES
    _under_way: int = 0

    def add_routes(self, router: web.UrlDispatcher) -> None:
        """``GET /files/NAME`` and ``POST /files?name=NAME``."""
        router.add_get("/files/{name}", self.give)
        router.add_post("/files", self.take)

    async def give(self, request: web.Request) -> web.StreamResponse:
        """A file of the library, to keep."""
        if request[VISITOR] is not Visitor.OPERATOR:
            return say(403, _NOT_YOURS)
        try:
            path = self.folder / file_name(request.match_info["name"])
        except InputError as error:
            return say(404, f"404: {error}")
        if path.is_symlink() or not path.is_file():
            return say(404, "404: there is no such recording.")
        disposition = f"attachment; filename*=UTF-8''{quote(path.name, safe='')}"
        return web.FileResponse(
            path, headers={hdrs.CONTENT_DISPOSITION: disposition, hdrs.CONTENT_TYPE: _KIND}
        )

    async def take(self, request: web.Request) -> web.Response:
        """A file that an operator sends; the answer's text is for the person."""
        if request[VISITOR] is not Visitor.OPERATOR:
            return say(403, _NOT_YOURS)
        if request.content_type != _KIND:
            return say(415, f"415: expected {_KIND}.")
        if self._under_way >= AT_ONCE:
            return say(429, f"429: {AT_ONCE} uploads are under way; try again when they are done.")
        self._under_way += 1
        try:
            return await self._take(request, file_name(request.query.get("name", "")))
        except InputError as error:
            return say(422, str(error))
        except TimeoutError:
            return say(408, f"408: nothing came for {SILENT_SECONDS:g} s.")
        except OSError as error:
            return say(507, f"507: cannot be kept: {error.strerror or error}")
        finally:
            self._under_way -= 1

    async def _take(self, request: web.Request, name: str) -> web.Response:
        most = self.most_bytes
        if (request.content_length or 0) > most:
            return say(413, f"413: {name}: {request.content_length} bytes, expected at most {most}.")
        self.folder.mkdir(parents=True, exist_ok=True)
        with _new_part(self.folder) as part:
            size = 0
            while piece := await asyncio.wait_for(request.content.read(_PIECE), SILENT_SECONDS):
                size += len(piece)
                if size > most:
                    return say(413, f"413: {name}: expected at most {most} bytes.")
                await asyncio.to_thread(part.write, piece)
            part.flush()
            told = await asyncio.to_thread(self.receive, Path(part.name), name)
        log.info("took an upload of %d bytes", size)
        return say(200, told)


@contextlib.contextmanager
def _new_part(folder: Path) -> Any:
    """A hidden file that goes in the end, unless it has been moved elsewhere."""
    with tempfile.NamedTemporaryFile(dir=folder, prefix=".upload-", suffix=".part", delete=False) as part:
        try:
            yield part
        finally:
            Path(part.name).unlink(missing_ok=True)
