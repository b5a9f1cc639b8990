"""What the wire tests share: every protocol with its bounds, and walks to send through them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from app.formats.mounting import AS_GIVEN, Axes, rotation
from app.formats.wire import gx1, lines, mip, ngimu, witmotion, ximu3, xsens
from app.formats.wire.catalogue import Decoder, Model
from app.formats.wire.faults import Line
from app.formats.wire.making import Z_UP
from app.formats.wire.talk import Script, Talk
from app.motion.basics import G_MPS2, Quaternion, Vector
from app.motion.samples import Sample

DEG = math.pi / 180
FLOAT32 = 2.0**-23  # relative


class Encoder(Protocol):
    def encode(self, sample: Sample) -> bytes: ...


@dataclass(frozen=True)
class Wire:
    """``force`` … ``orientation`` bound what the wire loses of a value; ``field_ut`` is a usual field."""

    name: str
    device: str
    decoder: Callable[[Axes], Decoder]
    encoder: Callable[[Axes], Encoder]
    axes: Axes
    force: float
    rate: float
    field: float
    orientation: float
    stamp_ns: int
    largest: int
    has_checksum: bool = True
    field_ut: float = 50.0
    has_field: bool = True
    has_clock: bool = True
    datagrams: bool = False

    def decoded(self, data: bytes, host_ns: int = 0) -> list[Sample]:
        return self.decoder(self.axes).feed(data, host_ns)


GX1_SETUP = gx1.Gx1Setup(8500, 10000, 2000, gx1.FACTORY_TICK_NS)
EULER_SETUP = gx1.Gx1Setup(8500, 10000, 2000, gx1.FACTORY_TICK_NS, command=gx1.EULER)


def _gx1(name: str, setup: gx1.Gx1Setup, **other: Any) -> Wire:
    return Wire(
        name,
        "gx1",
        lambda axes: gx1.Gx1Decoder("foot", axes, setup),
        lambda axes: gx1.Gx1Encoder(axes, setup),
        AS_GIVEN,
        0.5 * 8500 / 32768000 * G_MPS2,
        0.5 * 10000 / 32768000,
        0.5 * 2000 / 32768000 * 100,
        3e-4,
        gx1.FACTORY_TICK_NS // 2,
        31,
        **other,
    )


def _floats(
    name: str, device: str, decoder: Any, encoder: Any, axes: Axes, stamp_ns: int, largest: int, **other: Any
) -> Wire:
    return Wire(name, device, decoder, encoder, axes, 1e-4, 1e-5, 1e-4, 1e-6, stamp_ns, largest, **other)


def _mip(generation: int, stamp_ns: int) -> Wire:
    setup = mip.MipSetup(generation=generation)
    return _floats(
        f"mip-{generation}",
        "mip",
        lambda axes: mip.MipDecoder("foot", axes),
        lambda axes: mip.MipEncoder(axes, setup),
        AS_GIVEN,
        stamp_ns,
        261,
    )


def _ngimu(slip: bool) -> Wire:
    return _floats(
        "ngimu-slip" if slip else "ngimu-udp",
        "ngimu",
        lambda axes: ngimu.NgimuDecoder("foot", axes, slip),
        lambda axes: ngimu.NgimuEncoder(axes, slip),
        Z_UP,
        0,
        2048 if slip else 0,
        has_checksum=False,
        datagrams=not slip,
    )


def _lines(style: str) -> Wire:
    return _floats(
        f"lines-{style}",
        "csv",
        lambda axes: lines.LinesDecoder("foot", axes),
        lambda axes: lines.LinesEncoder(axes, style, with_orientation=True),
        Z_UP,
        500,
        1024,
        has_checksum=False,
    )


WIRES = (
    _gx1("gx1-quaternion", GX1_SETUP),
    _gx1("gx1-euler", EULER_SETUP, has_field=False),
    _mip(7, 0),
    _mip(5, 1),
    _floats(
        "xsens",
        "xsens",
        lambda axes: xsens.XsensDecoder("foot", axes),
        lambda axes: xsens.XsensEncoder(axes),
        Z_UP,
        50_000,
        2055,
        field_ut=1.0,
    ),
    Wire(
        "witmotion",
        "witmotion",
        lambda axes: witmotion.WitmotionDecoder("foot", axes),
        lambda axes: witmotion.WitmotionEncoder(axes),
        Z_UP,
        0.5 * 16 * G_MPS2 / 32768,
        0.5 * 2000 * DEG / 32768,
        0.5,
        1e-4,
        0,
        11,
        field_ut=3000.0,
        has_clock=False,
    ),
    Wire(
        "witmotion-timed",
        "witmotion",
        lambda axes: witmotion.WitmotionDecoder("foot", axes),
        lambda axes: witmotion.WitmotionEncoder(axes, timed=True),
        Z_UP,
        0.5 * 16 * G_MPS2 / 32768,
        0.5 * 2000 * DEG / 32768,
        0.5,
        1e-4,
        500_000,
        11,
        field_ut=3000.0,
    ),
    _floats(
        "ximu3-binary",
        "ximu3",
        lambda axes: ximu3.Ximu3Decoder("foot", axes),
        lambda axes: ximu3.Ximu3Encoder(axes),
        Z_UP,
        500,
        1024,
        has_checksum=False,
        field_ut=1.0,
    ),
    Wire(
        "ximu3-ascii",
        "ximu3",
        lambda axes: ximu3.Ximu3Decoder("foot", axes),
        lambda axes: ximu3.Ximu3Encoder(axes, binary=False),
        Z_UP,
        0.5e-4 * G_MPS2,
        0.5e-4 * DEG,
        0.5e-4,
        1.5e-4,
        500,
        1024,
        has_checksum=False,
        field_ut=1.0,
    ),
    _ngimu(True),
    _ngimu(False),
    _lines("csv"),
    _lines("json"),
)
#: All mountings that are rotations.
AXES: list[Axes] = [
    ((i, a), (j, b), (k, c))
    for i, j, k in itertools.permutations(range(3))
    for a, b, c in itertools.product((1, -1), repeat=3)
    if np.linalg.det(rotation(((i, a), (j, b), (k, c)))) > 0
]


def walk(wire: Wire, count: int, seed: int = 0, start_ns: int = 0, step_ns: int = 10_000_000) -> list[Sample]:
    """Samples at random inside every sensor's range, ``step_ns`` apart."""
    rng = np.random.default_rng(seed)
    force, rate = rng.uniform(-40, 40, (count, 3)), rng.uniform(-4, 4, (count, 3))
    field = rng.uniform(-1, 1, (count, 3)) * wire.field_ut
    q = rng.normal(size=(count, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    # Euler angles lose their meaning upright; all else takes any orientation
    q[np.abs(q[:, 0] * q[:, 2] - q[:, 1] * q[:, 3]) > 0.49] = [1.0, 0.0, 0.0, 0.0]
    return [
        Sample(
            "foot",
            i,
            start_ns + i * step_ns,
            0,
            tuple(force[i].tolist()),
            tuple(rate[i].tolist()),
            tuple(field[i].tolist()) if wire.has_field else None,
            0,
            tuple(q[i].tolist()),
        )
        for i in range(count)
    ]


def packets(wire: Wire, samples: list[Sample]) -> list[bytes]:
    encoder = wire.encoder(wire.axes)
    return [encoder.encode(sample) for sample in samples]


def fed(decoder: Decoder, chunks: list[bytes], step_ns: int = 10_000_000) -> list[Sample]:
    """What a decoder makes of chunks that arrive ``step_ns`` apart."""
    return [sample for i, chunk in enumerate(chunks) for sample in decoder.feed(chunk, i * step_ns)]


def adds_up(decoder: Decoder) -> bool:
    c = decoder.counters
    return c.bytes_fed == c.bytes_good + c.bytes_skipped + c.bytes_pending


def readings(samples: list[Sample]) -> list[tuple[Any, ...]]:
    """Samples without what depends on when and after what they came."""
    return [(s.specific_force_b, s.angular_rate_b) for s in samples]


def converse(
    script: Script[Any],
    model: Model,
    samples: Iterable[Sample] = (),
    lost: int = 0,
    line: Line | None = None,
) -> Talk[Any]:
    """A start-up against a device that goes on measuring; its first ``lost`` answers never arrive.

    What it sends comes by ``line``.
    """
    carry = line.carry if line else bytes
    talk, waiting = Talk(script), iter(samples)
    for _ in range(400):
        if talk.ask is None:
            return talk
        answer = model.receive(talk.ask.send)
        if answer and lost:
            lost, answer = lost - 1, b""
        streamed = b"".join(model.measure(sample) for sample in itertools.islice(waiting, 3))
        if not talk.receive(carry(streamed + answer)):
            talk.expire()
    raise AssertionError("the conversation never ends")


def at_rest(
    count: int,
    force: Vector = (0.0, 0.0, -G_MPS2),
    q: Quaternion = (1.0, 0.0, 0.0, 0.0),
    step_ns: int = 10_000_000,
) -> list[Sample]:
    """Samples of a still shoe, level unless said otherwise."""
    still, field = (0.0, 0.0, 0.0), (20.0, 0.0, 44.0)
    return [Sample("foot", i, i * step_ns, 0, force, still, field, 0, q) for i in range(count)]


def result(talk: Talk[Any]) -> Any:
    """What a conversation that went well found."""
    assert talk.failed == ""
    assert talk.result is not None
    return talk.result
