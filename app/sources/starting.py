"""Edge: a sensor on an open port identified, asked for its samples, and known from then on."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

from app.formats.wire.catalogue import KINDS, Kind
from app.formats.wire.identify import LISTEN_S, PROBE_BAUDS, Found, Identifier, probe
from app.formats.wire.talk import Script, Talk
from app.sources.port import Port, PortLostError

Result = TypeVar("Result")
#: Hears in a few words what is being tried.
Tell = Callable[[str], None]
#: Hears every piece that comes, with its arrival in ns, whatever it answers.
Tap = Callable[[int, bytes], object]
#: What is asked for where nobody says a rate: enough for walking, and 115200 baud carry it.
USUAL_HZ = 100.0
#: Where few bytes come that are nothing known yet, this much more is listened: some sensors are slow.
PATIENCE_S = 1.0
_FEW = 1024
_STEP_S = 0.05
_FILLED = 0.9  # of the line that samples may take


@dataclass(frozen=True)
class Wish:
    """What the user said: a key of ``KINDS`` or None (find out), baud rate and rate, None where not."""

    device: str | None = None
    baud: int | None = None
    rate_hz: float | None = None


@dataclass(frozen=True)
class Started:
    """A sensor that sends. ``setup`` is its start-up's result; ``heard`` is for the decoder to read first."""

    device: str
    baud: int
    evidence: str
    setup: Any
    heard: bytes

    @property
    def kind(self) -> Kind:
        """Its line in the catalogue."""
        return KINDS[self.device]


class UnansweredError(PortLostError):
    """The port is there, but its sensor does not do what it is asked: one sentence for the user."""


async def start(port: Port, wish: Wish, tell: Tell) -> Started:
    """Find the sensor that is wished for and start it; ``PortLostError`` says what to do if that fails."""
    while (answer := await find(port, wish, tell)) is None:
        tell("nothing answers: listening again")
    baud, found, heard = answer
    return await start_known(port, baud, found, wish.rate_hz, tell, heard)


async def start_known(
    port: Port,
    baud: int,
    found: Found,
    rate_hz: float | None,
    tell: Tell,
    heard: bytes = b"",
    tap: Tap | None = None,
) -> Started:
    """Start a sensor of which is known what it is; the port is at ``baud``. Or ``UnansweredError``."""
    kind = KINDS[found.device]
    if kind.start_up is None:
        return Started(found.device, baud, found.evidence, None, heard)
    talk = await converse(port, kind.start_up(asked_rate(kind, baud, rate_hz)), tell, tap)
    if talk.failed:
        raise UnansweredError(talk.failed)
    return Started(found.device, baud, found.evidence, talk.result, talk.left_over)


def asked_rate(kind: Kind, baud: int, wanted_hz: float | None) -> float:
    """The rate to ask for: what is wanted, as far as the line carries it."""
    carried_hz = _FILLED * baud / 10 / kind.sample_bytes
    return min(wanted_hz if wanted_hz is not None else USUAL_HZ, kind.fastest_hz, carried_hz)


async def converse(port: Port, script: Script[Result], tell: Tell, tap: Tap | None = None) -> Talk[Result]:
    """Hold a conversation to its end."""
    talk = Talk(script)
    while (ask := talk.ask) is not None:
        tell(ask.what)
        port.write(ask.send)
        ends_s = time.monotonic() + ask.timeout_s
        answered = False
        while not answered:
            left_s = max(ends_s - time.monotonic(), 0.0)  # this process may have been held up: look once more
            arrived = await port.read(min(left_s, ask.quiet_s or math.inf))
            if not arrived:
                talk.expire()
                break
            if tap is not None:
                for host_ns, data in arrived:
                    tap(host_ns, data)
            answered = talk.receive(b"".join(data for _, data in arrived))
    return talk


async def find(port: Port, wish: Wish, tell: Tell, ask: bool = True) -> tuple[int, Found, bytes] | None:
    """The baud rate, what it is, and what was heard meanwhile; None if nothing answers.

    First it listens at every rate; only into silence it asks, and not at all without ``ask``.
    """
    if wish.device is not None and wish.baud is not None:
        port.set_baud(wish.baud)
        return wish.baud, Found(wish.device, "as you said"), b""
    bauds = _bauds(wish)
    heard = await _listen_at_all(port, bauds, wish.device, tell)
    if heard is None and ask:
        heard = await _ask_at_all(port, bauds, wish, tell)
    return heard


def _bauds(wish: Wish) -> tuple[int, ...]:
    if wish.baud is not None:
        return (wish.baud,)
    return PROBE_BAUDS if wish.device is None else KINDS[wish.device].bauds


async def _listen_at_all(
    port: Port, bauds: tuple[int, ...], device: str | None, tell: Tell
) -> tuple[int, Found, bytes] | None:
    for baud in bauds:
        port.set_baud(baud)
        tell(f"listening at {baud} baud")
        identifier, began_s, looks = Identifier(), time.monotonic(), 0
        listen_s = LISTEN_S
        # By the clock, and by looks: this process may be held up meanwhile.
        while time.monotonic() - began_s < listen_s or looks * _STEP_S < listen_s:
            listen_s = LISTEN_S + (PATIENCE_S if 0 < len(identifier.heard) < _FEW else 0.0)
            await asyncio.sleep(_STEP_S)
            looks += 1
            found = identifier.feed(b"".join(data for _, data in await port.read(0.0)))
            if found is not None:
                _demand(port, device, found)
                return baud, found, identifier.heard
    return None


def _demand(port: Port, device: str | None, found: Found) -> None:
    if device is not None and found.device != device:
        raise PortLostError(
            f"{port.path}: {KINDS[found.device].title} ({found.evidence}), expected "
            f"{KINDS[device].title}: say device={found.device}"
        )


async def _ask_at_all(
    port: Port, bauds: tuple[int, ...], wish: Wish, tell: Tell
) -> tuple[int, Found, bytes] | None:
    for baud in bauds:
        port.set_baud(baud)
        if wish.device is None:
            tell(f"asking at {baud} baud")
            found = (await converse(port, probe(), _unheard)).result
            if found is not None:
                return baud, found, b""
        elif await _answers(port, baud, wish, tell):
            return baud, Found(wish.device, f"it answered at {baud} baud"), b""
    return None


def _unheard(_: str) -> None:
    """For what is tried too fast to be read."""


async def _answers(port: Port, baud: int, wish: Wish, tell: Tell) -> bool:
    """Whether the sensor that the user named starts at this rate and sends something sound."""
    found = Found(str(wish.device), "")
    try:
        started = await start_known(port, baud, found, wish.rate_hz, tell)
    except PortLostError:
        await port.read(0.0)  # gone altogether?
        return False
    decoder = started.kind.decoder("foot", started.kind.axes, started.setup)
    decoder.feed(started.heard, time.monotonic_ns())
    ends_s = time.monotonic() + PATIENCE_S
    while not decoder.counters.packets and time.monotonic() < ends_s:
        for host_ns, data in await port.read(_STEP_S):
            decoder.feed(data, host_ns)
    return decoder.counters.packets > 0
