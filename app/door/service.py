"""Door: the service behind the port: who is let in, and to what."""

from __future__ import annotations

import asyncio
import logging
import socket
import ssl
from collections.abc import Awaitable, Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import aiohttp
import msgspec
from aiohttp import hdrs, web

from app.door import page
from app.door.counters import Counters
from app.door.entrance import GUESS_SECONDS, Entrance, guesses
from app.door.exposition import CONTENT_TYPE, exposition, of_counters
from app.door.files import Files
from app.door.filter import Rules
from app.door.gate import Refusal
from app.door.hand_in import HandIn
from app.door.ingest import Ingest
from app.door.listening import HEAD_SECONDS, Reception
from app.door.upstream import VISITOR, Upstream, open_session, say, say_starting
from app.motion.door import Measure

log = logging.getLogger(__name__)
# aiohttp would log the first line of a request that it cannot read, token and all.
_silent = logging.getLogger(f"{__name__}.aiohttp")
_silent.setLevel(logging.CRITICAL + 1)

_Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class Told(NamedTuple):
    """What the program tells who runs it."""

    health: Callable[[], Mapping[str, object]]
    measures: Callable[[], Iterable[Measure]]


@dataclass(frozen=True)
class Service:
    """Everything one door serves. ``run`` lives on the door's loop; nothing else touches it."""

    entrance: Entrance
    viser_port: int
    rules: Callable[[], Rules]
    told: Told
    extra_head: str
    counters: Counters
    ingest: Ingest
    files: Files | None = None
    hand_in: HandIn | None = None

    async def run(
        self,
        listener: socket.socket,
        secure: ssl.SSLContext | None,
        stopping: asyncio.Event,
        ready: Callable[[], None],
    ) -> None:
        """Serve on ``listener`` until ``stopping`` is set; then drop every connection."""
        async with open_session() as session:
            upstream = Upstream(session, self.viser_port, self.rules, self.extra_head, self.counters)
            runner = web.AppRunner(
                self._application(upstream),
                access_log=None,
                logger=_silent,
                handler_cancellation=True,
                keepalive_timeout=HEAD_SECONDS,
                lingering_time=0,
                shutdown_timeout=0.2,
            )
            await runner.setup()
            assert runner.server is not None
            reception = Reception(runner.server, self.counters, secure)
            accepting = asyncio.create_task(reception.accept(listener))
            ready()
            await stopping.wait()
            accepting.cancel()
            reception.drop_all()
            await runner.cleanup()

    def _application(self, upstream: Upstream) -> web.Application:
        application = web.Application(middlewares=[self._guard])
        application.on_response_prepare.append(_add_safe_headers)
        application.router.add_get("/healthz", self._tell_health)
        application.router.add_get("/metrics", self._tell_metrics)
        self.ingest.add_routes(application.router)
        application.router.add_get("/", upstream.give_page)
        application.router.add_get("/index.html", upstream.give_page)
        for more in (self.files, self.hand_in):
            if more is not None:
                more.add_routes(application.router)
        application.router.add_get("/{path:.*}", upstream.give_file)
        return application

    @web.middleware
    async def _guard(self, request: web.Request, handler: _Handler) -> web.StreamResponse:
        mine = self.ingest if self.ingest.concerns(request) else self.entrance
        judged = mine.judge(request)
        if isinstance(judged, Refusal):
            self.counters.refuse(judged.what)
            log.info("refused a request from %s: %s", request.remote, judged.line)
            await asyncio.sleep(GUESS_SECONDS if guesses(request) else 0.0)
            return self.entrance.turn_away(request, judged)
        if self.entrance.is_first_visit(request):
            return self.entrance.welcome(request, judged)
        request[VISITOR] = judged
        try:
            return await handler(request)
        except (web.HTTPException, ConnectionError):  # an answer in itself; a browser that left
            raise
        except aiohttp.ClientError:
            return say_starting()
        except Exception:
            log.exception("a request failed")
            return say(500, "500: something failed here; the program's log says what.")

    async def _tell_health(self, request: web.Request) -> web.Response:
        told = {"ok": True, **self.told.health()}
        body = msgspec.json.encode(told, enc_hook=str)
        return web.Response(body=body, content_type="application/json", status=200 if told["ok"] else 503)

    async def _tell_metrics(self, request: web.Request) -> web.Response:
        body = exposition((*of_counters(self.counters), *self.told.measures()))
        return web.Response(body=body.encode(), headers={hdrs.CONTENT_TYPE: CONTENT_TYPE})


async def _add_safe_headers(request: web.Request, response: web.StreamResponse) -> None:
    for name, value in page.SAFE_HEADERS.items():
        response.headers[name] = value
    response.headers.setdefault("Content-Security-Policy", page.NOTHING_POLICY)
