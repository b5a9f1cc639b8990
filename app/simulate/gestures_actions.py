"""Heart: what one foot does once, as steps of six channels: march, step back, twist, tap, shift.

Sizes and moments are drawn anew for every action. ``amplitude`` scales angles and heights alike.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from app.simulate.gestures_steps import Step

#: Position (forward, right, up; m) and orientation (yaw, pitch, roll; rad, NED: toe up is positive pitch).
CHANNELS = ("forward", "right", "up", "yaw", "pitch", "roll")

Action = dict[str, list[Step]]
Draw = Callable[[float, float], float]
"""Uniform between two numbers; in the middle where nothing may vary."""

#: Nominal sizes at amplitude 1.
PITCH_RAD, LIFT_M, TWIST_RAD = 0.6, 0.12, 0.55


def _placed(start_s: float, duration_s: float, table: list[tuple[float, float, float]]) -> list[Step]:
    """Steps given as (begin, end, size), begin and end as shares of the action."""
    return [Step(start_s + a * duration_s, (b - a) * duration_s, size) for a, b, size in table]


def _ring(at_s: float, size: float, half_wave_s: float) -> list[Step]:
    """A decaying wobble that begins and ends at 0: what a shoe does as it meets the floor."""
    sizes = (size, -1.7 * size, 1.1 * size, -0.4 * size)
    return [Step(at_s + i * half_wave_s, half_wave_s, part) for i, part in enumerate(sizes)]


def _contact(
    action: Action, at_s: float, left_s: float, amplitude: float, draw: Draw, transient: float
) -> None:
    """The transient of the sole meeting the floor, over before the action is."""
    half_wave = min(draw(0.014, 0.022), left_s / 4.0)
    hard = transient * min(1.0, 0.4 + 0.6 * amplitude)
    action["up"] += _ring(at_s, hard * draw(0.1e-3, 0.4e-3), half_wave)
    action["pitch"] += _ring(at_s, hard * draw(-0.012, 0.012), half_wave)


def _there_and_back(start_s: float, duration_s: float, size: float, draw: Draw) -> list[Step]:
    half = draw(0.45, 0.55)
    return _placed(start_s, duration_s, [(draw(0.06, 0.12), half, size), (half, 0.86, -size)])


def march(
    start_s: float, duration_s: float, amplitude: float, aside_m: float, draw: Draw, transient: float
) -> Action:
    """Heel off first, knee up, down again, flat or heel first. ``aside_m``: out to the right and back."""
    pitch, lift = amplitude * PITCH_RAD * draw(0.8, 1.2), amplitude * LIFT_M * draw(0.8, 1.2)
    landing = pitch * draw(-0.1, 0.35)
    action: Action = {
        "forward": _there_and_back(start_s, duration_s, amplitude * draw(0.0, 0.1), draw),
        "right": _there_and_back(start_s, duration_s, aside_m + amplitude * draw(-0.02, 0.02), draw),
        "up": _placed(
            start_s, duration_s, [(draw(0.0, 0.06), draw(0.4, 0.5), lift), (draw(0.5, 0.55), 0.86, -lift)]
        ),
        "yaw": _there_and_back(start_s, duration_s, pitch * draw(-0.2, 0.2), draw),
        "pitch": _placed(
            start_s,
            duration_s,
            [
                (0.0, draw(0.26, 0.34), -pitch),
                (draw(0.34, 0.42), 0.8, pitch + landing),
                (0.8, 0.95, -landing),
            ],
        ),
        "roll": _there_and_back(start_s, duration_s, pitch * draw(-0.2, 0.2), draw),
    }
    _contact(action, start_s + 0.86 * duration_s, 0.14 * duration_s, amplitude, draw, transient)
    return action


def step_back(start_s: float, duration_s: float, amplitude: float, draw: Draw, transient: float) -> Action:
    """As a step backwards: toe off first, toe down first."""
    pitch, lift = amplitude * PITCH_RAD * draw(0.8, 1.2), amplitude * LIFT_M * draw(0.7, 1.0)
    up, down = pitch * draw(0.4, 0.6), pitch * draw(0.4, 0.6)
    action: Action = {
        "forward": _there_and_back(start_s, duration_s, -amplitude * draw(0.02, 0.12), draw),
        "right": _there_and_back(start_s, duration_s, amplitude * draw(-0.02, 0.02), draw),
        "up": _placed(
            start_s, duration_s, [(draw(0.02, 0.08), draw(0.4, 0.5), lift), (draw(0.5, 0.55), 0.86, -lift)]
        ),
        "yaw": _there_and_back(start_s, duration_s, pitch * draw(-0.15, 0.15), draw),
        "pitch": _placed(
            start_s,
            duration_s,
            [(0.0, draw(0.2, 0.3), up), (draw(0.32, 0.4), 0.74, -up - down), (0.76, 0.96, down)],
        ),
        "roll": _there_and_back(start_s, duration_s, pitch * draw(-0.15, 0.15), draw),
    }
    _contact(action, start_s + 0.84 * duration_s, 0.16 * duration_s, amplitude, draw, transient)
    return action


def twist(
    start_s: float, duration_s: float, amplitude: float, out: float, draw: Draw, transient: float
) -> Action:
    """The toe swings out about the heel and back, a little too far. ``out``: +1 right foot, −1 left."""
    yaw = out * amplitude * TWIST_RAD * draw(0.8, 1.2)
    over = yaw * transient * draw(0.0, 0.1)
    size = abs(yaw)
    action: Action = {
        "forward": _there_and_back(start_s, duration_s, -0.08 * size * size, draw),
        "right": _there_and_back(start_s, duration_s, 0.12 * yaw, draw),
        "up": _there_and_back(start_s, duration_s, 0.1 * size * draw(0.05, 0.25), draw),
        "yaw": _placed(
            start_s,
            duration_s,
            [(0.0, draw(0.38, 0.46), yaw), (draw(0.46, 0.52), 0.86, -yaw - over), (0.86, 1.0, over)],
        ),
        "pitch": _there_and_back(start_s, duration_s, size * draw(0.0, 0.25), draw),
        "roll": _there_and_back(start_s, duration_s, yaw * draw(-0.25, 0.1), draw),
    }
    _contact(action, start_s + 0.84 * duration_s, 0.16 * duration_s, 0.3 * amplitude, draw, transient)
    return action


def tap(start_s: float, duration_s: float, draw: Draw, transient: float) -> Action:
    """The toe goes up and down, the heel stays on the floor."""
    up = draw(0.06, 0.2)
    action: Action = {channel: [] for channel in CHANNELS}
    action["pitch"] += _placed(
        start_s, duration_s, [(0.0, draw(0.35, 0.45), up), (draw(0.45, 0.5), 0.84, -up)]
    )
    action["up"] += _there_and_back(start_s, duration_s, 0.11 * up, draw)
    _contact(action, start_s + 0.84 * duration_s, 0.16 * duration_s, 0.2, draw, transient)
    return action


def shift(start_s: float, duration_s: float, draw: Draw) -> Action:
    """The body leans over: the foot rocks, pivots and slides a little, the heel may rise."""
    heel = draw(-0.06, 0.02)
    action: Action = {
        "forward": _there_and_back(start_s, duration_s, draw(-0.004, 0.004), draw),
        "right": _there_and_back(start_s, duration_s, draw(-0.006, 0.006), draw),
        "up": _there_and_back(start_s, duration_s, 0.1 * abs(heel), draw),
        "yaw": _there_and_back(start_s, duration_s, draw(-0.06, 0.06), draw),
        "pitch": _there_and_back(start_s, duration_s, heel, draw),
        "roll": _there_and_back(start_s, duration_s, draw(-0.05, 0.05), draw),
    }
    return action


def give(start_s: float, duration_s: float, size: float, draw: Draw) -> Action:
    """What the standing foot does while the other is in the air: it takes the weight and gives a little."""
    return {
        "yaw": _there_and_back(start_s, duration_s, size * draw(-0.035, 0.035), draw),
        "pitch": _there_and_back(start_s, duration_s, size * draw(-0.035, 0.01), draw),
        "roll": _there_and_back(start_s, duration_s, size * draw(-0.03, 0.03), draw),
    }


def add_up(actions: list[Action]) -> dict[str, list[Step]]:
    """All actions of one foot, channel by channel."""
    return {channel: [step for action in actions for step in action.get(channel, [])] for channel in CHANNELS}


def drawer(rng: np.random.Generator, vary: float) -> Draw:
    """Uniform draws, narrowed to their middle by ``vary`` below 1."""

    def draw(low: float, high: float) -> float:
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        return middle + vary * half * float(rng.uniform(-1.0, 1.0))

    return draw
