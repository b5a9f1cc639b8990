"""Heart: the flat state of the papers' step: one record of float64, so that a copy is a checkpoint.

The classes only name the fields; a state is an element of a numpy record array of ``STATE`` (compiled
code reads its fields as attributes, without counting references). Vectors are spelled out: x, y, z.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.motion.samples import GAP_NS
from app.settings import Settings


class Nav:
    """Navigation: what the gains change. A sweep has one for each pair of gains."""

    q0: float  # q_nb
    q1: float
    q2: float
    q3: float
    px: float  # where the foot last stood, m in n
    py: float
    pz: float
    vx: float  # velocity integrated since the lift, not yet corrected, m/s
    vy: float
    vz: float
    sx: float  # travel: the integral of that velocity since the lift, m
    sy: float
    sz: float
    ax: float  # last motion acceleration in n, m/s²
    ay: float
    az: float
    end_vx: float  # velocity and travel at the first quiet sample, while the swing's end is not yet sure
    end_vy: float
    end_vz: float
    end_sx: float
    end_sy: float
    end_sz: float
    from_x: float  # where the foot stood before the last zero-velocity update
    from_y: float
    from_z: float
    heading: float  # yaw to start the next segment with, rad


class Parameters:
    """The settings as the compiled step reads them (units as in ``Settings``)."""

    gain_stance: float
    gain_swing: float
    threshold_radps: float
    stance_radps: float  # the same, or below any rate: then no stance and no zero-velocity update
    min_duration_s: float
    magnetometer: float  # 0 or 1
    gravity_mps2: float  # 0: as read at rest
    bias_from_rest: float  # 0 or 1
    still_window_s: float
    north_rad: float


class State(Nav, Parameters):
    """All of it: navigation, parameters, and what every choice of gains shares."""

    row: float  # number of the next row
    elapsed_ns: float  # of the last sample, since the first; whole
    levelled: float  # 0 while level is still being sought
    wx: float  # last angular rate, bias removed, rad/s
    wy: float
    wz: float
    fx: float  # last specific force, m/s²
    fy: float
    fz: float
    bias_x: float  # of the gyro, rad/s
    bias_y: float
    bias_z: float
    gravity: float  # m/s²
    phase: float
    contrary_s: float  # γ: for how long the rate has been on the other side of Ω_th
    statistic: float  # |ω|, rad/s
    swing_s: float  # time since the lift
    lift_row: float  # the last quiet sample before the swing
    lift_ns: float
    end_swing_s: float  # swing_s at the first quiet sample of a swing
    end_row: float
    rest_s: float  # the still window so far, and its sums
    rest_n: float
    rest_fx: float
    rest_fy: float
    rest_fz: float
    rest_norm: float
    rest_wx: float
    rest_wy: float
    rest_wz: float
    rest_wx2: float
    rest_wy2: float
    rest_wz2: float
    rest_mx: float
    rest_my: float
    rest_mz: float


Record = NDArray[Any]


def dtype_of(kind: type) -> np.dtype[Any]:
    """The record of a class's annotated fields, its bases' first, all float64."""
    names = [name for base in reversed(kind.__mro__) for name in vars(base).get("__annotations__", {})]
    return np.dtype([(name, np.float64) for name in names])


NAV = dtype_of(Nav)
STATE = dtype_of(State)

# --- what one sample brought about: a sum of these --------------------------------------------------
RESTING = 1  # level is still being sought
LEVEL_FOUND = 2
LIFT = 4  # the first contrary sample of a stance: a swing may have begun at the sample before
FLICKER = 8  # it had not
SWING_FOUND = 16
MOVING = 32  # velocity and travel are integrated
MAYBE_END = 64  # the first quiet sample of a swing: it may end here
STRIDE = 128  # it did: the zero-velocity update of the whole swing
SEGMENT = 256  # a gap in time: nothing is integrated across it
REPORTED = FLICKER | SWING_FOUND | STRIDE | SEGMENT  # change rows behind, or the person should know

GAP_S = GAP_NS * 1e-9
#: A rest at the start shorter than the still window still serves for level (not for bias) from here.
SHORTEST_REST_S = 0.1
#: The window is truly still where each axis' rate scatters and offsets less than this, rad/s.
STILL_STD = 0.012
STILL_MEAN = 0.018


def new_state(settings: Settings) -> Record:
    """The state before the first sample: a record array of one."""
    state = np.zeros(1, STATE)
    state["q0"] = 1.0
    state["heading"] = settings.start_heading_rad
    set_parameters(state, settings)
    return state


def set_parameters(state: Record, settings: Settings) -> None:
    """Write the settings into a state."""
    state["gain_stance"] = settings.gain_stance
    state["gain_swing"] = settings.gain_swing
    state["threshold_radps"] = settings.threshold_radps
    state["stance_radps"] = settings.threshold_radps if settings.zero_velocity else -1.0
    state["min_duration_s"] = settings.min_duration_s
    state["magnetometer"] = settings.magnetometer
    state["gravity_mps2"] = 0.0 if settings.gravity_from_rest else settings.gravity_mps2
    state["bias_from_rest"] = settings.bias_from_rest
    state["still_window_s"] = settings.still_window_s
    state["north_rad"] = settings.start_heading_rad


def turn_about_down(state: Record | np.void, vectors: Iterable[str], angle_rad: float) -> None:
    """Turn these vectors, the attitude and the heading clockwise, seen from above, about the start."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    for name in vectors:
        x, y = state[f"{name}x"].copy(), state[f"{name}y"].copy()
        state[f"{name}x"], state[f"{name}y"] = c * x - s * y, s * x + c * y
    c, s = math.cos(0.5 * angle_rad), math.sin(0.5 * angle_rad)
    w, x, y, z = (state[f"q{i}"].copy() for i in range(4))
    state["q0"], state["q1"] = c * w - s * z, c * x - s * y
    state["q2"], state["q3"] = c * y + s * x, c * z + s * w
    state["heading"] += angle_rad
