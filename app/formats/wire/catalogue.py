"""Heart: the sensors that are spoken to: for each its decoder, its start-up and its model, in one table.

The keys are those of ``serial:…?device=``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from app.formats.mounting import AS_GIVEN, Axes
from app.formats.wire import (
    gx1,
    gx1_talk,
    lines,
    mip,
    mip_talk,
    ngimu,
    witmotion,
    ximu3,
    ximu3_talk,
    xsens,
    xsens_talk,
)
from app.formats.wire.making import Z_UP
from app.formats.wire.stream import Counters
from app.formats.wire.talk import Script
from app.motion.samples import Sample


class Decoder(Protocol):
    """Bytes in, samples out. ``notes`` are sentences on what was assumed or found; they may grow.

    ``temperature_c`` is what the sensor's thermometer read last; a decoder that is asked for it seldom may
    look it up then, but spends nothing on it with each sample.
    """

    counters: Counters
    notes: list[str]

    @property
    def temperature_c(self) -> float | None:
        """The sensor's temperature, °C; None while it told none."""

    def feed(self, data: bytes, host_ns: int) -> list[Sample]:
        """The samples that ``data``, arrived at ``host_ns``, completes."""


class Model(Protocol):
    """A device as its host sees it, for the emulator."""

    @property
    def rate_hz(self) -> float:
        """How often it measures as it is set now; faster samples are passed over."""

    def receive(self, data: bytes) -> bytes:
        """The replies to what the host sent."""

    def measure(self, sample: Sample) -> bytes:
        """What it sends for a new measurement."""


@dataclass(frozen=True)
class Kind:
    """One protocol. ``start_up`` is given the rate wanted; its result is the decoder's ``setup``.

    Without a ``start_up`` the device streams by itself. ``bauds`` stand in the order to try them.
    ``sample_bytes`` is what a sample with everything takes on the line, about. ``question`` is sent every few
    seconds to one that tells its temperature only when asked.
    """

    title: str
    bauds: tuple[int, ...]
    axes: Axes  # the mounting where nobody says otherwise
    fastest_hz: float
    sample_bytes: int
    decoder: Callable[[str, Axes, Any], Decoder]  # sensor, mounting, setup or None
    model: Callable[[Axes], Model]
    start_up: Callable[[float], Script[Any]] | None = None
    question: bytes = b""


KINDS: dict[str, Kind] = {
    "gx1": Kind(
        "MicroStrain 3DM-GX1",
        gx1_talk.AUTO_BAUDS,
        AS_GIVEN,
        gx1.FASTEST_HZ,
        31,
        gx1.Gx1Decoder,
        gx1_talk.Gx1Device,
        lambda _: gx1_talk.start_up(),  # its rate is its EEPROM's
        bytes([gx1.TEMPERATURE]),
    ),
    "mip": Kind(
        "MicroStrain/HBK MIP",
        mip_talk.BAUDS,
        AS_GIVEN,
        mip.FASTEST_HZ,
        80,
        mip.MipDecoder,
        mip_talk.MipDevice,
        mip_talk.start_up,
    ),
    "ximu3": Kind(
        "x-io x-IMU3",
        ximu3_talk.BAUDS,
        Z_UP,
        ximu3.FASTEST_HZ,
        83,
        lambda sensor, axes, _: ximu3.Ximu3Decoder(sensor, axes),
        ximu3_talk.Ximu3Device,
        ximu3_talk.start_up,
    ),
    "ngimu": Kind(
        "x-io NGIMU (serial)",
        (115200,),
        Z_UP,
        ngimu.FASTEST_HZ,
        128,
        lambda sensor, axes, _: ngimu.NgimuDecoder(sensor, axes, slip=True),
        lambda axes: ngimu.NgimuDevice(axes, slip=True),
    ),
    "xsens": Kind(
        "Xsens MTi",
        xsens_talk.BAUDS,
        Z_UP,
        xsens.FASTEST_HZ,
        81,
        xsens.XsensDecoder,
        xsens_talk.XsensDevice,
        xsens_talk.start_up,
    ),
    "witmotion": Kind(
        "WitMotion",
        witmotion.BAUDS,
        Z_UP,
        witmotion.FASTEST_HZ,
        44,
        witmotion.WitmotionDecoder,
        witmotion.WitmotionDevice,
        witmotion.start_up,
    ),
    "csv": Kind(
        "text lines",
        lines.BAUDS,
        Z_UP,
        lines.FASTEST_HZ,
        146,
        lambda sensor, axes, columns: lines.LinesDecoder(sensor, axes, columns),
        lines.LinesDevice,
    ),
}
