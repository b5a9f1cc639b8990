"""Edge: samples as streams of the Lab Streaming Layer, one for each sensor, with their meta-data."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping
from typing import Any

from app.clocks import LiveClock
from app.formats.wire.lsl import CHANNELS, SHOE_AXES, TYPE, row
from app.motion.basics import role_of
from app.motion.samples import Sample

_FULL, _BARE = 9, 6
_LINGER_S = 1.0  # what is left in the outlets is taken so long after the end


class LslSender:
    """Stamps are the sensor's own clock brought onto LSL's, so that bursts on the way do not show."""

    full = False

    def __init__(self, pylsl: Any, name: str, rate_hz: float) -> None:
        self._pylsl, self._name, self._rate_hz = pylsl, name, rate_hz
        self._offset_ns = round(pylsl.local_clock() * 1e9) - time.monotonic_ns()
        self._outlets: dict[str, tuple[Any, int]] = {}
        self._clocks: dict[str, LiveClock] = {}
        self._stamps: dict[str, float] = {}
        self._sent = 0

    def send(self, sample: Sample) -> None:
        """At once."""
        if sample.sensor not in self._outlets:
            self._outlets[sample.sensor] = self._open(sample)
            self._clocks[sample.sensor] = LiveClock()
        outlet, channels = self._outlets[sample.sensor]
        clock = self._clocks[sample.sensor]
        clock.add(sample.device_ns, time.monotonic_ns())
        stamp = (clock.line.host(sample.device_ns) + self._offset_ns) * 1e-9
        stamp = max(stamp, self._stamps.get(sample.sensor, stamp) + 1e-6)
        self._stamps[sample.sensor] = stamp
        outlet.push_sample(row(sample, channels), stamp)
        self._sent += 1

    def warm(self, temperatures: Mapping[str, float]) -> None:
        """A stream's channels are its samples': there is no place for it."""

    def _open(self, sample: Sample) -> tuple[Any, int]:
        channels = _FULL if sample.field_b is not None else _BARE
        name = f"{self._name}_{sample.sensor}"
        info = self._pylsl.StreamInfo(
            name, TYPE, channels, self._rate_hz, self._pylsl.cf_double64, f"stridescope-{name}"
        )
        description = info.desc()
        described = description.append_child("channels")
        for channel in CHANNELS[:channels]:
            entry = described.append_child("channel")
            entry.append_child_value("label", channel.label)
            entry.append_child_value("unit", channel.unit)
            entry.append_child_value("type", channel.kind)
        description.append_child_value("foot", role_of(sample.sensor).value)
        description.append_child_value("axes", SHOE_AXES)
        acquisition = description.append_child("acquisition")
        acquisition.append_child_value("manufacturer", "Stridescope")
        acquisition.append_child_value("model", "forward")
        acquisition.append_child_value("serial_number", sample.sensor)
        return self._pylsl.StreamOutlet(info), channels

    def begin_anew(self, session: int) -> None:
        """The source starts again: its clock has nothing to do with that before."""
        self._clocks = {sensor: LiveClock() for sensor in self._clocks}

    async def run(self) -> None:
        """LSL delivers by itself."""
        await asyncio.Event().wait()

    async def finish(self) -> None:
        """Give those who listen time to take the last."""
        await asyncio.sleep(_LINGER_S if self._outlets else 0.0)

    def summary(self) -> str:
        """What became of the samples, in one line."""
        names = ", ".join(f"{self._name}_{sensor}" for sensor in self._outlets)
        return f"{self._sent} samples sent as {names or 'no stream'}"
