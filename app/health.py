"""Heart: how sound a sensor's stream is: its last ten seconds, one light, and the reason in words.

A ring of one-second bins, so a sample costs the same after an hour. What is lost is told by the sensor's own
stamps: a step of k usual steps lost k − 1 samples, unless it is so long that the sensor was cut off: no radio
loses samples like that, but a cable that is out does.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from statistics import median
from typing import NamedTuple

from app.clocks import Clock
from app.motion.basics import G_MPS2, GaitPhase, Role, Vector
from app.motion.health import Health, Light, Recent
from app.motion.samples import GAP_NS, Sample

BINS = 10
BIN_NS = 1_000_000_000
#: Steps between stamps by which the usual step is told.
STEPS = 64
#: Over this time the force's scatter is taken; its least in a stance is how still the foot got.
QUIET_S = 0.1
#: Who stands for long tells it this often.
STAND_NS = 500_000_000
#: So many stances tell something.
STANCES = 4
FEET = {Role.LEFT: "left foot", Role.RIGHT: "right foot", Role.FOOT: "foot", Role.OTHER: "sensor"}


@dataclass
class Bin:
    """One second's counts and sums."""

    second: int
    samples: int = 0
    lost: int = 0
    cut_s: float = 0.0  # without a sample at all, before the first that came again
    duplicated: int = 0
    rejected: int = 0
    saturated: int = 0
    late: float = 0.0  # ms, and its squares
    late2: float = 0.0
    late_most: float = 0.0
    stances: int = 0
    scatter2: float = 0.0  # the variance of |f| where a stance was stillest, (m/s²)²
    force: float = 0.0  # |f| there, m/s²
    fields: int = 0
    field2: float = 0.0  # (|m| there / at the start − 1)²


class Monitor:
    """Watches one sensor's samples as they are taken. O(1) for each, in time and memory."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._bins: deque[Bin] = deque([Bin(0)], maxlen=BINS)
        self._last_ns: int | None = None
        self._steps: deque[int] = deque(maxlen=STEPS)
        self._step_ns = 0.0
        self._until_median = STEPS
        self._stance = Stance()
        self._strength = 0.0  # of the field at the start, the mean of the first stances
        self._strengths = 0

    def add(self, sample: Sample, kept: bool, phase: GaitPhase) -> None:
        """A sample, whether it was kept, and the phase that the main track gave it."""
        if not kept:
            again = sample.device_ns == self._last_ns
            self._bins[-1].duplicated += again
            self._bins[-1].rejected += not again
            return
        now = self._bin(sample.device_ns // BIN_NS)
        now.samples += 1
        now.saturated += sample.saturation != 0
        if self._last_ns is not None:
            self._step(now, sample.device_ns - self._last_ns)
        self._last_ns = sample.device_ns
        late_ms = (sample.host_ns - self._clock.line.host(sample.device_ns)) * 1e-6
        now.late += late_ms
        now.late2 += late_ms * late_ms
        now.late_most = max(now.late_most, late_ms)
        stillest = self._stance.add(sample, phase, self._step_ns)
        if stillest is not None:
            self._stand(now, stillest)

    def skip(self) -> None:
        """Samples went by unwatched: the next one follows no other."""
        self._last_ns = None

    def _bin(self, second: int) -> Bin:
        if second != self._bins[-1].second:
            while self._bins and not 0 <= second - self._bins[0].second < BINS:
                self._bins.popleft()
            self._bins.append(Bin(second))
        return self._bins[-1]

    def _step(self, now: Bin, step_ns: int) -> None:
        usual_ns = self._step_ns
        if usual_ns and step_ns > max(GAP_NS, 3.0 * usual_ns):
            now.cut_s += step_ns * 1e-9
        elif usual_ns and step_ns > 1.5 * usual_ns:
            now.lost += round(step_ns / usual_ns) - 1
        self._steps.append(step_ns)
        self._until_median -= 1
        if not self._until_median:
            self._step_ns, self._until_median = median(self._steps), STEPS

    def _stand(self, now: Bin, stillest: Stillest) -> None:
        now.stances += 1
        now.scatter2 += stillest.variance
        now.force += stillest.force
        if stillest.strength > 0.0:
            if self._strengths < STANCES:
                self._strengths += 1
                self._strength += (stillest.strength - self._strength) / self._strengths
            now.fields += 1
            now.field2 += (stillest.strength / self._strength - 1.0) ** 2

    def recent(self, silent_s: float, live: bool) -> Recent:
        """The last ten seconds. Arrivals tell something of a live sensor only."""
        bins = self._bins
        samples = sum(b.samples for b in bins)
        stances, fields = sum(b.stances for b in bins), sum(b.fields for b in bins)
        late = sum(b.late for b in bins) / max(samples, 1)
        jitter = math.sqrt(max(sum(b.late2 for b in bins) / max(samples, 1) - late * late, 0.0))
        return Recent(
            rate_hz=1e9 / self._step_ns if self._step_ns else 0.0,
            samples=samples,
            lost=sum(b.lost for b in bins),
            duplicated=sum(b.duplicated for b in bins),
            rejected=sum(b.rejected for b in bins),
            saturated=sum(b.saturated for b in bins),
            jitter_ms=jitter if live and samples else None,
            late_ms=max(b.late_most for b in bins) if live and samples else None,
            stance_mps2=math.sqrt(sum(b.scatter2 for b in bins) / stances) if stances >= STANCES else None,
            gravity_mps2=sum(b.force for b in bins) / stances if stances >= STANCES else None,
            disturbance=math.sqrt(sum(b.field2 for b in bins) / fields) if fields >= STANCES else None,
            drift_ppm=self._clock.line.drift_ppm if self._clock.settled else None,
            silent_s=silent_s,
            cut_s=sum(b.cut_s for b in bins),
        )


class Stillest(NamedTuple):
    """Where a stance was stillest."""

    variance: float  # of |f| over about a tenth of a second, (m/s²)²
    force: float  # its mean, m/s²
    strength: float  # of the field, µT; 0 without one


class Stance:
    """Finds the stillest moment of each stance, by a fading mean and variance of |f|."""

    def __init__(self) -> None:
        self._mean = self._variance = self._quiet_s = 0.0
        self._stillest: Stillest | None = None
        self._since_ns = 0

    def add(self, sample: Sample, phase: GaitPhase, step_ns: float) -> Stillest | None:
        """The stillest moment of a stance that ended with this sample, or of half a second of standing."""
        if phase is GaitPhase.SWING:
            self._quiet_s, ended, self._stillest = 0.0, self._stillest, None
            return ended
        force, step_s = _length(sample.specific_force_b), step_ns * 1e-9
        if self._quiet_s == 0.0:
            self._mean, self._variance, self._since_ns = force, 0.0, sample.device_ns
        self._quiet_s += step_s
        share = min(step_s / QUIET_S, 0.5)
        away = force - self._mean
        self._mean += share * away
        self._variance += share * (away * away * (1.0 - share) - self._variance)
        settled = self._quiet_s > 1.5 * QUIET_S
        if settled and (self._stillest is None or self._variance < self._stillest.variance):
            strength = 0.0 if sample.field_b is None else _length(sample.field_b)
            self._stillest = Stillest(self._variance, self._mean, strength)
        if sample.device_ns - self._since_ns < STAND_NS:
            return None
        self._since_ns, ended, self._stillest = sample.device_ns, self._stillest, None
        return ended


def _length(v: Vector) -> float:
    return math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


# --- the light -----------------------------------------------------------------------------------

SILENT_S = 0.5
LATE_MS = (100.0, 500.0)
LOST, SATURATED, SPOILT = (0.01, 0.05), (0.02, 0.10), (0.01, 0.10)
SLOW_HZ = 50.0
STANCE_MPS2 = (1.5, 4.0)
GRAVITY_MPS2 = (G_MPS2, 0.35)  # and how far a sensor that needs no calibration may be off
DISTURBANCE = 0.20
DRIFT_PPM = 500.0


def percent(share: float) -> str:
    """``0.35 %``, ``7.5 %``, ``100 %``."""
    return f"{100.0 * share:.0f} %" if share > 0.0995 else f"{100.0 * share:.2g} %"


def judge(role: Role, recent: Recent, uses_field: bool) -> tuple[Light, str]:
    """The worst of what is seen: its light, and what it is and what to do in words.

    ``uses_field``: the walk's heading comes from the magnetometer, so its disturbance matters.
    """
    found = [*_transport(recent), *_sensing(recent, uses_field)]
    for light in (Light.RED, Light.AMBER):
        for level, words in found:
            if level is light:
                return light, f"{FEET[role]}: {words}"
    return Light.GREEN, ""


def _transport(r: Recent) -> list[tuple[Light, str]]:
    """What the link does to the samples."""
    all_of = max(r.samples + r.lost, 1)
    came = max(r.samples + r.duplicated + r.rejected, 1)
    found = []
    if r.silent_s > SILENT_S:
        found.append((Light.RED, f"silent for {r.silent_s:.1f} s: is it on, charged and in reach?"))
    if r.cut_s > 0.0:
        gone = f"nothing came from it for {r.cut_s:.1f} s"
        found.append((Light.AMBER, f"{gone}: was it unplugged, without power or out of reach?"))
    if r.lost >= 3 and (light := light_of(r.lost / all_of, LOST)):
        share = f"{percent(r.lost / all_of)} of samples lost in the last 10 s"
        found.append((light, f"{share}: move the receiver closer"))
    if r.late_ms is not None and (light := light_of(r.late_ms, LATE_MS)):
        found.append(
            (light, f"samples come up to {r.late_ms:.0f} ms late: a shorter link, or fewer devices on it")
        )
    if r.rejected >= 3 and (light := light_of(r.rejected / came, SPOILT)):
        share = f"{percent(r.rejected / came)} of samples are no use (not finite, or out of order)"
        found.append((light, f"{share}: check cable and baud rate"))
    if r.duplicated >= 3 and (light := light_of(r.duplicated / came, SPOILT)):
        share = f"{percent(r.duplicated / came)} of samples came twice"
        found.append((light, f"{share}: is it sent over two ways?"))
    if 0.0 < r.rate_hz < SLOW_HZ:
        found.append(
            (Light.AMBER, f"{r.rate_hz:.0f} samples a second: set the sensor to {SLOW_HZ:.0f} or more")
        )
    if r.drift_ppm is not None and abs(r.drift_ppm) > DRIFT_PPM:
        off = f"its clock is {abs(r.drift_ppm) * 1e-4:.2g} % too {'fast' if r.drift_ppm > 0 else 'slow'}"
        found.append((Light.AMBER, f"{off}: lengths are off by twice that; check its rate setting"))
    return found


def _sensing(r: Recent, uses_field: bool) -> list[tuple[Light, str]]:
    """What the sensor itself does."""
    found = []
    usual, most = GRAVITY_MPS2
    if r.samples and (light := light_of(r.saturated / r.samples, SATURATED)):
        share = f"{percent(r.saturated / r.samples)} of samples at the end of the sensor's range"
        found.append((light, f"{share}: choose a larger range"))
    if r.stance_mps2 is not None and (light := light_of(r.stance_mps2, STANCE_MPS2)):
        shakes = f"it shakes by {r.stance_mps2:.1f} m/s² while the foot stands"
        found.append((light, f"{shakes}: tighten the strap"))
    if r.gravity_mps2 is not None and abs(r.gravity_mps2 - usual) > most:
        found.append((Light.AMBER, f"gravity reads {r.gravity_mps2:.2f} m/s² at rest: calibrate the sensor"))
    if uses_field and r.disturbance is not None and r.disturbance > DISTURBANCE:
        off = f"the magnetic field strays by {100.0 * r.disturbance:.0f} %"
        found.append((Light.AMBER, f"{off}: iron is near; walk elsewhere or switch the magnetometer off"))
    return found


def light_of(value: float, limits: tuple[float, float]) -> Light | None:
    """Amber or red from these limits on; None below."""
    amber, red = limits
    return Light.RED if value >= red else Light.AMBER if value >= amber else None


def report(health: Mapping[str, Health]) -> dict[str, object]:
    """For machines: each sensor's counters, its last ten seconds, light and reason."""
    return {
        sensor: {
            "light": told.light.value,
            "reason": told.reason,
            "taken": told.taken,
            "dropped": dict(told.dropped),
            "saturated": told.saturated,
            "segments": told.segments,
            "last_10_s": told.recent._asdict() if told.recent else None,
        }
        for sensor, told in health.items()
    }
