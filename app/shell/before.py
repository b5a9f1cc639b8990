"""Shell: before the walk: calibration and pre-flight beside a running session.

Every sample passes through ``sample``, which corrects it as its sensor was calibrated; what the session and
the recorder take is corrected already, so a recording repeats without the calibration.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from dataclasses import replace

from app.calibration.guide import Guide
from app.calibration.telling import table
from app.calibration.words import Calibration
from app.home import calibrations
from app.motion.basics import InputError, Role
from app.motion.commands import Calibrate, CheckFirst
from app.motion.samples import Sample
from app.motion.snapshot import Snapshot
from app.motion.source import SourceInfo
from app.motion.status import CalibrationView, PreflightView, Status
from app.preflight import Preflight, sentence

#: Between looks at how far both are.
LOOK_S = 0.1


class Before:
    """One source's calibrations and pre-flight. ``mark`` writes a line into a recording, if there is one."""

    def __init__(self, info: Callable[[], SourceInfo], mark: Callable[[str], None]) -> None:
        self.names: dict[str, Role] = {}  # as a tap told
        self._info, self._mark = info, mark
        self._corrections = calibrations.Corrections(info)
        self._used = self._corrections.used
        self._guide: Guide | None = None
        self._guided = ""
        self._results: tuple[Calibration, Calibration] | None = None
        self._found: tuple[str, ...] = ()
        self._fitting: asyncio.Task[None] | None = None
        self._preflight: Preflight | None = None
        self._seen: PreflightView | None = None
        self._shown: CalibrationView | None = None
        self._next_s = 0.0

    # --- samples -----------------------------------------------------------------------------------

    def sample(self, sample: Sample) -> Sample:
        """A sample as it came, to the guide; corrected, to the pre-flight and to whoever takes it."""
        sensor = sample.sensor
        if self._guide is not None and sensor == self._guided and not self._guide.done:
            self._guide.add(sample)
            if self._guide.done:
                self._fitting = asyncio.get_running_loop().create_task(self._fit(self._guide))
        sample = self._corrections.apply(sample)
        if self._preflight is not None:
            self._preflight.add(sample)
        return sample

    @property
    def wants_each(self) -> bool:
        """Whether samples must pass one by one."""
        busy = self._guide is not None or self._preflight is not None
        return busy or any(used is not None for used in self._used.values()) or self._any_kept()

    def calibrated(self, sensor: str) -> str:
        """When the calibration was made that corrects a sensor; empty: none does."""
        used = self._used.get(sensor)
        return "" if used is None else used.made

    def _any_kept(self) -> bool:
        return any(self._corrections.find(sensor) for sensor in self._info().sensors)

    # --- orders ------------------------------------------------------------------------------------

    def calibrate(self, command: Calibrate) -> str:
        """Obey; what to tell the person. What cannot be is ``InputError``."""
        match command.do:
            case "start":
                return self._start(command.sensor)
            case "back" if self._guide is not None:
                self._guide.back()
                self._results, self._found = None, ()
            case "cancel":
                self._guide, self._results, self._found = None, None, ()
            case "save":
                return self._save()
            case "undo" | "redo":
                return self._switch(command.sensor, command.do == "redo")
        return ""

    def _start(self, sensor: str) -> str:
        sensor = sensor if sensor in self._used else next(iter(self._used), "")
        if not sensor:
            raise InputError("no sample yet: a calibration needs a sensor that sends")
        if not calibrations.meant_for(self._info()):
            raise InputError("a recording cannot be calibrated: open the sensor itself, or sim:calibration")
        self._guide = Guide(calibrations.key_of(self._info(), sensor))
        self._guided, self._results, self._found = sensor, None, ()
        return ""

    async def _fit(self, guide: Guide) -> None:
        made = time.strftime("%Y-%m-%dT%H:%M:%S%z")
        try:
            results = await asyncio.to_thread(guide.results, made)
            found = tuple(table(*results))
        except ValueError as error:
            results, found = None, (f"No calibration: {error}. Do it again.",)
        if self._guide is guide and guide.done:  # else given up meanwhile, or a step back
            self._results, self._found = results, found

    def _save(self) -> str:
        if self._results is None:
            raise InputError("no calibration to save: go through the steps first")
        calibrations.save(self._results[0])
        self._used[self._guided] = self._results[0]
        self._corrections.undone.discard(self._guided)
        self._guide, self._results, self._found = None, None, ()
        return f"calibration of {self._guided} saved and applied"

    def _switch(self, sensor: str, on: bool) -> str:
        sensor = sensor if sensor in self._used else next(iter(self._used), "")
        key = calibrations.key_of(self._info(), sensor)
        if not (calibrations.redo(key) if on else calibrations.undo(key)):
            raise InputError(f"calibration of {sensor}: there is none to {'use again' if on else 'undo'}")
        self._corrections.look(sensor)
        return f"calibration of {sensor} {'applied again' if on else 'undone'}, from the next sample on"

    def check(self, command: CheckFirst, roles: dict[str, Role]) -> None:
        """Obey. ``roles``: the feet there are."""
        match command.do:
            case "start":
                if not roles:
                    raise InputError("no sample yet: the pre-flight needs a sensor that sends")
                self._preflight, self._seen = Preflight(roles), None
            case "skip" if self._preflight is not None:
                self._preflight.skip()
            case "swap" if self._preflight is not None:
                self._preflight.swap()
            case "close":
                self._preflight = None

    # --- out ---------------------------------------------------------------------------------------

    def look(self, snapshot: Snapshot, status: Status) -> Status:
        """The status with both views in it; the pre-flight is judged by what is shown."""
        now_s = time.monotonic()
        if now_s >= self._next_s:
            self._next_s = now_s + LOOK_S
            self._shown = self._view()
            if self._preflight is not None:
                self._judge(self._preflight, snapshot)
        return replace(status, calibration=self._shown, preflight=self._seen)

    def _judge(self, preflight: Preflight, snapshot: Snapshot) -> None:
        field = snapshot.main.settings.magnetometer
        self._seen = preflight.look(snapshot.main.feet, snapshot.health, field)
        self.names = dict(self._seen.names)
        if self._seen.done:
            self._preflight = None
            self._mark(sentence(self._seen))

    def _view(self) -> CalibrationView:
        info = self._info()
        applied = {sensor: used.made for sensor, used in self._used.items() if used is not None}
        return CalibrationView(
            sensors=tuple(self._used) if calibrations.meant_for(info) else (),
            applied=applied,
            undone=tuple(sorted(self._corrections.undone)),
            guide=self._guide.view() if self._guide is not None else None,
            found=self._found,
            damaged=self._corrections.damaged,
        )
