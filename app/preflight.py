"""Heart: the look before a walk: still, rate, range, heading, a short loop; each line green or what to do.

Fed with every sample, and ten times a second with what the page is shown. The lines stand in the order in
which a person does them, but each is judged as soon as there is something to judge.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from app.calibration.still import Pose, Stillness
from app.health import DRIFT_PPM, FEET, GRAVITY_MPS2, LOST, SLOW_HZ
from app.motion.basics import G_MPS2, Role
from app.motion.health import Health
from app.motion.samples import Sample
from app.motion.snapshot import FootView
from app.motion.status import Line, LineState, PreflightView
from app.rotation import yaw_of

STILL_S, END_STILL_S = 2.0, 1.2
RATE_S = 4.0
#: A foot that was stamped or swung read more than this at least, m/s².
MOVED_MPS2 = 15.0
#: Of what was read while it moved, so much may touch the end of the range.
SATURATED = 0.02
#: A tap: one shoe turns faster than this while the others turn slower than that, rad/s.
TAP_RADPS, QUIET_RADPS = 2.0, 0.7
TAP_NS = 400_000_000
#: A loop worth judging, and how near its end must be to its start.
LOOP_M, NEAR_M, NEAR = 4.0, 0.3, 0.04
#: Two feet on one floor point within this of each other.
APART_RAD = math.radians(35.0)
WEAK_UT, STRONG_UT = 15.0, 90.0

WAIT, NOW, GOOD, BAD = LineState


class Foot:
    """What one sensor showed so far."""

    def __init__(self) -> None:
        self.still = Stillness()
        self.pose: Pose | None = None  # now
        self.rest: Pose | None = None  # of the first still time that was long enough
        self.begin_ns = self.last_ns = 0
        self.most_mps2 = 0.0
        self.moving = self.saturated = 0
        self.turned_ns = 0  # when it last turned fast
        self.stirred_ns = 0  # when it last turned at all

    def add(self, sample: Sample) -> None:
        """One sample."""
        if not self.begin_ns or sample.device_ns < self.last_ns:  # the source began anew
            self.begin_ns = sample.device_ns
        self.last_ns = sample.device_ns
        self.pose = self.still.add(sample)
        if self.rest is None:
            self.rest = self.pose if self.pose is not None and self.pose.seconds >= STILL_S else None
            return
        force = math.hypot(*sample.specific_force_b)
        if self.pose is None:
            self.moving += 1
            self.saturated += sample.saturation != 0
            self.most_mps2 = max(self.most_mps2, force)

    def turns(self, sample: Sample) -> None:
        """Note how fast the shoe turns, on the host's clock, which all shoes share."""
        rate = math.hypot(*sample.angular_rate_b)
        if rate > TAP_RADPS:
            self.turned_ns = sample.host_ns
        if rate > QUIET_RADPS:
            self.stirred_ns = sample.host_ns


class Preflight:
    """One look. ``sensors`` are the feet's; with two of them that are not left and right a tap names them."""

    def __init__(self, roles: Mapping[str, Role]) -> None:
        self.names: dict[str, Role] = dict(roles)  # as named by a tap
        self._feet = {sensor: Foot() for sensor in roles}
        self._unnamed = len(roles) == 2 and set(roles.values()) != {Role.LEFT, Role.RIGHT}
        self._asks_name = self._unnamed
        self._tap: tuple[str, int] | None = None  # which shoe, and when
        self._starts: dict[str, FootView] = {}
        self._lines: dict[str, Line] = {}
        self._skipped: set[str] = set()

    def add(self, sample: Sample) -> None:
        """One sample of any sensor."""
        foot = self._feet.get(sample.sensor)
        if foot is None:
            return
        foot.add(sample)
        foot.turns(sample)
        if self._unnamed and all(foot.rest is not None for foot in self._feet.values()):
            self._name(sample)

    def _name(self, sample: Sample) -> None:
        """The shoe that was tapped while the other rested, before and after, is the left."""
        if self._tap is None:
            if self._feet[sample.sensor].turned_ns == sample.host_ns:
                self._tap = (sample.sensor, sample.host_ns)
            return
        tapped, tap_ns = self._tap
        if sample.host_ns - tap_ns < TAP_NS:
            return
        other = next(sensor for sensor in self._feet if sensor != tapped)
        self._tap = None
        if tap_ns - self._feet[other].stirred_ns > TAP_NS:
            self.names = {tapped: Role.LEFT, other: Role.RIGHT}
            self._unnamed = False

    def swap(self) -> None:
        """The shoes are the other way round."""
        if len(self.names) == 2 and not self._unnamed:
            one, two = self.names
            self.names = {one: self.names[two], two: self.names[one]}

    def skip(self) -> None:
        """Go on without the line under way."""
        now = next((line for line in self._lines.values() if line.state is NOW), None)
        if now is not None:
            self._skipped.add(now.name)

    # --- judging -----------------------------------------------------------------------------------

    def look(self, feet: Sequence[FootView], health: Mapping[str, Health], uses_field: bool) -> PreflightView:
        """Every line as it stands, from what the page is shown now."""
        views = {view.sensor: view for view in feet if view.sensor in self._feet}
        found = [self._still()]
        if self._asks_name:
            found.append(self._named())
        found += [self._rate(health), self._range(), self._heading(views, uses_field), self._loop(views)]
        self._lines = {line.name: line for line in self._in_turn(found)}
        lines = tuple(self._lines.values())
        done = all(line.state in (GOOD, BAD) for line in lines)
        words = next((line.told for line in lines if line.state is NOW), "")
        good = done and all(line.state is GOOD for line in lines)
        last_s = max((foot.last_ns - foot.begin_ns for foot in self._feet.values()), default=0) * 1e-9
        return PreflightView(lines, words, done, good, last_s, tuple(self.names.items()))

    def _in_turn(self, found: list[Line]) -> list[Line]:
        """What was judged stays; the first that was not is to be done now, the others wait."""
        lines, asked = [], False
        for line in found:
            kept = self._lines.get(line.name)
            if kept is not None and kept.state in (GOOD, BAD):
                lines.append(kept)
            elif line.name in self._skipped and line.state is WAIT:
                lines.append(line._replace(state=BAD, told="skipped"))
            elif line.state is WAIT and not asked:
                lines.append(line._replace(state=NOW))
                asked = True
            else:
                lines.append(line)
        return lines

    def _who(self, sensor: str) -> str:
        return FEET[self.names[sensor]]

    def _still(self) -> Line:
        rests = {sensor: foot.rest for sensor, foot in self._feet.items() if foot.rest is not None}
        if len(rests) < len(self._feet):
            part = min((foot.pose.seconds if foot.pose else 0.0 for foot in self._feet.values()), default=0.0)
            return Line(
                "still", WAIT, f"Stand still, toes the way you will walk ({min(part, STILL_S):.1f} of 2 s)."
            )
        usual, most = GRAVITY_MPS2
        for sensor, pose in rests.items():
            gravity = math.hypot(*pose.force)
            if abs(gravity - usual) > most:
                told = f"{self._who(sensor)}: gravity reads {gravity:.2f} m/s²: calibrate the sensor."
                return Line("still", BAD, told)
        drift = max(math.degrees(math.hypot(*pose.rate)) for pose in rests.values())
        gravity = sum(math.hypot(*pose.force) for pose in rests.values()) / len(rests)
        return Line("still", GOOD, f"gravity {gravity:.2f} m/s², gyro at rest {drift:.2f} °/s")

    def _named(self) -> Line:
        if self._unnamed:
            return Line("name", WAIT, "Tap the toe of your left shoe on the floor; keep the other still.")
        return Line(
            "name", GOOD, ", ".join(f"{sensor} is {role.value}" for sensor, role in self.names.items())
        )

    def _rate(self, health: Mapping[str, Health]) -> Line:
        seen_s = min((foot.last_ns - foot.begin_ns for foot in self._feet.values()), default=0) * 1e-9
        if seen_s < RATE_S:
            return Line("rate", WAIT, f"Counting samples ({seen_s:.0f} of {RATE_S:.0f} s).")
        rates = []
        for sensor in self._feet:
            recent = health[sensor].recent if sensor in health else None
            if recent is None or recent.rate_hz <= 0.0:
                return Line("rate", WAIT, "Counting samples.")
            lost = recent.lost / max(recent.samples + recent.lost, 1)
            who = self._who(sensor)
            if recent.rate_hz < SLOW_HZ:
                told = (
                    f"{who}: {recent.rate_hz:.0f} samples a second: set the sensor to {SLOW_HZ:.0f} or more."
                )
                return Line("rate", BAD, told)
            if lost > LOST[0]:
                return Line("rate", BAD, f"{who}: {100 * lost:.1f} % lost: move the receiver closer.")
            if recent.drift_ppm is not None and abs(recent.drift_ppm) > DRIFT_PPM:
                return Line(
                    "rate", BAD, f"{who}: its clock is off by {recent.drift_ppm:.0f} ppm: check its rate."
                )
            rates.append(f"{recent.rate_hz:.0f} Hz, {100 * lost:.1f} % lost")
        return Line("rate", GOOD, " · ".join(rates))

    def _range(self) -> Line:
        for sensor, foot in self._feet.items():
            if foot.moving and foot.saturated >= 3 and foot.saturated > SATURATED * foot.moving:
                told = f"{self._who(sensor)}: the sensor is at the end of its range: choose a larger one."
                return Line("range", BAD, told)
        wanting = [self._who(sensor) for sensor, foot in self._feet.items() if foot.most_mps2 < MOVED_MPS2]
        if wanting:
            return Line("range", WAIT, f"Stamp, or kick forward: {' and '.join(wanting)}.")
        most = max(foot.most_mps2 for foot in self._feet.values())
        return Line("range", GOOD, f"up to {most / G_MPS2:.1f} g, none cut off")

    def _heading(self, views: Mapping[str, FootView], uses_field: bool) -> Line:
        still = all(foot.rest is not None for foot in self._feet.values())
        if not still or len(views) < len(self._feet) or not all(view.levelled for view in views.values()):
            return Line("heading", WAIT, "Stand still, toes the way you will walk.")
        if not uses_field:
            return Line("heading", GOOD, "no magnetometer in use: where the toes point now is straight ahead")
        for sensor, foot in self._feet.items():
            field = foot.rest.field if foot.rest is not None else None
            strength = math.hypot(*field) if field is not None else 0.0
            if field is None:
                told = f"{self._who(sensor)}: no magnetometer: switch it off in the settings."
                return Line("heading", BAD, told)
            if not WEAK_UT < strength < STRONG_UT and strength > 3.0:  # below: a relative unit
                told = f"{self._who(sensor)}: the field is {strength:.0f} µT: iron is near, stand elsewhere."
                return Line("heading", BAD, told)
        yaws = [yaw_of(view.q_nb) for view in self._starts.values()] or [
            yaw_of(v.q_nb) for v in views.values()
        ]
        apart = abs(math.remainder(yaws[0] - yaws[-1], math.tau))
        if apart > APART_RAD:
            told = f"the feet point {math.degrees(apart):.0f}° apart: iron in the floor?"
            return Line("heading", BAD, f"{told} Or calibrate the magnetometers.")
        return Line("heading", GOOD, f"{math.degrees(yaws[0]) % 360.0:.0f}° from magnetic north")

    def _loop(self, views: Mapping[str, FootView]) -> Line:
        ready = all(foot.rest is not None for foot in self._feet.values()) and len(views) == len(self._feet)
        if ready and not self._starts:
            self._starts = dict(views)
        walked = min(
            (views[s].distance_m - start.distance_m for s, start in self._starts.items()), default=0.0
        )
        if walked < 0.0:  # the walk began anew meanwhile
            self._starts, walked = dict(views), 0.0
        stands = all(
            foot.pose is not None and foot.pose.seconds >= END_STILL_S for foot in self._feet.values()
        )
        if walked < LOOP_M or not stands:
            told = (
                f"Walk a few steps out and back, and stop where you began ({max(walked, 0.0):.0f} m so far)."
            )
            return Line("loop", WAIT, told)
        aways = {s: _apart(views[s], start) for s, start in self._starts.items()}
        sensor, away = max(aways.items(), key=lambda item: item[1])
        share = f"{away:.2f} m from the start after {walked:.1f} m ({100 * away / walked:.1f} %)"
        if away > max(NEAR_M, NEAR * walked):
            return Line("loop", BAD, f"{self._who(sensor)}: {share}: tighten the strap, or calibrate.")
        return Line("loop", GOOD, share)


def _apart(one: FootView, other: FootView) -> float:
    return math.hypot(one.position_n[0] - other.position_n[0], one.position_n[1] - other.position_n[1])


def told(view: PreflightView) -> dict[str, object]:
    """The result for machines."""
    lines = [line._asdict() for line in view.lines]
    return {
        "done": view.done,
        "good": view.good,
        "seconds": view.seconds,
        "feet": dict(view.names),
        "lines": lines,
    }


def sentence(view: PreflightView) -> str:
    """The result in one line, for a recording's marker."""
    lines = ", ".join(f"{line.name} {line.state.value} ({line.told})" for line in view.lines)
    return f"pre-flight {'good' if view.good else 'with remarks'}: {lines}"
