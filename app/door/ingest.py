"""Door: the ways in for samples: a phone's page, a websocket for messages, and pushes by HTTP.

Who sends needs a token of his own (it lets send and nothing else) or the operator's.
"""

from __future__ import annotations

import asyncio
import base64
import hashlib
import hmac
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol
from urllib.parse import quote

from aiohttp import WSMsgType, hdrs, web

from app.door import codes
from app.door.access import Access, Visitor, is_loopback
from app.door.addresses import reachable
from app.door.gate import Gate, Refusal
from app.door.pace import Pace
from app.door.upstream import VISITOR, is_websocket, say

HERE = Path(__file__).parent
PHONE, FEED, PUSH, CODE = "/phone", "/feed", "/push", "/phone-code.svg"
MOST_MESSAGE_BYTES = 65_536
MOST_PUSH_BYTES = 2_000_000
MOST_SENDERS = 32
#: What one sender may send: two feet at 400 Hz, one message a sample, and as much again.
MESSAGES_PER_S, BYTES_PER_S = 1600.0, 1_000_000.0
PING_SECONDS = 15.0
_POLICY = (
    "default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; "
    "connect-src 'self' ws://{host} wss://{host}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_NOBODY = "404: this walk takes no samples here: start it with --source phone:"


class Taker(Protocol):
    """Who takes what comes in; called on the door's thread, never waits."""

    def take(self, data: bytes | str) -> str:
        """A message; what to answer its sender."""

    def push(self, data: bytes, query: Mapping[str, str]) -> tuple[int, str]:
        """A body that was pushed to an address with this query: status and text of the answer."""


def sender_token(access: Access) -> str | None:
    """The token that lets send samples and nothing else; it follows from the operator's."""
    if access.operator is None:
        return None
    digest = hashlib.sha256(
        b"stridescope sender:" + access.operator.encode("utf-8", "surrogatepass")
    ).digest()
    return base64.urlsafe_b64encode(digest[:16]).decode().rstrip("=")


@dataclass
class Ingest:
    """The routes, for one ``taker``; without one they say how to have one."""

    gate: Gate
    taker: Taker | None
    senders: int = 0

    def add_routes(self, router: web.UrlDispatcher) -> None:
        """To be added before what takes every path."""
        router.add_get(PHONE, self._give_phone)
        router.add_get(FEED, self._take_messages)
        router.add_post(PUSH, self._take_push)
        router.add_get(CODE, self._give_code)

    def concerns(self, request: web.Request) -> bool:
        """Whether a request is judged here."""
        return request.path in (PHONE, FEED, PUSH)

    def judge(self, request: web.Request) -> Visitor | Refusal:
        """Who sends: a page of ours or a program, with a token where there are tokens."""
        headers = request.headers
        refusal = self.gate.check_site(
            headers.getall(hdrs.HOST, []), headers.getall(hdrs.ORIGIN, []), websocket=False
        )
        if refusal is not None:
            return refusal
        expected = sender_token(self.gate.access)
        if expected is None or hmac.compare_digest(_given(request), expected.encode()):
            return Visitor.VIEWER  # who sends sees nothing more
        by_token = self.gate.check_token(_given(request).decode("utf-8", "surrogatepass"))
        judged = (
            by_token
            if by_token is Visitor.OPERATOR
            else self.gate.check_cookie(request.cookies.get(self.gate.cookie_name))
        )
        if judged is Visitor.OPERATOR:
            return judged
        return Refusal(
            401, "token", "401: this address needs the token that the program's page shows for phones."
        )

    async def _give_phone(self, _: web.Request) -> web.StreamResponse:
        if self.taker is None:
            return say(404, _NOBODY)
        nonce = secrets.token_hex(16)
        script = (HERE / "phone.js").read_text(encoding="utf-8")
        html = (HERE / "phone.html").read_text(encoding="utf-8").replace("/* phone.js */", script)
        policy = _POLICY.format(nonce=nonce, host=_.headers[hdrs.HOST])
        return web.Response(
            text=html.replace("NONCE", nonce),
            content_type="text/html",
            headers={
                "Content-Security-Policy": policy,
                "Permissions-Policy": "accelerometer=(self), gyroscope=(self), screen-wake-lock=(self)",
            },
        )

    async def _take_messages(self, request: web.Request) -> web.StreamResponse:
        if self.taker is None:
            return say(404, _NOBODY)
        if not is_websocket(request):
            return say(426, "426: this address is for a websocket.", {hdrs.UPGRADE: "websocket"})
        if self.senders >= MOST_SENDERS:
            return say(503, f"503: {MOST_SENDERS} senders are connected already.")
        socket = web.WebSocketResponse(
            compress=False, max_msg_size=MOST_MESSAGE_BYTES, heartbeat=PING_SECONDS, timeout=0.5
        )
        if not socket.can_prepare(request):
            return say(400, "400: this is no websocket handshake that can be read.")
        self.senders += 1
        try:
            await socket.prepare(request)
            pace, clock = Pace(MESSAGES_PER_S, BYTES_PER_S), asyncio.get_running_loop().time
            async for message in socket:
                if message.type in (WSMsgType.TEXT, WSMsgType.BINARY):
                    await socket.send_str(self.taker.take(message.data))
                    await asyncio.sleep(pace.delay_s(len(message.data), clock()))
        finally:
            self.senders -= 1
        return socket

    async def _take_push(self, request: web.Request) -> web.StreamResponse:
        if self.taker is None:
            return say(404, _NOBODY)
        if (request.content_length or 0) > MOST_PUSH_BYTES:
            return say(413, f"413: more than {MOST_PUSH_BYTES} bytes.")
        body = bytearray()
        async for chunk in request.content.iter_chunked(64 * 1024):
            body += chunk
            if len(body) > MOST_PUSH_BYTES:
                return say(413, f"413: more than {MOST_PUSH_BYTES} bytes.")
        query = {key: value for key, value in request.query.items() if key != "token"}
        status, text = self.taker.push(bytes(body), query)
        return say(status, text)

    async def _give_code(self, request: web.Request) -> web.StreamResponse:
        """The phone page's address as a picture; for operators, since it tells the senders' token."""
        access = self.gate.access
        if request.get(VISITOR) is not Visitor.OPERATOR:
            svg = codes.words("Only who operates sees the code for phones.")
        elif is_loopback(access.host):
            svg = codes.words(
                "A phone cannot reach this page: it listens on this machine only.",
                "Start with --host 0.0.0.0 --tls-made.",
            )
        elif access.certificate is None:
            svg = codes.words(
                "A phone gives its motion to https pages only.",
                "Start with --tls-made (or --tls-cert and --tls-key).",
            )
        else:
            svg = codes.picture(phone_address(access))
        return web.Response(text=svg, content_type="image/svg+xml")


def phone_address(access: Access) -> str:
    """What a phone opens; with the senders' token: never log it."""
    host = reachable(access.host)
    token = sender_token(access)
    query = f"?token={quote(token, safe='')}" if token else ""
    return f"{access.scheme}://{f'[{host}]' if ':' in host else host}:{access.port}{PHONE}{query}"


def _given(request: web.Request) -> bytes:
    """The token of ``Authorization: Bearer …``, or of the address."""
    scheme, _, token = request.headers.get(hdrs.AUTHORIZATION, "").partition(" ")
    if scheme.lower() != "bearer":
        token = request.query.get("token", "")
    return token.strip().encode("utf-8", "surrogatepass")
