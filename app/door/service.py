"""Door: the service behind the port: who is let in, and to what."""

from __future__ import annotations

import asyncio
import logging
import socket
import ssl
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass

import aiohttp
import msgspec
from aiohttp import hdrs, web

from app.door import page
from app.door.access import Visitor, is_loopback
from app.door.counters import Counters
from app.door.filter import Rules
from app.door.gate import Gate, Refusal
from app.door.listening import HEAD_SECONDS, Reception
from app.door.upstream import VISITOR, Upstream, is_websocket, open_session, say, say_starting, without_token

log = logging.getLogger(__name__)
# aiohttp would log the first line of a request that it cannot read, token and all.
_silent = logging.getLogger(f"{__name__}.aiohttp")
_silent.setLevel(logging.CRITICAL + 1)

_Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


@dataclass(frozen=True)
class Service:
    """Everything one door serves. ``run`` lives on the door's loop; nothing else touches it."""

    gate: Gate
    viser_port: int
    rules: Callable[[], Rules]
    health: Callable[[], Mapping[str, object]]
    extra_head: str
    counters: Counters

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
        application.router.add_get("/", upstream.give_page)
        application.router.add_get("/index.html", upstream.give_page)
        application.router.add_get("/{path:.*}", upstream.give_file)
        return application

    @web.middleware
    async def _guard(self, request: web.Request, handler: _Handler) -> web.StreamResponse:
        judged = self._judge(request)
        if isinstance(judged, Refusal):
            self.counters.refuse(judged.what)
            log.info("refused a request from %s: %s", request.remote, judged.line)
            return say(judged.status, judged.line)
        if self._is_first_visit(request):
            return self._welcome(request, judged)
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

    def _judge(self, request: web.Request) -> Visitor | Refusal:
        headers = request.headers
        refusal = self.gate.check_site(
            headers.getall(hdrs.HOST, []), headers.getall(hdrs.ORIGIN, []), is_websocket(request)
        )
        if refusal is not None:
            return refusal
        if request.path == "/healthz" and is_loopback(request.remote or ""):
            return Visitor.VIEWER
        if self._is_first_visit(request):
            return self.gate.check_token(request.query["token"])
        return self.gate.check_cookie(request.cookies.get(self.gate.cookie_name))

    def _is_first_visit(self, request: web.Request) -> bool:
        asks = self.gate.access.operator is not None and "token" in request.query
        return asks and request.path == "/" and not is_websocket(request)

    def _welcome(self, request: web.Request, visitor: Visitor) -> web.Response:
        """The right token (judged before) becomes a cookie and leaves the address."""
        rest = without_token(request).raw_query_string
        answer = web.Response(status=303, headers={hdrs.LOCATION: f"/?{rest}" if rest else "/"})
        answer.set_cookie(
            self.gate.cookie_name,
            self.gate.cookie_value(visitor),
            path="/",
            httponly=True,
            samesite="Strict",
            secure=self.gate.access.certificate is not None,
        )
        return answer

    async def _tell_health(self, request: web.Request) -> web.Response:
        told = {"ok": True, **self.health()}
        body = msgspec.json.encode(told, enc_hook=str)
        return web.Response(body=body, content_type="application/json", status=200 if told["ok"] else 503)


async def _add_safe_headers(request: web.Request, response: web.StreamResponse) -> None:
    for name, value in page.SAFE_HEADERS.items():
        response.headers[name] = value
    response.headers.setdefault("Content-Security-Policy", page.NOTHING_POLICY)
