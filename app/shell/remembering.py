"""Shell: gyro biases from one walk to the next: looked up with a sensor's first sample, kept at the end."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from datetime import date

from app.estimator.bias import learnt
from app.home import biases, calibrations
from app.motion.basics import InputError
from app.motion.commands import KnowBias, Order
from app.motion.source import SourceInfo
from app.session import Session

log = logging.getLogger(__name__)
_MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")


class Remembering:
    """One source's sensors. ``calibrated`` says when the calibration was made that corrects a sensor.

    A bias is that of samples as corrected: under another calibration it is another bias.
    """

    def __init__(self, info: Callable[[], SourceInfo], calibrated: Callable[[str], str]) -> None:
        self._info, self._calibrated = info, calibrated
        self._looked: set[str] = set()
        self.told: list[Order] = []  # so far: a recording begins with them

    def order(self, sensor: str) -> Order | None:
        """With a sensor's first sample, before it is taken: what its walk is to begin with."""
        if sensor in self._looked:
            return None
        self._looked.add(sensor)
        info = self._info()
        if not remembers(info):
            return None
        try:
            found = biases.load(calibrations.key_of(info, sensor))
        except InputError as error:
            log.warning("%s", error)
            return None
        if found is None or found.calibrated != self._calibrated(sensor):
            return None
        command = KnowBias(sensor, found.bias.rate_b, found.bias.doubt_radps, found_when(found))
        self.told.append(Order(command, "remembered", time.monotonic_ns()))
        return self.told[-1]

    def keep(self, session: Session) -> None:
        """The walk is over: what it taught of its sensors is kept."""
        info = self._info()
        if not remembers(info):
            return
        made = time.strftime("%Y-%m-%dT%H:%M:%S%z")
        for sensor, foot in session.main.feet.items():
            bias = learnt(foot.tracker)
            if bias is None:
                continue
            key = calibrations.key_of(info, sensor)
            try:
                warmth = info.temperatures.get(sensor)
                biases.save(biases.Remembered(key, bias, made, self._calibrated(sensor), warmth))
            except InputError as error:
                log.warning("%s", error)


def found_when(found: biases.Remembered) -> str:
    """``from 3 Nov 2026 at 24 °C``."""
    try:
        day = date.fromisoformat(found.made[:10])
        when = f"{day.day} {_MONTHS[day.month - 1]} {day.year}"
    except ValueError:
        when = found.made[:10]
    return f"from {when}" + ("" if found.temperature_c is None else f" at {found.temperature_c:.0f} °C")


def remembers(info: SourceInfo) -> bool:
    """Whether a source's sensors are worn now: a recording has the bias it was begun with in it."""
    return info.duration_s is None
