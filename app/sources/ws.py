"""Edge: ``ws:PORT``: messages of many sensors over websockets, each acknowledged, on a loop of their own.

Programs and boards connect here; a browser may not (a page of any site could make it), it has the door.
"""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import http
import logging
import socket
import threading
import time
from collections.abc import Callable
from functools import partial
from urllib.parse import parse_qs, urlsplit

from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from app.formats.wire.intake import Intake
from app.formats.wire.message import MOST_BYTES, Malformed
from app.formats.wire.reply import encode_ack, encode_refusal
from app.sources.inbox import Inbox
from app.sources.listening import bind, options_of, place_of, token_for
from app.sources.spec import Spec

_log = logging.getLogger(__name__)
# websockets logs each connection that breaks, with a traceback; for a sensor that is a usual day
_quiet = logging.getLogger(f"{__name__}.websockets")
_quiet.setLevel(logging.CRITICAL)

MOST_SENDERS = 64
PING_S = 20.0
_PAUSE_S = 0.02  # while the walk does not keep up
_STOP_S = 1.0


class WsSource(Inbox):
    """Listens from the start. An ack follows each message, as soon as its samples wait for the walk."""

    def __init__(self, spec: Spec) -> None:
        host, port = place_of(spec)
        options, own = options_of(spec, ("token-file",))
        self._token = token_for(spec, host, own.get("token-file"))
        self._intake = Intake(options)
        self._refused = 0
        self._connected = 0
        super().__init__(
            f"ws:{spec.target}",
            "Stridescope messages",
            lambda: self._intake.notes,
            self._lost,
            lambda: {"messages": self._intake.counters},
            lambda: self._intake.temperatures,
        )
        listener = bind(spec, host, port, socket.SOCK_STREAM)
        self.port: int = listener.getsockname()[1]
        self._stop: Callable[[], object] | None = None
        ready = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(listener, ready), name="ws", daemon=True)
        self._thread.start()
        ready.wait(5.0)

    def close(self) -> None:
        """End all connections and free the port."""
        stop, self._stop = self._stop, None
        if stop is not None:
            with contextlib.suppress(RuntimeError):  # its loop has ended by itself
                stop()
        self._thread.join(_STOP_S)

    def _lost(self) -> dict[str, int]:
        counters = self._intake.counters
        return {
            "lost on the way": counters.lost,
            "came twice": counters.repeated,
            "unusable readings": counters.dropped,
            "refused messages": counters.bad_checksum + counters.unknown,
            "refused senders": self._refused,
        }

    def _run(self, listener: socket.socket, ready: threading.Event) -> None:
        try:
            asyncio.run(self._serve(listener, ready))
        except Exception:
            _log.exception("%s fell shut", self.info.name)
        finally:
            listener.close()
            ready.set()

    async def _serve(self, listener: socket.socket, ready: threading.Event) -> None:
        stopping = asyncio.Event()
        self._stop = partial(asyncio.get_running_loop().call_soon_threadsafe, stopping.set)
        async with serve(
            self._receive,
            sock=listener,
            origins=[None],
            process_request=self._judge,
            compression=None,
            max_size=MOST_BYTES,
            max_queue=8,
            ping_interval=PING_S,
            close_timeout=0.3,
            logger=_quiet,
        ):
            ready.set()
            await stopping.wait()

    def _judge(self, connection: ServerConnection, request: Request) -> Response | None:
        """Without the token, or beyond the most senders, no websocket."""
        if self._connected >= MOST_SENDERS:
            status, line = (
                http.HTTPStatus.SERVICE_UNAVAILABLE,
                f"{MOST_SENDERS} senders are connected already\n",
            )
        elif self._token is not None and not hmac.compare_digest(given_token(request), self._token.encode()):
            status, line = http.HTTPStatus.UNAUTHORIZED, "the token is missing or wrong\n"
        else:
            return None
        self._refused += 1
        return connection.respond(status, line)

    async def _receive(self, sender: ServerConnection) -> None:
        self._connected += 1
        try:
            async for data in sender:
                samples, answer = self._intake.take(data, time.monotonic_ns())
                self.put(samples)
                await sender.send(
                    encode_refusal(answer.why) if isinstance(answer, Malformed) else encode_ack(answer)
                )
                while self.full:
                    await asyncio.sleep(_PAUSE_S)
        except ConnectionClosed:
            pass
        except Exception:  # which its server's logger would hide
            _log.exception("%s: a sender's message could not be taken", self.info.name)
        finally:
            self._connected -= 1


def given_token(request: Request) -> bytes:
    """The token of ``Authorization: Bearer …``, or of ``?token=…`` for boards that cannot set headers."""
    scheme, _, token = request.headers.get("Authorization", "").partition(" ")
    if scheme.lower() != "bearer":
        token = parse_qs(urlsplit(request.path).query).get("token", [""])[0]
    return token.strip().encode("utf-8", "surrogatepass")
