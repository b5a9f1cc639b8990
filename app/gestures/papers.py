"""Heart: the papers' decoder: per foot three state machines, and one Overall (dissertation, Fig. 101).

The text prints no thresholds, and leaves cases open: docs/gestures.md says how each was decided.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from app.gestures.words import FEET, SILENCE_NS, Decision, FootReading, standing
from app.motion.basics import MotionId, Quaternion, Role
from app.rotation import yaw_of

_GAP_S = 1.0  # a foot back after so long starts anew


@dataclass(frozen=True)
class PapersSettings:
    """Times are the samples of a 30 Hz program cycle in seconds, so that any rate will do."""

    rate_threshold_radps: float = 1.0
    min_duration_s: float = 2 / 30
    motion_hold_s: float = 0.7
    yaw_threshold_rad: float = 0.2
    alpha: float = 0.9  # eq. 5.1, at 30 Hz
    speed_mps: float = 1.2
    turn_radps: float = 0.6

    @property
    def time_constant_s(self) -> float:
        """Of the high-pass: α = τ / (τ + dt)."""
        return self.alpha / (1.0 - self.alpha) / 30.0


@dataclass
class FootMachines:
    """Swing/Stance, Motion/~Motion and Yaw/~Yaw of one foot."""

    settings: PapersSettings
    t_ns: int | None = None
    swing: bool = False
    contrary_s: float = 0.0
    motion: bool = False
    stance_s: float = 0.0
    yaw: bool = False
    below_s: float = 0.0
    heading_rad: float = 0.0  # as read, within ±π
    filtered_rad: float = 0.0  # eq. 5.1

    def take(self, t_ns: int, rate_radps: float, q_nb: Quaternion) -> None:
        """One sample."""
        dt_s = 0.0 if self.t_ns is None else (t_ns - self.t_ns) * 1e-9
        heading = yaw_of(q_nb)
        if self.t_ns is None or dt_s > _GAP_S:
            self.reset()
            self.heading_rad, dt_s = heading, 0.0
        self.t_ns = t_ns
        self._swing_or_stance(rate_radps, dt_s)
        self._motion_or_not(dt_s)
        self._yaw_or_not(heading, dt_s)

    def reset(self) -> None:
        """The foot stands."""
        self.swing = self.motion = self.yaw = False
        self.contrary_s = self.stance_s = self.below_s = self.filtered_rad = 0.0

    def _swing_or_stance(self, rate_radps: float, dt_s: float) -> None:
        if (rate_radps > self.settings.rate_threshold_radps) == self.swing:
            self.contrary_s = 0.0
            return
        self.contrary_s += dt_s
        if self.contrary_s >= self.settings.min_duration_s - 0.5 * dt_s:
            self.swing, self.contrary_s = not self.swing, 0.0

    def _motion_or_not(self, dt_s: float) -> None:
        """Motion at once with a swing; ~Motion when the stance has persisted."""
        self.stance_s = 0.0 if self.swing else self.stance_s + dt_s
        self.motion = self.swing or (self.motion and self.stance_s < self.settings.motion_hold_s)

    def _yaw_or_not(self, heading_rad: float, dt_s: float) -> None:
        """The change of yaw is taken the short way round, which unwraps it, then eq. 5.1."""
        change = math.remainder(heading_rad - self.heading_rad, math.tau)
        self.heading_rad = heading_rad
        tau_s = self.settings.time_constant_s
        self.filtered_rad = tau_s / (tau_s + dt_s) * (self.filtered_rad + change)
        beyond = abs(self.filtered_rad) > self.settings.yaw_threshold_rad
        self.below_s = 0.0 if beyond else self.below_s + dt_s
        self.yaw = self.motion and (beyond or (self.yaw and self.below_s < self.settings.motion_hold_s))


#: (left motion, right motion, left yaw, right yaw) → Table 14. What is not here has no row there.
_OVERALL = {
    (True, True, False, False): MotionId.FORWARD,
    (True, True, False, True): MotionId.FORWARD_RIGHT,
    (True, True, True, False): MotionId.FORWARD_LEFT,
    (False, True, False, False): MotionId.SIDE_RIGHT,
    (True, False, False, False): MotionId.SIDE_LEFT,
    (False, True, False, True): MotionId.TURN_CW,
    (True, False, True, False): MotionId.TURN_CCW,
}
_TURNS = {
    MotionId.FORWARD_RIGHT: 1.0,
    MotionId.TURN_CW: 1.0,
    MotionId.FORWARD_LEFT: -1.0,
    MotionId.TURN_CCW: -1.0,
}


def overall(left: FootMachines, right: FootMachines) -> MotionId:
    """The Overall machine: what the other machines' states mean together."""
    return _OVERALL.get((left.motion, right.motion, left.yaw, right.yaw), MotionId.NONE)


@dataclass
class PapersDecoder:
    """The papers' decoder. It has no confidence and no doubt: both are 1 and certain."""

    settings: PapersSettings = PapersSettings()
    feet: dict[Role, FootMachines] = field(init=False)
    motion: MotionId = MotionId.NONE

    def __post_init__(self) -> None:
        self.feet = {foot: FootMachines(self.settings) for foot in FEET}

    def take(self, reading: FootReading) -> Decision | None:
        """One sample in the order of time; a decision where it changed."""
        rate = math.hypot(*reading.angular_rate_b)
        if not math.isfinite(rate + math.fsum(reading.q_nb)):
            return self.unplug(reading.foot, reading.t_ns)
        self.feet[reading.foot].take(reading.t_ns, rate, reading.q_nb)
        return self.watch(reading.t_ns)

    def watch(self, now_ns: int) -> Decision | None:
        """Time has passed. The papers say nothing of a silent sensor; ours ends its foot's motion."""
        for machines in self.feet.values():
            if machines.t_ns is not None and now_ns - machines.t_ns > SILENCE_NS:
                machines.reset()
        return self._decide(now_ns)

    def unplug(self, foot: Role, now_ns: int) -> Decision | None:
        """The foot's sensor is gone; its next sample brings it back."""
        self.feet[foot] = FootMachines(self.settings)
        return self._decide(now_ns)

    def _decide(self, now_ns: int) -> Decision | None:
        left, right = (self.feet[foot] for foot in FEET)
        motion = overall(left, right)
        if motion == self.motion:
            return None
        self.motion = motion
        reason = f"left foot {_words(left)}, right foot {_words(right)}"
        if motion == MotionId.NONE:
            return standing(now_ns, reason)
        in_place = motion in (MotionId.TURN_CW, MotionId.TURN_CCW)
        speed = 0.0 if in_place else self.settings.speed_mps
        turn = _TURNS.get(motion, 0.0) * self.settings.turn_radps
        return Decision(now_ns, motion, speed, turn, 1.0, True, 0.0, reason)


def _words(machines: FootMachines) -> str:
    return "yaws" if machines.yaw else "in motion" if machines.motion else "not in motion"
