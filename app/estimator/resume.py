"""Heart: going on from a checkpoint under other settings, when the samples before it are gone."""

from __future__ import annotations

from app.estimator.state import Record, set_parameters, turn_about_down
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
        turn_about_down(state, _VECTORS, angle_rad)
    if state["levelled"][0]:
        from_rest = state["rest_norm"] / state["rest_n"]
        state["gravity"] = from_rest if settings.gravity_from_rest else settings.gravity_mps2
    if not settings.bias_from_rest:
        for axis in "xyz":
            state[f"w{axis}"] += state[f"bias_{axis}"]
            state[f"bias_{axis}"] = 0.0
