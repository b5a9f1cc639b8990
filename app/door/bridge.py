"""Door: one browser's websocket joined to viser's, message by message, neither side hurried.

Each direction reads its next message only when the last one has gone out, so what waits here is at
most a message and the transports' own small buffers. viser keeps only the newest value of what it
could not send yet: a slow browser gets fewer pictures, not older ones.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Callable, Iterable
from typing import NamedTuple

from aiohttp import ClientWebSocketResponse, WebSocketError, WSCloseCode, WSMsgType, web

from app.door.counters import Counters
from app.door.filter import Dropped, Malformed

log = logging.getLogger(__name__)

#: A browser's largest message; its own are a few hundred bytes.
MAX_INBOUND_BYTES = 256 * 1024
CLOSE_SECONDS = 0.5

Admit = Callable[[bytes], bytes | Dropped | Malformed]


class End(NamedTuple):
    """Why a connection ended: what the other side is told."""

    code: int
    reason: bytes = b""


async def join(
    browser: web.WebSocketResponse, viser: ClientWebSocketResponse, admit: Admit, counters: Counters
) -> None:
    """Carry messages both ways until one side ends; then end the other with the same code."""
    inward = asyncio.create_task(_carry_in(browser, viser, admit, counters))
    outward = asyncio.create_task(_carry_out(viser, browser))
    try:
        await asyncio.wait((inward, outward), return_when=asyncio.FIRST_COMPLETED)
    finally:
        inward.cancel()
        outward.cancel()
        results = await asyncio.gather(inward, outward, return_exceptions=True)
        end = next((r for r in results if isinstance(r, End)), End(WSCloseCode.GOING_AWAY))
        _log_surprises(results)
        await asyncio.gather(_close(browser, end), _close(viser, end))


async def _carry_in(
    browser: web.WebSocketResponse, viser: ClientWebSocketResponse, admit: Admit, counters: Counters
) -> End:
    while True:
        message = await browser.receive()
        if message.type is not WSMsgType.BINARY:
            return _end_of_browser(message, counters)
        verdict = admit(message.data)
        if isinstance(verdict, bytes):
            await viser.send_bytes(verdict)
        elif isinstance(verdict, Dropped):
            counters.dropped_messages[verdict.type] += 1
            log.debug("dropped a %s: %s", verdict.type, verdict.why)
        else:
            counters.closed_malformed += 1
            return End(WSCloseCode.INVALID_TEXT, b"not a message")


async def _carry_out(viser: ClientWebSocketResponse, browser: web.WebSocketResponse) -> End:
    while True:
        message = await viser.receive()
        if message.type is not WSMsgType.BINARY:
            reason = message.extra if message.type is WSMsgType.CLOSE else None
            return End(_sendable(viser.close_code), str(reason or "").encode()[:120])
        await browser.send_bytes(message.data)


def _end_of_browser(message: object, counters: Counters) -> End:
    kind, data = getattr(message, "type", None), getattr(message, "data", None)
    if kind is WSMsgType.TEXT:
        counters.closed_malformed += 1
        return End(WSCloseCode.UNSUPPORTED_DATA, b"only binary messages")
    if isinstance(data, WebSocketError):
        too_big = data.code == WSCloseCode.MESSAGE_TOO_BIG
        counters.closed_too_big += too_big
        counters.closed_malformed += not too_big
    return End(WSCloseCode.OK)


def _sendable(code: int | None) -> int:
    """1005 and 1006 say that no code came; they must not be sent."""
    return code if code is not None and 1000 <= code < 5000 and code not in (1004, 1005, 1006, 1015) else 1001


def _log_surprises(results: Iterable[object]) -> None:
    for result in results:
        if isinstance(result, Exception) and not isinstance(result, ConnectionError):
            log.error("a browser's connection broke", exc_info=result)


async def _close(side: web.WebSocketResponse | ClientWebSocketResponse, end: End) -> None:
    """Say goodbye, but wait for no one."""
    with contextlib.suppress(TimeoutError, ConnectionError):
        async with asyncio.timeout(CLOSE_SECONDS):
            await side.close(code=end.code, message=end.reason)
