"""Edge, scene: what the panel says of a pendulum, as HTML: angles, their error, the period."""

from __future__ import annotations

import math
from collections.abc import Mapping

from app.motion.snapshot import FootView, PendulumView, Snapshot
from app.rotation import pitch_of
from app.scene import figures, words
from app.scene.figures import Compared, tile


def cards(snapshot: Snapshot, own: bool = False, warmth: Mapping[str, float] | None = None) -> str:
    """The figures of what is seen: a pendulum's, or a walk's (the rest as for ``figures.feet``)."""
    return card(snapshot.pendulum, snapshot) if snapshot.pendulum else figures.feet(snapshot, own, warmth)


def card(pendulum: PendulumView, snapshot: Snapshot) -> str:
    """Its figures, and which rod is which."""
    tiles = [
        ("Angle", _degrees(pendulum.angle_rad), "°"),
        ("True angle", _degrees(pendulum.true_rad), "°"),
        ("Error", _degrees(pendulum.angle_rad - pendulum.true_rad, 2), "°"),
        ("Largest, 10 s", _degrees(pendulum.worst_rad, 2), "°"),
        ("Period", words.number(pendulum.period_s), "s"),
        ("True period", words.number(pendulum.true_period_s), "s"),
        ("Rod", words.number(pendulum.rod_m), "m"),
        ("Time", words.clock(snapshot.t_s), ""),
    ]
    grid = "".join(tile(*one) for one in tiles)
    return (
        '<div class="ss-card"><div class="ss-card-head"><span class="ss-dot"></span>Pendulum</div>'
        f'<div class="ss-tiles">{grid}</div></div>{_legend(snapshot)}'
    )


def _legend(snapshot: Snapshot) -> str:
    rods = [("walk", "estimate"), ("truth", "truth")]
    rods += [("candidate", "candidate")] if snapshot.candidate else []
    keys = "".join(f'<span><i class="ss-{name}"></i>{label}</span>' for name, label in rods)
    return f'<div class="ss-legend">{keys}<span>angles from the vertical, + to the north</span></div>'


def compared(pendulum: PendulumView) -> Compared:
    """What a candidate is held against: the angle now, and how far it is off."""
    return (
        ("Angle", lambda foot: math.degrees(pitch_of(foot.q_nb)), 1, "°"),
        ("Off the truth", lambda foot: math.degrees(_off(foot, pendulum)), 2, "°"),
    )


def _off(foot: FootView, pendulum: PendulumView) -> float:
    return abs(pitch_of(foot.q_nb) - pendulum.true_rad)


def told(pendulum: PendulumView) -> str:
    """The same in a line."""
    return f"angle {_degrees(pendulum.angle_rad)}° · true {_degrees(pendulum.true_rad)}°"


def _degrees(angle_rad: float, digits: int = 1) -> str:
    return words.number(math.degrees(angle_rad), digits)
