"""Heart: the default decoder: ours, robust to pace and size, with a reason in words for everything."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.gestures import state as s
from app.gestures.pair import decide, step
from app.gestures.words import GENTLE_MPS, SILENCE_NS, Decision, FootReading
from app.motion.basics import MotionId, Role

_FOOT = ("left foot", "right foot", "both feet")
_OTHER = ("right", "left", "")
_WHY = {
    s.STILL: "{foot} still: march in place to walk",
    s.MISSING: "no sensor on the {foot}",
    s.SILENT: "the {foot}'s sensor is silent: is it plugged in?",
    s.RUBBISH: "the {foot}'s sensor sends readings that cannot be",
    s.TAPS: "the {foot} only raises its toe: lift the whole foot",
    s.TWISTS: "{foot} twist: step with one of them to walk a turn, keep one still to turn in place",
    s.MIXED: "the feet disagree: step or twist the same way as the foot before",
    s.LONE_BACK: "only the {foot} steps back, the {other} foot is still: step back with both",
    s.UNCLEAR: "the {foot} moves, not yet clear how",
    s.FIRST: "the {foot} has begun; the {other} foot will tell what it is to be",
}
_CLASS = {
    MotionId.FORWARD: "both feet march",
    MotionId.FORWARD_RIGHT: "the left foot steps, the right foot twists",
    MotionId.FORWARD_LEFT: "the right foot steps, the left foot twists",
    MotionId.SIDE_RIGHT: "the right foot steps, the left foot is still (march with both to walk forward)",
    MotionId.SIDE_LEFT: "the left foot steps, the right foot is still (march with both to walk forward)",
    MotionId.TURN_CW: "the right foot twists, the left foot is still",
    MotionId.TURN_CCW: "the left foot twists, the right foot is still",
    MotionId.BACKWARD: "both feet step toe first",
}


@dataclass(frozen=True)
class DefaultSettings:
    """Thresholds of the foot (rate at which it begins and ends, angle that counts) and scales of the way."""

    on_radps: float = 0.5
    off_radps: float = 0.25
    sure_rad: float = 0.07
    forward_m: float = 1.2
    back_m: float = 0.8
    side_m: float = 0.6
    turn_share: float = 1.5
    gentle_mps: float = GENTLE_MPS
    gentle_radps: float = 0.3
    silence_s: float = SILENCE_NS * 1e-9


class DefaultDecoder:
    """Two feet in, decisions out. ``now`` is the latest."""

    def __init__(self, settings: DefaultSettings | None = None) -> None:
        self.settings = values = settings or DefaultSettings()
        self._tuning = np.array([tuple(getattr(values, name) for name in s.TUNING.names or ())], s.TUNING)
        self._feet = np.zeros(2, s.FOOT)
        for name in ("on_s", "previous_on_s", "end_s", "fault_s"):
            self._feet[name] = -1e9
        self._pair = np.zeros(1, s.PAIR)
        self._pair["reason"] = 10 * s.MISSING
        self._start_ns: int | None = None
        self.now = self._decision(0)

    def take(self, reading: FootReading) -> Decision | None:
        """One sample in the order of time; a decision where it changed."""
        which = 0 if reading.foot is Role.LEFT else 1
        now_s = self._seconds(reading.t_ns)
        changed = step(
            self._feet,
            self._pair,
            self._tuning,
            which,
            now_s,
            reading.specific_force_b,
            reading.angular_rate_b,
        )
        return self._said(reading.t_ns) if changed else None

    def watch(self, now_ns: int) -> Decision | None:
        """No sample, but time has passed: both feet may be silent."""
        changed = decide(self._feet, self._pair[0], self._tuning[0], self._seconds(now_ns))
        return self._said(now_ns) if changed else None

    def unplug(self, foot: Role, now_ns: int) -> Decision | None:
        """The foot's sensor is gone; its next sample brings it back."""
        self._feet[0 if foot is Role.LEFT else 1]["seen"] = 0.0
        return self.watch(now_ns)

    def tune(self, settings: DefaultSettings) -> None:
        """Other thresholds from now on."""
        self.settings = settings
        for name in s.TUNING.names or ():
            self._tuning[name] = getattr(settings, name)

    def foot(self, which: int) -> s.Record:
        """The record of foot 0 (left) or 1 (right), to look at."""
        foot: s.Record = self._feet[which]
        return foot

    def _seconds(self, t_ns: int) -> float:
        if self._start_ns is None:
            self._start_ns = t_ns
        return (t_ns - self._start_ns) * 1e-9

    def _said(self, t_ns: int) -> Decision:
        self.now = self._decision(t_ns)
        return self.now

    def _decision(self, t_ns: int) -> Decision:
        pair = self._pair[0]
        motion, number = MotionId(int(pair["motion"])), int(pair["reason"])
        return Decision(
            t_ns,
            motion,
            float(pair["speed"]),
            float(pair["turn"]),
            float(pair["confidence"]),
            bool(pair["certain"]),
            float(pair["pace"]),
            words(motion, number // 10, number % 10),
        )


def words(motion: MotionId, why: int, which: int) -> str:
    """The reason as a sentence for the person whose feet they are."""
    sentence = _CLASS.get(motion, "") if why == s.CLASS else _WHY[why]
    return sentence.format(foot=_FOOT[which], other=_OTHER[which])
