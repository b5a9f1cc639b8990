"""Door: one browser's websocket joined to viser's, message by message, neither side hurried.

Each direction reads its next message only when the last one has gone out, so what waits here is at
most a message and the transports' own small buffers. viser keeps only the newest value of what it
could not send yet: a slow browser gets fewer pictures, not older ones; one that takes nothing is let go.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple

from aiohttp import ClientWebSocketResponse, WebSocketError, WSCloseCode, WSMsgType, web

from app.door.counters import Counters
from app.door.filter import Dropped, Malformed
from app.door.pace import Pace

log = logging.getLogger(__name__)

#: A browser's largest message; its own are a few hundred bytes.
MAX_INBOUND_BYTES = 256 * 1024
CLOSE_SECONDS = 0.5
#: A browser that takes not a byte for so long is let go.
STALL_SECONDS = 5.0
LOOK_SECONDS = 0.5

Admit = Callable[[bytes], bytes | Dropped | Malformed]


class End(NamedTuple):
    """Why a connection ended: what the other side is told."""

    code: int
    reason: bytes = b""


@dataclass
class Outward:
    """How far the way to one browser has come."""

    sent: int = 0  # messages
    sending: bool = False


async def join(
    browser: web.WebSocketResponse,
    transport: asyncio.WriteTransport | None,
    viser: ClientWebSocketResponse,
    admit: Admit,
    counters: Counters,
) -> None:
    """Carry messages both ways until one side ends or stalls; then end the other with the same code.

    ``transport`` is the browser's.
    """
    outward = Outward()
    ways = [
        asyncio.create_task(_carry_in(browser, viser, admit, outward, counters)),
        asyncio.create_task(_carry_out(viser, browser, outward, counters)),
        asyncio.create_task(_watch(transport, outward, counters)),
    ]
    try:
        await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for way in ways:
            way.cancel()
        results = await asyncio.gather(*ways, return_exceptions=True)
        end = next((r for r in results if isinstance(r, End)), End(WSCloseCode.GOING_AWAY))
        _log_surprises(results)
        await asyncio.gather(_close(browser, end), _close(viser, end))


async def _carry_in(
    browser: web.WebSocketResponse,
    viser: ClientWebSocketResponse,
    admit: Admit,
    outward: Outward,
    counters: Counters,
) -> End:
    pace, clock = Pace(), asyncio.get_running_loop().time
    while True:
        message = await browser.receive()
        if message.type is WSMsgType.BINARY:
            verdict = admit(message.data)
            if isinstance(verdict, Malformed):
                counters.closed_malformed += 1
                return End(WSCloseCode.INVALID_TEXT, b"not a message")
            if isinstance(verdict, Dropped):
                counters.dropped_messages[verdict.type] += 1
                log.debug("dropped a %s: %s", verdict.type, verdict.why)
            else:
                counters.messages_in += 1
                await viser.send_bytes(verdict)
        elif message.type is WSMsgType.PING:
            if not outward.sending:  # who asks and does not read must not pile up answers
                await browser.pong(message.data)
        elif message.type is not WSMsgType.PONG:
            return _end_of_browser(message, counters)
        delay_s = pace.delay_s(len(message.data), clock())
        if delay_s:
            counters.paced += 1
            await asyncio.sleep(delay_s)


async def _carry_out(
    viser: ClientWebSocketResponse, browser: web.WebSocketResponse, outward: Outward, counters: Counters
) -> End:
    while True:
        message = await viser.receive()
        if message.type is not WSMsgType.BINARY:
            reason = message.extra if message.type is WSMsgType.CLOSE else None
            return End(_sendable(viser.close_code), str(reason or "").encode()[:120])
        outward.sending = True
        await browser.send_bytes(message.data)
        outward.sending = False
        outward.sent += 1
        counters.messages_out += 1
        counters.bytes_out += len(message.data)


async def _watch(transport: asyncio.WriteTransport | None, outward: Outward, counters: Counters) -> End:
    """Return when a browser has taken nothing for a while: a frozen tab, a sleeping laptop.

    It comes back by itself and is shown the present; what it had not read would be the past.
    """
    clock = asyncio.get_running_loop().time
    sent, unsent, since_s = -1, 0, clock()
    while True:
        await asyncio.sleep(LOOK_SECONDS)
        left = transport.get_write_buffer_size() if transport is not None else 0
        took = outward.sent != sent or left < unsent
        sent, unsent = outward.sent, left
        if took or not outward.sending:
            since_s = clock()
        elif clock() - since_s >= STALL_SECONDS:
            counters.closed_stalled += 1
            return End(WSCloseCode.TRY_AGAIN_LATER, b"too slow")


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
