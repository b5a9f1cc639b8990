"""Heart: how an Xsens MTi is started, and how it answers: its start-up and a model of the device."""

from __future__ import annotations

from app.formats.mounting import Axes
from app.formats.wire.making import Z_UP
from app.formats.wire.pace import Pace
from app.formats.wire.stream import Frames
from app.formats.wire.talk import Ask, FindAnswer, RefusedError, Script
from app.formats.wire.warmth import RATE_HZ, warming
from app.formats.wire.xsens import (
    ACCELERATION,
    MAGNETIC_FIELD,
    PACKET_COUNTER,
    QUATERNION,
    RATE_OF_TURN,
    STATUS_WORD,
    SYNC,
    TEMPERATURE,
    TIME_FINE,
    XsensEncoder,
    XsensSetup,
    data_of,
    frames,
    holds,
    message,
)
from app.motion.samples import Sample

BAUDS = (115200, 921600, 460800, 230400)
GO_TO_CONFIG, GO_TO_MEASUREMENT, RESET, WAKE_UP, WAKE_UP_ACK = 0x30, 0x10, 0x40, 0x3E, 0x3F
REQ_DID, REQ_FIRMWARE, REQ_PRODUCT, SET_OUTPUT, ERROR = 0x00, 0x12, 0x1C, 0xC0, 0x42
_EVERY = 0xFFFF
#: On a line that damages one byte in a hundred, one answer in four is.
TRIES = 6


# --- starting a sensor ---------------------------------------------------------------------------


def start_up(rate_hz: float = 100.0) -> Script[XsensSetup]:
    """Go to config, who it is, choose the output at about ``rate_hz``, measure."""
    if (yield _ask(GO_TO_CONFIG, b"", "waiting for an Xsens MTi")) is None:
        raise RefusedError("no Xsens MTi answers: check port, baud rate (115200 is usual) and power")
    serial = _data((yield _ask(REQ_DID, b"", "reading its serial number")))
    firmware = _data((yield _ask(REQ_FIRMWARE, b"", "reading the firmware version")))
    product = _data((yield _ask(REQ_PRODUCT, b"", "reading its name")))
    rate = min(max(round(rate_hz), 1), 2000)
    chosen: dict[int, int] = {}
    for optional in ((QUATERNION, TEMPERATURE), (QUATERNION,), ()):
        answer = yield _ask(SET_OUTPUT, _configuration(rate, optional), "choosing its output")
        chosen = _chosen(_data(answer))
        if ACCELERATION in chosen and RATE_OF_TURN in chosen:
            break
    else:
        raise RefusedError(
            f"the Xsens MTi does not offer acceleration and rate of turn at {rate} Hz: lower it"
        )
    if (yield _ask(GO_TO_MEASUREMENT, b"", "starting its stream")) is None:
        raise RefusedError("the Xsens MTi answers but does not start to measure: unplug it and plug it in")
    got = chosen[ACCELERATION]
    notes = () if got == rate else (f"Xsens: {got} Hz instead of {rate}: the most this model offers",)
    version = ".".join(str(part) for part in firmware[:3])
    return XsensSetup(
        product.decode("ascii", "replace").strip(" \0"), serial.hex().upper(), version, got, notes=notes
    )


def _ask(mid: int, data: bytes, what: str) -> Ask:
    return Ask(message(mid, data), what, answer(mid + 1), 0.5, TRIES)


def answer(mid: int) -> FindAnswer:
    """Finds a whole, sound message of this kind, whatever stream it stands in."""

    def find(data: bytes) -> tuple[int, int] | None:
        head = SYNC + bytes([mid])
        at = data.find(head)
        while 0 <= at <= len(data) - 5:
            end = at + 5 + data[at + 3]
            if end <= len(data) and holds(data[at:end]):
                return at, end
            at = data.find(head, at + 1)
        return None

    return find


def _configuration(rate: int, optional: tuple[int, ...]) -> bytes:
    items = [(PACKET_COUNTER, _EVERY), (TIME_FINE, _EVERY), (STATUS_WORD, _EVERY)]
    asked = (ACCELERATION, RATE_OF_TURN, MAGNETIC_FIELD, *optional)
    items += [(kind, round(RATE_HZ) if kind == TEMPERATURE else rate) for kind in asked]
    return b"".join(kind.to_bytes(2) + hertz.to_bytes(2) for kind, hertz in items)


def _data(found: bytes | None) -> bytes:
    return b"" if found is None else data_of(found)


def _chosen(configuration: bytes) -> dict[int, int]:
    """Identifier and rate of each output that the sensor says it will send."""
    pairs = (configuration[at : at + 4] for at in range(0, len(configuration) - 3, 4))
    return {int.from_bytes(pair[:2]): int.from_bytes(pair[2:]) for pair in pairs}


# --- being a sensor ------------------------------------------------------------------------------


class XsensDevice:
    """An MTi as its host sees it: ``receive`` its messages, ``measure`` a sample.

    Freshly powered it measures with its last configuration.
    """

    def __init__(self, axes: Axes = Z_UP, most_hz: int = 400) -> None:
        self.measuring = True
        self.wanted = [PACKET_COUNTER, TIME_FINE, ACCELERATION, RATE_OF_TURN, MAGNETIC_FIELD]
        self._most_hz = most_hz
        self._encoder = XsensEncoder(axes)
        self._frames: Frames = frames()
        self.rate_hz = 100.0  # how often it sends: give it samples at this rate
        self._count = 0
        self._pace = Pace()
        self._rarer: dict[int, Pace] = {}  # what comes less often than the rest
        self._rates: dict[int, int] = {}

    def receive(self, data: bytes) -> bytes:
        """The replies to what the host sent; what is no message is passed over."""
        return b"".join(self._reply(whole[2], data_of(whole)) for whole in self._frames.feed(data))

    def measure(self, sample: Sample) -> bytes:
        """Take a new measurement; while measuring, the message it sends."""
        if not (self.measuring and self._pace.due(sample.device_ns, self.rate_hz)):
            return b""
        self._count += 1
        self._encoder.temperature_c = warming(sample.device_ns)
        ns = sample.device_ns
        left_out = [kind for kind, pace in self._rarer.items() if not pace.due(ns, self._rates[kind])]
        wanted = [kind for kind in self.wanted if kind not in left_out]
        return self._encoder.mtdata2(sample, wanted, self._count)

    def _reply(self, mid: int, data: bytes) -> bytes:
        match mid:
            case 0x30 | 0x10:
                self.measuring = mid == GO_TO_MEASUREMENT
                return message(mid + 1)
            case 0x40:
                self.measuring, self._count = True, 0
                return message(mid + 1) + message(WAKE_UP)
            case 0x00 | 0x12 | 0x1C if not self.measuring:
                told = {REQ_DID: bytes.fromhex("03800123"), REQ_FIRMWARE: bytes([1, 8, 2])}
                return message(mid + 1, told.get(mid, b"MTi-300-emulated    "))
            case 0xC0 if not self.measuring and data and not len(data) % 4:
                return message(mid + 1, self._configure(_chosen(data)))
            case 0x3F:
                self.measuring = False
                return b""
        return message(ERROR, b"\x04")  # a message that is not valid now

    def _configure(self, asked: dict[int, int]) -> bytes:
        """Take what it can send, at the rate it can; the answer is what it took."""
        able = {kind: rate for kind, rate in asked.items() if kind in self._able}
        taken = {k: rate if rate == _EVERY else min(max(rate, 1), self._most_hz) for k, rate in able.items()}
        self.wanted = list(taken)
        self.rate_hz = float(max((rate for rate in taken.values() if rate != _EVERY), default=self.rate_hz))
        self._rates = {kind: rate for kind, rate in taken.items() if rate < self.rate_hz}
        self._rarer = {kind: Pace() for kind in self._rates}
        return b"".join(kind.to_bytes(2) + rate.to_bytes(2) for kind, rate in taken.items())

    _able = frozenset(
        (PACKET_COUNTER, TIME_FINE, STATUS_WORD, TEMPERATURE)
        + (ACCELERATION, RATE_OF_TURN, MAGNETIC_FIELD, QUATERNION)
    )
