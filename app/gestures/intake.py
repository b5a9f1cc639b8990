"""Heart: samples of live sensors into readings of two feet: which foot, on which clock, and what is amiss.

Both feet come onto the host's clock, each by its own line, so different rates and clocks do no harm.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from app.clocks import LiveClock
from app.gestures.words import FEET, SILENCE_NS, FootReading
from app.motion.basics import Role
from app.motion.samples import Sample

_OTHER = {Role.LEFT: Role.RIGHT, Role.RIGHT: Role.LEFT}
NAMES = {Role.LEFT: "left foot", Role.RIGHT: "right foot"}
_RATE_SAMPLES = 50


@dataclass
class Sensor:
    """What is known of one foot's sensor."""

    name: str = ""
    clock: LiveClock | None = None
    newest_ns: int | None = None  # on the host's clock, by the line
    heard_ns: int | None = None  # when it came
    stamps: deque[int] = field(default_factory=lambda: deque(maxlen=_RATE_SAMPLES))
    late: int = 0  # samples that were older than the one before

    @property
    def rate_hz(self) -> float:
        """Of the last samples; 0 unknown."""
        span = self.stamps[-1] - self.stamps[0] if len(self.stamps) > 1 else 0
        return (len(self.stamps) - 1) * 1e9 / span if span > 0 else 0.0


class Intake:
    """Takes samples in the order they come. Arrivals tell the clocks, a replay's too: it keeps their pace."""

    def __init__(self, role_of: Callable[[str], Role]) -> None:
        self._role_of = role_of
        self.swapped = False
        self.feet = {role: Sensor() for role in FEET}
        self.strangers: dict[str, Role] = {}  # sensors nobody gave a side, and the side they got
        self.sided = False  # a set-up has told which foot is which

    def take(self, sample: Sample) -> FootReading | None:
        """The reading of a foot, or None for a sensor on no foot and for a sample out of order."""
        role = self._side(sample.sensor)
        if role is None:
            return None
        foot = self.feet[role]
        if foot.name != sample.sensor or foot.clock is None:
            foot.name, foot.clock = sample.sensor, LiveClock()
        foot.clock.add(sample.device_ns, sample.host_ns)
        t_ns = foot.clock.line.host(sample.device_ns)
        foot.heard_ns = sample.host_ns
        if foot.newest_ns is not None and t_ns <= foot.newest_ns and foot.newest_ns - t_ns < 1_000_000_000:
            foot.late += 1
            t_ns = foot.newest_ns + 1
        if foot.newest_ns is not None and t_ns - foot.newest_ns > SILENCE_NS:
            foot.stamps.clear()  # a cable that was out makes no slow sensor
        foot.newest_ns = t_ns
        foot.stamps.append(t_ns)
        side = _OTHER[role] if self.swapped else role
        return FootReading(side, t_ns, sample.specific_force_b, sample.angular_rate_b)

    def begin_anew(self) -> None:
        """The source starts again: clocks and rates are learnt anew."""
        self.feet = {role: Sensor() for role in FEET}

    def sensor(self, side: Role) -> Sensor:
        """The sensor whose foot is called so, swapped or not."""
        return self.feet[_OTHER[side] if self.swapped else side]

    def now_ns(self, host_ns: int) -> int:
        """The readings' time at this host time: the newest sample's, and what has passed since it came."""
        heard = [f for f in self.feet.values() if f.heard_ns is not None]
        if not heard:
            return host_ns
        last = max(heard, key=lambda f: f.heard_ns or 0)
        return (last.newest_ns or 0) + max(0, host_ns - (last.heard_ns or 0))

    def fault(self, host_ns: int) -> str:
        """What keeps the feet from being understood, in words; empty where nothing does."""
        seen = {side: self.sensor(side) for side in FEET}
        missing = [side for side in FEET if seen[side].heard_ns is None]
        if len(missing) == 2:
            return "no sensor is heard yet: switch both on"
        if missing:
            return f"no sensor on the {NAMES[missing[0]]}: gestures take two feet"
        silent = [side for side in FEET if host_ns - (seen[side].heard_ns or 0) > SILENCE_NS]
        if len(silent) == 2:
            return "both sensors are silent"
        if silent:
            return f"the {NAMES[silent[0]]}'s sensor is silent: is it plugged in and charged?"
        return ""

    def note(self) -> str:
        """What is odd but does no harm, in words."""
        left, right = (self.sensor(side).rate_hz for side in FEET)
        if left > 0.0 and right > 0.0 and not 0.8 < left / right < 1.25:
            return f"the feet have different rates: left {left:.0f} Hz, right {right:.0f} Hz"
        if self.strangers and not self.sided:
            told = ", ".join(f"{name} as the {NAMES[side]}" for name, side in self.strangers.items())
            return f"no side was given: {told}; the set-up checks it"
        return ""

    def _side(self, sensor: str) -> Role | None:
        role = self._role_of(sensor)
        if role in FEET:
            return role
        if role is Role.OTHER:
            return None
        if sensor not in self.strangers:
            free = [
                side for side in FEET if self.feet[side].name == "" and side not in self.strangers.values()
            ]
            if not free:
                return None
            self.strangers[sensor] = free[0]
        return self.strangers[sensor]
