"""Heart: the motion of one simulated foot at any instant: footprints joined by a gait, in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from app.motion.basics import Floats, Ints
from app.simulate.gait import FLAT_SHARE, Gait, Profile


class Motion(NamedTuple):
    """A foot at n instants. Position is from its own start."""

    position_n: Floats  # [n, 3] m
    velocity_n: Floats  # [n, 3] m/s
    acceleration_n: Floats  # [n, 3] m/s²
    q_nb: Floats  # [n, 4]
    angular_rate_b: Floats  # [n, 3] rad/s


class Timing(NamedTuple):
    """Stride ``k`` heels off at ``heel_off_s`` + k ``cycle_s``."""

    heel_off_s: float
    cycle_s: float


class Swing(NamedTuple):
    """How a foot gets from footprint to footprint: ``reach`` is the share of the stride it covers."""

    gait: Gait
    lift_m: float
    reach: float


@dataclass(frozen=True)
class FootMotion:
    """Footprints and the strides between them.

    The foot moves from each footprint to the next along a straight line, arched by the lift, and
    turns in the air by the difference of their headings.
    """

    position_n: Floats  # [strides + 1, 3] m, of the footprints, the first at 0
    stride_n: Floats  # [strides, 3] m, nominal: the papers' gait does not quite reach the next footprint
    heading_rad: Floats  # [strides + 1], unwrapped
    timing: Timing
    swing: Swing

    @property
    def strides(self) -> int:
        """How many strides the foot makes."""
        return len(self.heading_rad) - 1

    def at(self, t_s: Floats) -> Motion:
        """Position, velocity, acceleration, orientation and angular rate at these seconds [n]."""
        k, profile = self._profile(t_s)
        stride = self.stride_n[k]
        turn = np.diff(self.heading_rad)[k]
        return Motion(
            self.position_n[k] + _along(stride, profile.advance, profile.lift_m),
            _along(stride, profile.advance_rate, profile.lift_mps),
            _along(stride, profile.advance_acceleration, profile.lift_mps2),
            _orientation(self.heading_rad[k] + turn * profile.turn, profile.pitch_rad),
            _body_rate(turn * profile.turn_rate, profile.pitch_rad, profile.pitch_radps),
        )

    def _profile(self, t_s: Floats) -> tuple[Ints, Profile]:
        """Which stride, and where in it. Strides meet in mid-stance, when all is at rest."""
        heel_off, cycle = self.timing
        since = np.asarray(t_s, dtype=np.float64) - heel_off
        k = np.floor(since / cycle + 0.5 * FLAT_SHARE).astype(np.int64)
        k = np.clip(k, 0, self.strides - 1)
        return k, self.swing.gait(since - k * cycle, cycle, self.swing.lift_m)


def join_footprints(footprints_n: Floats, heading_rad: Floats, timing: Timing, swing: Swing) -> FootMotion:
    """The motion over footprints [n + 1, 3] with headings [n + 1]; only their differences matter."""
    stride = np.diff(footprints_n, axis=0)
    position = np.vstack((np.zeros((1, 3)), swing.reach * np.cumsum(stride, axis=0)))
    return FootMotion(position, stride, heading_rad, timing, swing)


def rotate_to_body(q_nb: Floats, vector_n: Floats) -> Floats:
    """R(q)ᵀ v: navigation vectors [n, 3] (or one [3]) as each orientation [n, 4] has them in the body."""
    w, axis = q_nb[:, :1], -q_nb[:, 1:]
    twice = 2.0 * np.cross(axis, vector_n)
    rotated: Floats = vector_n + w * twice + np.cross(axis, twice)
    return rotated


def _along(stride: Floats, share: Floats, up: Floats) -> Floats:
    moved: Floats = stride * share[:, np.newaxis]
    moved[:, 2] -= up
    return moved


def _orientation(yaw: Floats, pitch: Floats) -> Floats:
    """Yaw about down, then pitch about the new y."""
    cy, sy, cp, sp = np.cos(0.5 * yaw), np.sin(0.5 * yaw), np.cos(0.5 * pitch), np.sin(0.5 * pitch)
    return np.column_stack([cy * cp, -sy * sp, cy * sp, sy * cp])


def _body_rate(yaw_radps: Floats, pitch: Floats, pitch_radps: Floats) -> Floats:
    """Euler rates as the gyro has them: the turn about down is seen through the pitch."""
    return np.column_stack([-yaw_radps * np.sin(pitch), pitch_radps, yaw_radps * np.cos(pitch)])
