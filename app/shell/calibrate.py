"""Shell: a calibration without a browser: a source's samples to the guide, its words to the terminal."""

from __future__ import annotations

import asyncio
import signal
import time
from collections.abc import Callable

from app.calibration.guide import Guide
from app.calibration.words import Calibration
from app.home.calibrations import key_of
from app.motion.basics import G_MPS2, InputError
from app.motion.samples import Sample
from app.motion.source import Link
from app.motion.status import GuideView
from app.sources.opening import open_source
from app.sources.source import Source

#: Between looks at how far it is.
LOOK_S = 0.2
#: Between looks whether samples come at all.
WATCH_S = 1.0

Results = tuple[Calibration, Calibration]


def calibrate(
    spec: str,
    sensor: str | None,
    look: Callable[[GuideView], None],
    gravity_mps2: float = G_MPS2,
    field_ut: float | None = None,
) -> Results:
    """Lead through a calibration of one sensor of a source: the fits and the report's formulas.

    ``sensor``: the first that is heard, if None. ``look`` is shown the guide's view as it changes. Raises
    ``InputError`` where the source ends first, or the readings do not allow it.
    """
    source = open_source(spec, finish=True, changes=False)
    try:
        guide = asyncio.run(_lead(source, sensor, look))
    finally:
        source.close()
    look(guide.view())
    made = time.strftime("%Y-%m-%dT%H:%M:%S%z")
    try:
        return guide.results(made, gravity_mps2, field_ut)
    except ValueError as error:
        raise InputError(f"{spec}: no calibration: {error}; do it again") from None


async def _lead(source: Source, sensor: str | None, look: Callable[[GuideView], None]) -> Guide:
    begun: list[Guide] = []
    task = asyncio.create_task(_listen(source, sensor, look, begun))
    watching = asyncio.create_task(_watch(source, sensor, look, begun))
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, task.cancel)
    try:
        return await task
    except asyncio.CancelledError:
        pass
    finally:
        watching.cancel()
    raise InputError("calibration given up; nothing was saved")


async def _watch(
    source: Source, sensor: str | None, look: Callable[[GuideView], None], begun: list[Guide]
) -> None:
    """Say what is being waited for while no samples come, or only those of others."""
    while True:
        await asyncio.sleep(WATCH_S)
        if source.link in (Link.WAITING, Link.LOST) and source.detail:
            look((begun[0] if begun else Guide("")).view()._replace(note=source.detail))
        elif not begun and sensor is not None and source.info.sensors:
            heard = ", ".join(source.info.sensors)
            look(Guide("").view()._replace(note=f"waiting for {sensor}: only {heard} is heard"))


def _unheard(source: Source, sensor: str | None) -> InputError:
    heard = ", ".join(source.info.sensors) or "none"
    return InputError(f"{source.info.name}: no sample of sensor {sensor!r}, expected one of {heard}")


async def _listen(
    source: Source, sensor: str | None, look: Callable[[GuideView], None], begun: list[Guide]
) -> Guide:
    guide, looked_s, step = None, 0.0, -1
    if source.replay and sensor is not None and sensor not in source.info.sensors:
        raise _unheard(source, sensor)
    async for item in source:
        if not isinstance(item, Sample) or item.sensor != (sensor or item.sensor):
            continue
        sensor = item.sensor
        if guide is None:
            guide = Guide(key_of(source.info, sensor))
            begun.append(guide)
        guide.add(item)
        if guide.done:
            return guide
        now_s = time.monotonic()
        if now_s >= looked_s + LOOK_S or len(guide.legs) != step:
            looked_s, step = now_s, len(guide.legs)
            look(guide.view())
    if guide is None:
        raise _unheard(source, sensor)
    view = guide.view()
    raise InputError(
        f"{source.info.name}: ended at step {view.step + 1} of {view.steps} ({view.words}): nothing was saved"
    )
