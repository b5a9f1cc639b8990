"""Heart: what a gesture decoder is given and what it says."""

from __future__ import annotations

from typing import NamedTuple, Protocol

from app.motion.basics import MotionId, Quaternion, Role, Vector

#: A foot that says nothing for longer is dead: the camera comes to rest.
SILENCE_NS = 150_000_000
#: Before the class is certain the camera moves gently, m/s.
GENTLE_MPS = 0.3
#: In this order wherever feet are numbered.
FEET = (Role.LEFT, Role.RIGHT)
UNKNOWN_Q: Quaternion = (1.0, 0.0, 0.0, 0.0)


class FootReading(NamedTuple):
    """One sample of one foot. ``t_ns`` is on a clock that both feet share."""

    foot: Role  # LEFT or RIGHT
    t_ns: int
    specific_force_b: Vector  # m/s²
    angular_rate_b: Vector  # rad/s
    q_nb: Quaternion = UNKNOWN_Q  # only the papers' decoder looks at it


class Decision(NamedTuple):
    """What the feet ask for from ``t_ns`` on. Speeds are 0 or more; the motion says which way."""

    t_ns: int
    motion: MotionId
    speed_mps: float
    turn_radps: float  # positive clockwise from above
    confidence: float  # 0 to 1
    certain: bool  # False: the class may still change, the camera moves gently
    cadence_hz: float  # whole cycles a second; 0 unknown
    reason: str


class Decoder(Protocol):
    """Two feet in, decisions out."""

    def take(self, reading: FootReading) -> Decision | None:
        """One sample in the order of time; a decision where it changed."""

    def watch(self, now_ns: int) -> Decision | None:
        """No sample, but time has passed: both feet may be silent."""

    def unplug(self, foot: Role, now_ns: int) -> Decision | None:
        """The foot's sensor is gone; its next sample brings it back."""


def standing(t_ns: int, reason: str, confidence: float = 1.0) -> Decision:
    """Nothing is asked for."""
    return Decision(t_ns, MotionId.NONE, 0.0, 0.0, confidence, True, 0.0, reason)
