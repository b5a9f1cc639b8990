"""Door: the way to viser: its page, its files and its websocket, asked for on a browser's behalf."""

from __future__ import annotations

import secrets
import socket
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import aiohttp
from aiohttp import hdrs, web
from yarl import URL

from app.door import bridge, page
from app.door.access import Visitor
from app.door.counters import Counters
from app.door.filter import Rules, admit

MAX_BROWSERS = 64
PING_SECONDS = 30.0
SOCKET_BYTES = 64 * 1024

#: Where a judged request says who asks.
VISITOR = web.RequestKey("visitor", Visitor)
NO_RULES: Rules = MappingProxyType({})

_PASSED_HEADERS = (hdrs.CONTENT_TYPE, hdrs.CONTENT_ENCODING, hdrs.CONTENT_LENGTH)
_STARTING = "502: the viewer behind this page does not answer (yet). This page tries again by itself."


def open_session() -> aiohttp.ClientSession:
    """A client session for one viser: no cookies, no pool, what comes is passed on as it is."""
    return aiohttp.ClientSession(
        connector=aiohttp.TCPConnector(limit=0, force_close=True, socket_factory=_small_socket),
        timeout=aiohttp.ClientTimeout(total=None, sock_connect=5.0, sock_read=30.0),
        auto_decompress=False,
        cookie_jar=aiohttp.DummyCookieJar(),
    )


@dataclass(frozen=True)
class Upstream:
    """The viser server on loopback ``port``. Requests that come here have been judged."""

    session: aiohttp.ClientSession
    port: int
    rules: Callable[[], Rules]
    extra_head: str
    counters: Counters

    async def give_page(self, request: web.Request) -> web.StreamResponse:
        """viser's page with our head, or its websocket, which has the same address."""
        if is_websocket(request):
            return await self._give_websocket(request)
        plain = {hdrs.ACCEPT_ENCODING: "identity"}
        async with self.session.get(self._url("http", "/"), headers=plain) as answer:
            if answer.status != 200:
                return say_starting()
            html = (await answer.read()).decode()
        nonce = secrets.token_hex(16)
        return web.Response(
            text=page.dress(html, self.extra_head, nonce, request[VISITOR]),
            content_type="text/html",
            headers={"Content-Security-Policy": page.policy(nonce, request.headers[hdrs.HOST])},
        )

    async def give_file(self, request: web.Request) -> web.StreamResponse:
        """Whatever viser has under this path, compressed as it comes."""
        encoding = {hdrs.ACCEPT_ENCODING: request.headers.get(hdrs.ACCEPT_ENCODING, "identity")}
        async with self.session.get(self._url("http", request.rel_url.raw_path), headers=encoding) as answer:
            if answer.status != 200:
                return say(404, "404: there is nothing here.")
            headers = {name: answer.headers[name] for name in _PASSED_HEADERS if name in answer.headers}
            response = web.StreamResponse(headers=headers)
            await response.prepare(request)
            if request.method != hdrs.METH_HEAD:
                async for chunk in answer.content.iter_chunked(64 * 1024):
                    await response.write(chunk)
            return response

    async def _give_websocket(self, request: web.Request) -> web.StreamResponse:
        if self.counters.connections >= MAX_BROWSERS:
            self.counters.refuse("full")
            return say(503, f"503: {MAX_BROWSERS} browsers are connected already; close one and try again.")
        self.counters.connections += 1
        self.counters.connections_total += 1
        try:
            return await self._join(request)
        finally:
            self.counters.connections -= 1

    async def _join(self, request: web.Request) -> web.StreamResponse:
        asked = request.headers.get(hdrs.SEC_WEBSOCKET_PROTOCOL, "")
        offered = [name.strip() for name in asked.split(",") if name.strip()]
        if not web.WebSocketResponse(protocols=offered).can_prepare(request):
            return say(400, "400: this is no websocket handshake that can be read.")
        viser = await self._connect(request, offered)
        transport = request.transport
        try:
            if viser.protocol is None:
                return say(400, "400: this websocket offers no version of the viewer; reload the page.")
            browser = _answer_websocket(viser.protocol)
            await browser.prepare(request)
            await bridge.join(browser, transport, viser, self._admit_for(request[VISITOR]), self.counters)
            if transport is not None:
                transport.abort()  # one that never reads would keep what waits for it
            return browser
        finally:
            await viser.close()

    def _admit_for(self, visitor: Visitor) -> bridge.Admit:
        """The filter for one browser: to a viewer's, every control is unknown."""
        if visitor is Visitor.OPERATOR:
            return lambda message: admit(message, self.rules())
        return lambda message: admit(message, NO_RULES)

    async def _connect(self, request: web.Request, offered: list[str]) -> aiohttp.ClientWebSocketResponse:
        return await self.session.ws_connect(
            self._url("ws", "/").with_query(without_token(request).query),
            protocols=offered,
            headers={
                "X-Forwarded-For": request.remote or "",
                hdrs.USER_AGENT: request.headers.get(hdrs.USER_AGENT, "")[:200],
            },
            max_msg_size=0,
            timeout=aiohttp.ClientWSTimeout(ws_close=bridge.CLOSE_SECONDS),
        )

    def _url(self, scheme: str, raw_path: str) -> URL:
        return URL.build(scheme=scheme, host="127.0.0.1", port=self.port, path=raw_path, encoded=True)


def is_websocket(request: web.Request) -> bool:
    """Whether a request asks to become a websocket."""
    return request.headers.get(hdrs.UPGRADE, "").strip().lower() == "websocket"


def without_token(request: web.Request) -> URL:
    """The path and query of a request, but for the token."""
    return request.rel_url.without_query_params("token")


def say(status: int, line: str, headers: Mapping[str, str] | None = None) -> web.Response:
    """An answer in one plain line."""
    return web.Response(status=status, text=line + "\n", headers=headers)


def say_starting() -> web.Response:
    """viser does not answer: the browser asks again by itself."""
    return say(502, _STARTING, {"Refresh": "2"})


def _answer_websocket(protocol: str) -> web.WebSocketResponse:
    return web.WebSocketResponse(
        protocols=[protocol],
        compress=False,
        max_msg_size=bridge.MAX_INBOUND_BYTES,
        heartbeat=PING_SECONDS,
        autoping=False,  # the bridge counts pings as messages
        timeout=bridge.CLOSE_SECONDS,
        writer_limit=0,
    )


def _small_socket(address: tuple[Any, ...]) -> socket.socket:
    """A socket to viser that holds little: what a stalled browser does not take waits in viser."""
    connection = socket.socket(*address[:3])
    connection.setblocking(False)
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SOCKET_BYTES)
    return connection
