"""Shell: gyro biases from one walk to the next: looked up with a sensor's first sample, kept at the end."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable

from app.estimator.bias import learnt
from app.home import biases, calibrations
from app.motion.basics import InputError
from app.motion.commands import KnowBias, Order
from app.motion.source import SourceInfo
from app.session import Session

log = logging.getLogger(__name__)


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
        source = f"found {found.made[:10]}"
        command = KnowBias(sensor, found.bias.rate_b, found.bias.doubt_radps, source)
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
                biases.save(biases.Remembered(key, bias, made, self._calibrated(sensor)))
            except InputError as error:
                log.warning("%s", error)


def remembers(info: SourceInfo) -> bool:
    """Whether a source's sensors are worn now: a recording has the bias it was begun with in it."""
    return info.duration_s is None
