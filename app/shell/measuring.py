"""Shell: a few seconds of a live sensor, for the doctor: its rate, its jitter, what is lost or damaged."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence

from app.clocks import LiveClock
from app.damage import Damage
from app.health import Monitor, judge
from app.motion.basics import GaitPhase, InputError, role_of
from app.motion.health import Light, Recent
from app.motion.samples import Sample
from app.shell.doctor import Finding
from app.sources.opening import open_live
from app.sources.source import Source
from app.sources.spec import LIVE, parse_spec

#: A port is searched for a sensor, a sensor started, its clock measured.
WAIT_S = 25.0
SETTLE_S = 1.0
MEASURE_S = 5.0
STATES = {Light.GREEN: "ok", Light.AMBER: "advice", Light.RED: "problem"}


def measured(specs: Sequence[str], seconds: float = MEASURE_S) -> list[Finding]:
    """What each of these live sources sends, all at once; ``InputError`` for a SPEC that cannot be."""
    return asyncio.run(_all(specs, seconds))


async def _all(specs: Sequence[str], seconds: float) -> list[Finding]:
    every = await asyncio.gather(*(_one(spec, seconds) for spec in specs))
    return [finding for findings in every for finding in findings]


async def _one(text: str, seconds: float) -> list[Finding]:
    spec = parse_spec(text)
    if spec.kind not in LIVE or spec.kind == "phone":
        raise InputError(f"{text}: expected a live sensor: serial:PORT, ws:PORT, udp:PORT or lsl:NAME")
    source = open_live(spec)
    try:
        return await _listen(source, seconds)
    finally:
        source.close()


async def _listen(source: Source, seconds: float) -> list[Finding]:
    monitors: dict[str, Monitor] = {}
    clocks: dict[str, LiveClock] = {}
    damage, begins = Damage(), asyncio.Event()

    async def take() -> None:
        async for item in source:
            if isinstance(item, Sample):
                clock = clocks.setdefault(item.sensor, LiveClock())
                monitor = monitors.setdefault(item.sensor, Monitor(clock))
                clock.add(item.device_ns, item.host_ns)
                monitor.add(item, True, GaitPhase.SWING)  # nobody need stand still for it
                begins.set()

    task = asyncio.create_task(take())
    try:
        async with asyncio.timeout(WAIT_S):
            await begins.wait()
    except TimeoutError:
        told = source.detail or "nothing comes"
        return [Finding(source.info.name, "advice", told, "switch the sensor on; say device= and baud=")]
    else:
        await asyncio.sleep(SETTLE_S)
        monitors.clear()  # what had waited while it was started says nothing of its jitter
        _shares(damage, source)
        await asyncio.sleep(seconds)
        shares = _shares(damage, source)
    finally:
        task.cancel()
    return [
        _finding(source, sensor, monitor.recent(0.0, live=True)._replace(damaged=shares.get(sensor, 0.0)))
        for sensor, monitor in monitors.items()
    ]


def _shares(damage: Damage, source: Source) -> dict[str, float]:
    now_s = time.monotonic()
    return {sensor: damage.share(sensor, counted, now_s) for sensor, counted in source.counters.items()}


def _finding(source: Source, sensor: str, recent: Recent) -> Finding:
    light, reason = judge(role_of(sensor), recent, uses_field=False)
    if recent.damaged and light is Light.GREEN:
        light, reason = Light.AMBER, "damaged packets: check cable, plug and baud rate"
    lost = f"{recent.lost} of {recent.samples + recent.lost} lost" if recent.lost else "nothing lost"
    damaged = f", {100.0 * recent.damaged:.2g} % damaged" if recent.damaged else ""
    rate = f"{recent.rate_hz:.1f} Hz, jitter {recent.jitter_ms or 0.0:.1f} ms"
    good = ", as it should" if light is Light.GREEN else ""
    told = f"{source.info.format}: {rate}, {lost}{damaged}{good}"
    return Finding(f"{source.info.name} {sensor}", STATES[light], told, reason)
