"""Heart: going on from a checkpoint under other settings, when the samples before it are gone."""

from __future__ import annotations

import math

from app.estimator.state import Record, set_parameters
from app.settings import Settings

_VECTORS = ("p", "v", "s", "a", "end_v", "end_s", "from_")


def resume(state: Record, settings: Settings) -> None:
    """Give a state other settings, and what would follow from them had they held from the start.

    The start heading turns the walk so far, gravity and gyro bias are those of the last rest. What the
    gains and the thresholds would have changed stays as it was.
    """
    angle_rad = settings.start_heading_rad - float(state["north_rad"][0])
    set_parameters(state, settings)
    if angle_rad:
        turn_about_down(state, angle_rad)
    if state["levelled"][0]:
        from_rest = state["rest_norm"] / state["rest_n"]
        state["gravity"] = from_rest if settings.gravity_from_rest else settings.gravity_mps2
    if not settings.bias_from_rest:
        for axis in "xyz":
            state[f"w{axis}"] += state[f"bias_{axis}"]
            state[f"bias_{axis}"] = 0.0


def turn_about_down(state: Record, angle_rad: float) -> None:
    """Turn all that lies in *n* clockwise, seen from above, about the start."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    for name in _VECTORS:
        x, y = state[f"{name}x"].copy(), state[f"{name}y"].copy()
        state[f"{name}x"], state[f"{name}y"] = c * x - s * y, s * x + c * y
    c, s = math.cos(0.5 * angle_rad), math.sin(0.5 * angle_rad)
    w, x, y, z = (state[f"q{i}"].copy() for i in range(4))
    state["q0"], state["q1"], state["q2"], state["q3"] = (
        c * w - s * z,
        c * x - s * y,
        c * y + s * x,
        c * z + s * w,
    )
    state["heading"] += angle_rad
