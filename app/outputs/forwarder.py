"""Edge: samples onto the network: by websocket, acknowledged and kept while it is cut, or by datagrams."""

from __future__ import annotations

import asyncio
import logging
import socket
import ssl
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple, Protocol
from urllib.parse import parse_qs, urlsplit

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidStatus

from app.formats.wire.message import MOST_SAMPLES, encode_binary, fitting
from app.formats.wire.outbox import Outbox, Parcel
from app.formats.wire.reply import Ack, decode_reply
from app.motion.basics import InputError
from app.motion.samples import Sample

_log = logging.getLogger(__name__)
_quiet = logging.getLogger(f"{__name__}.websockets")
_quiet.setLevel(logging.CRITICAL)

FIRST_WAIT_S, LONGEST_WAIT_S = 0.2, 2.0
PING_S, SILENT_S = 2.0, 4.0
OPEN_S = 5.0
_IN_FLIGHT = 64  # messages sent and not answered yet
_MOST_COMPLAINTS = 50
_DATAGRAM_BYTES = 1400  # fits every network's packets whole

Tell = Callable[[str], None]


class Links(NamedTuple):
    """What a websocket needs: the receiver's token and certificate, and how much may wait for it."""

    token: str | None = None
    trust: Path | None = None
    limit_bytes: int = 64 * 2**20

    def tls(self) -> ssl.SSLContext:
        """Believes what the system believes, and the certificate that was given."""
        context = ssl.create_default_context()
        try:
            if self.trust is not None:
                context.load_verify_locations(self.trust)
        except (OSError, ssl.SSLError) as error:
            raise InputError(f"--trust {self.trust}: no certificate that can be read ({error})") from None
        return context


class Sender(Protocol):
    """Where samples go. ``send`` never waits; ``finish`` returns when all has been delivered."""

    @property
    def full(self) -> bool:
        """Whether a source that can wait should."""

    def send(self, sample: Sample) -> None:
        """One sample more."""

    def warm(self, temperatures: Mapping[str, float]) -> None:
        """What the sensors' thermometers read by now, °C."""

    def begin_anew(self, session: int) -> None:
        """The source starts again from its beginning."""

    async def run(self) -> None:
        """Deliver, until cancelled."""

    async def finish(self) -> None:
        """Wait until nothing is left to deliver."""

    def summary(self) -> str:
        """What became of the samples, in one line."""


def sender_to(address: str, session: int, links: Links, tell: Tell) -> Sender:
    """The sender to ``ws://HOST:PORT``, ``wss://…`` or ``udp://HOST:PORT``; ``InputError`` for any other."""
    try:
        parts = urlsplit(address)
        port = parts.port
    except ValueError:
        parts, port = urlsplit(""), None
    if parts.scheme not in ("ws", "wss", "udp") or not parts.hostname or not port:
        raise InputError(f"--to {address}: expected ws://HOST:PORT or udp://HOST:PORT")
    if parts.scheme == "udp":
        return UdpSender(parts.hostname, port, session, _repeats(address, parts.query))
    return WsSender(address, session, links, tell)


def _repeats(address: str, query: str) -> int:
    options = parse_qs(query, keep_blank_values=True)
    text = options.pop("repeat", ["0"])[0]
    if options or not text.isascii() or not text.isdigit() or len(text) > 1 or int(text) > 8:
        raise InputError(f"--to {address}: expected udp://HOST:PORT or udp://HOST:PORT?repeat=N, N 0 to 8")
    return int(text)


class WsSender:
    """By websocket: sent again until the receiver says that it has it."""

    def __init__(self, address: str, session: int, links: Links, tell: Tell) -> None:
        self._address, self._tell = address, tell
        self._headers = {"Authorization": f"Bearer {links.token}"} if links.token else {}
        self._outbox = Outbox(session, links.limit_bytes)
        self._tls = links.tls() if address.startswith("wss") else None
        self._news = asyncio.Event()
        self._idle = asyncio.Event()
        self._away = False
        self._complaints: set[str] = set()

    def send(self, sample: Sample) -> None:
        """One sample more."""
        self._outbox.add(sample)
        self._news.set()

    def warm(self, temperatures: Mapping[str, float]) -> None:
        """What the sensors' thermometers read by now, °C."""
        self._outbox.warm(temperatures)

    def begin_anew(self, session: int) -> None:
        """The source starts again from its beginning."""
        self._outbox.begin_anew(session)

    @property
    def full(self) -> bool:
        """Whether half of the memory is taken."""
        return self._outbox.full

    async def finish(self) -> None:
        """Wait until the receiver has acknowledged everything."""
        while self._outbox.waiting:
            self._idle.clear()
            await self._idle.wait()

    def summary(self) -> str:
        """What became of the samples, in one line."""
        box = self._outbox
        lost = f", {box.given_up} given up" if box.given_up else ""
        return f"{box.delivered} samples delivered, {box.waiting} not acknowledged{lost}"

    async def run(self) -> None:
        """Deliver; a network that is away is asked again with growing waits."""
        wait_s = FIRST_WAIT_S
        while True:
            try:
                async with connect(
                    self._address,
                    additional_headers=self._headers,
                    ssl=self._tls,
                    compression=None,
                    open_timeout=OPEN_S,
                    ping_interval=PING_S,
                    ping_timeout=SILENT_S,
                    close_timeout=0.5,
                    proxy=None,
                    logger=_quiet,
                ) as link:
                    self._tell(f"connected to {self._address}, {self._outbox.waiting} samples to send")
                    self._away, wait_s = False, FIRST_WAIT_S
                    await self._deliver(link)
                    reason = "the receiver closed the connection"
            except InvalidStatus as error:
                reason = self._refusal(error)
            except ssl.SSLCertVerificationError as error:
                why = error.verify_message
                raise InputError(f"--to {self._address}: its certificate is not trusted ({why})") from None
            except (OSError, InvalidHandshake, ConnectionClosed, TimeoutError) as error:
                reason = str(error) or type(error).__name__
            if not self._away:
                self._tell(f"{self._address} is away ({reason}): samples are kept until it is back")
            self._away = True
            await asyncio.sleep(wait_s)
            wait_s = min(2 * wait_s, LONGEST_WAIT_S)

    def _refusal(self, error: InvalidStatus) -> str:
        status = error.response.status_code
        body = (error.response.body or b"").decode("utf-8", "replace").strip()
        if status in (401, 403, 404):
            raise InputError(
                f"--to {self._address}: refused ({body[:100] or status}), expected its token and path"
            )
        return f"{status} {body[:100]}"

    async def _deliver(self, link: ClientConnection) -> None:
        """Until the link breaks: send what is new, take answers, never more than some messages ahead."""
        self._outbox.rewind()
        sent: deque[Parcel] = deque()
        room = asyncio.Semaphore(_IN_FLIGHT)
        sending = asyncio.create_task(self._send(link, sent, room))
        try:
            async for reply in link:
                self._answered(reply, sent)
                room.release()
        finally:
            sending.cancel()
            with suppress(asyncio.CancelledError, ConnectionClosed):
                await sending

    async def _send(self, link: ClientConnection, sent: deque[Parcel], room: asyncio.Semaphore) -> None:
        while True:
            self._news.clear()
            while (parcel := self._outbox.next()) is not None:
                await room.acquire()
                sent.append(parcel)
                await link.send(parcel.data)
            await self._news.wait()

    def _answered(self, reply: str | bytes, sent: deque[Parcel]) -> None:
        """Answers come in the order of the messages."""
        answer = decode_reply(reply)
        parcel = sent.popleft() if sent else None
        if isinstance(answer, Ack):
            self._outbox.acknowledge(answer)
        elif parcel is not None:
            self._outbox.refuse(parcel)
            self._complain(f"{self._address} refused samples: {answer.why}")
        self._idle.set()

    def _complain(self, line: str) -> None:
        """Once each, and not without end."""
        if line not in self._complaints and len(self._complaints) < _MOST_COMPLAINTS:
            self._complaints.add(line)
            self._tell(line)


class UdpSender:
    """By datagrams, each sent once; ``repeats`` samples before go with it, in case they were lost."""

    full = False

    def __init__(self, host: str, port: int, session: int, repeats: int) -> None:
        try:
            family, kind, _, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
        except OSError as error:
            raise InputError(f"--to udp://{host}:{port}: no such host ({error.strerror or error})") from None
        self._place: tuple[Any, ...] = place
        self._socket = socket.socket(family, kind)
        self._socket.setblocking(False)
        self._session, self._repeats = session, repeats
        self._before: dict[str, list[Sample]] = {}
        self._warmth: dict[str, float] = {}
        self._sent = self._failed = 0

    def send(self, sample: Sample) -> None:
        """At once: a datagram that the system does not take is lost, and counted."""
        before = self._before.get(sample.sensor, [])
        follows = before and before[-1].seq + 1 == sample.seq and before[-1].device_ns < sample.device_ns
        samples = [*before, sample] if follows else [sample]
        samples = samples[-min(self._repeats + 1, fitting(_DATAGRAM_BYTES), MOST_SAMPLES) :]
        self._before[sample.sensor] = samples
        try:
            celsius = self._warmth.pop(sample.sensor, None)
            self._socket.sendto(encode_binary(self._session, samples, temperature_c=celsius), self._place)
            self._sent += 1
        except OSError as error:
            self._failed += 1
            _log.debug("a datagram was not sent: %s", error)

    def warm(self, temperatures: Mapping[str, float]) -> None:
        """What the sensors' thermometers read by now, °C."""
        self._warmth.update(temperatures)

    def begin_anew(self, session: int) -> None:
        """The source starts again from its beginning."""
        self._session, self._before = session, {}

    async def run(self) -> None:
        """Nothing is kept, so nothing is left to do."""
        await asyncio.Event().wait()

    async def finish(self) -> None:
        """Nothing is kept."""

    def summary(self) -> str:
        """What became of the samples, in one line."""
        failed = f", {self._failed} that this machine could not send" if self._failed else ""
        return f"{self._sent} samples sent{failed}; whether they arrived, datagrams do not tell"
