"""Heart: which protocol a stream speaks, by evidence: whole sound packets that account for the bytes.

First listen; only into silence is anything sent, and nothing that could write to a GX1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.formats.wire import (
    cells,
    gx1,
    gx1_talk,
    lines,
    mip,
    mip_talk,
    ngimu,
    witmotion,
    ximu3,
    xsens,
    xsens_talk,
)
from app.formats.wire.stream import Frames
from app.formats.wire.talk import Ask, Script

#: Listen this long at each baud rate of ``PROBE_BAUDS`` before sending anything.
LISTEN_S = 0.3
PROBE_BAUDS = (115200, 38400, 9600, 460800, 921600, 57600)

_ENOUGH = 3  # packets
_SHARE = 0.5  # of the bytes from the first sound packet on
_KEPT = 16384
_MORE = 1.5  # datagrams are looked at again when there are so many times the bytes: a stranger costs little


@dataclass(frozen=True)
class Found:
    """A device (a key of ``catalogue.KINDS``) and why, in words."""

    device: str
    evidence: str


@dataclass(frozen=True)
class _Candidate:
    device: str
    frames: Callable[[], Frames]
    counts: Callable[[bytes], bool]  # whether a packet that holds is evidence
    words: str


def _any(_: bytes) -> bool:
    return True


def _is_ximu3_data(message: bytes) -> bool:
    return message[0] != ord("{") and bool((ximu3.parse(message) or ("", 0, ()))[2])


def _is_known_osc(frame: bytes) -> bool:
    return _knows(ngimu.unframed(frame))


def _knows(packet: bytes) -> bool:
    _, messages = ngimu.parse(packet) or (0, {})
    return ngimu.SENSORS in messages or ngimu.QUATERNION in messages


#: The strongest forms first: what has a checksum, what has a form, and last what merely reads well.
_CANDIDATES = (
    _Candidate("mip", mip.frames, _any, "MIP packets with sound checksums"),
    _Candidate("xsens", xsens.frames, _any, "Xsens messages with sound checksums"),
    _Candidate("witmotion", witmotion.frames, _any, "WitMotion frames with sound sums"),
    _Candidate("ngimu", ngimu.frames, _is_known_osc, "OSC packets as an NGIMU sends them"),
    _Candidate("ximu3", ximu3.frames, _is_ximu3_data, "x-IMU3 messages"),
    _Candidate("gx1", gx1.frames, _any, "3DM-GX1 messages with sound checksums"),
    _Candidate("csv", lines.frames, cells.readable, "text lines with a sensor's columns"),
)


def identify(data: bytes) -> Found | None:
    """What these bytes, cut out of a stream anywhere, come from; None if nothing accounts for them."""
    for candidate in _CANDIDATES:
        frames = candidate.frames()
        sound = [packet for packet in frames.feed(data) if candidate.counts(packet)]
        if len(sound) < _ENOUGH:
            continue
        accounted = sum(map(len, sound))
        if accounted >= _SHARE * (len(data) - data.find(sound[0]) - frames.counters.bytes_pending):
            return Found(candidate.device, f"{len(sound)} {candidate.words} in {len(data)} bytes")
    return None


class Identifier:
    """Listens until it knows. ``datagrams``: each feed is one datagram, and OSC comes without SLIP.

    ``heard`` is what it listened to, at most 16 kB. The decoder gets it first: a text's header comes once.
    """

    def __init__(self, datagrams: bool = False) -> None:
        self._datagrams = datagrams
        self.heard = b""
        self._bytes, self._look_at = 0, 0.0
        self._osc = 0

    def feed(self, data: bytes) -> Found | None:
        """What it is, as soon as that is certain."""
        if self._datagrams and _knows(data):
            self._osc += 1
            if self._osc >= _ENOUGH:
                return Found("ngimu", f"{self._osc} datagrams of OSC as an NGIMU sends them")
        self.heard = (self.heard + data)[-_KEPT:]
        self._bytes += len(data)
        if self._datagrams and self._bytes < self._look_at:
            return None
        self._look_at = _MORE * self._bytes
        return identify(self.heard)


def probe() -> Script[Found | None]:
    """Ask into silence, in an order in which no question harms the devices that come later."""
    ping = mip_talk.PING
    if (
        yield Ask(ping, "asking for a MIP sensor", mip_talk.acknowledged(mip_talk.BASE, 0x01), tries=2)
    ) is not None:
        return Found("mip", "it answered a MIP ping")
    to_config = xsens.message(xsens_talk.GO_TO_CONFIG)
    answer = xsens_talk.answer(xsens_talk.GO_TO_CONFIG + 1)
    if (yield Ask(to_config, "asking for an Xsens MTi", answer, tries=2)) is not None:
        return Found("xsens", "it answered an Xsens GoToConfig")
    yield Ask(gx1_talk.STOP, "asking for a 3DM-GX1", timeout_s=0.1)
    if (yield Ask(b"\xf1", "asking for a 3DM-GX1", gx1_talk.reply(0xF1), tries=2)) is not None:
        return Found("gx1", "it answered a 3DM-GX1's request for its serial number")
    return None
