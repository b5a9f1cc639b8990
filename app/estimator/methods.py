"""Heart: the estimators side by side: what a tracker asks of the one its settings name."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from app.estimator import corrections, kalman_run, kalman_state, papers_run, resume, state
from app.estimator.gait import SWING
from app.estimator.north import compass_of
from app.estimator.running import Correct, Run
from app.estimator.standing import PRIOR_RADPS
from app.estimator.state import Record
from app.estimator.trust import trust_of, unknown_m2
from app.motion.estimate import Compass, Trust
from app.motion.samples import GyroBias
from app.rotation import yaw_of
from app.settings import Settings

#: What a gyro's bias may be, by how sure its rests are, is at least and at most this, rad/s.
BIAS_RADPS = (5e-4, PRIOR_RADPS)


def _unknown(_: Record, __: float) -> Trust | None:
    return None


class Method(NamedTuple):
    """One estimator. States differ, rows and events are the same."""

    begin: Callable[[Settings, GyroBias | None], Record]  # before the first sample; a bias from before
    resume: Callable[[Record, Settings], None]  # from a checkpoint, under other settings
    run: Run
    correct: Correct
    moves: Callable[[Record], bool]  # whether rows since the lift may still change
    trust: Callable[[Record, float], Trust | None]  # how sure it is, after so many metres
    doubts: Callable[[Record], tuple[float, float, float]]  # as in ``strides.Step``
    compass: Callable[[Record], Compass | None] | None  # what the method itself holds of the magnetic field
    events: int  # that a run may report before it pauses for them to be applied


def _papers_begin(settings: Settings, _: GyroBias | None) -> Record:
    return state.new_state(settings)


def _papers_moves(record: Record) -> bool:
    return bool(record["phase"][0] == SWING or record["contrary_s"][0] > 0.0)


def _papers_doubts(_: Record) -> tuple[float, float, float]:
    return 0.0, BIAS_RADPS[1], 0.0


def _kalman_doubts(record: Record) -> tuple[float, float, float]:
    state = record[0]
    info = np.maximum(state["bias_info"], 1e-9)
    known_radps = min(max(float(np.min(info)) ** -0.5, BIAS_RADPS[0]), BIAS_RADPS[1])
    return unknown_m2(record), known_radps, _moved_radps(state)


def _moved_radps(state: np.void) -> float:
    """How far a gyro's bias has moved since the rests: zero velocities tell two of its axes."""
    moved = state["gyro_bias"] - state["bias_sum"] / np.maximum(state["bias_info"], 1e-9)
    return math.sqrt(0.5 * float(moved @ moved))


def _kalman_moves(record: Record) -> bool:
    return bool(record["moving"][0])


METHODS: dict[str, Method] = {
    "papers": Method(
        _papers_begin,
        resume.resume,
        papers_run.run,
        corrections.correct,
        _papers_moves,
        _unknown,
        _papers_doubts,
        None,
        events=64,
    ),
    "kalman": Method(  # its corrections read the state as the event left it: one event a run
        kalman_state.new_state,
        kalman_state.resume,
        kalman_run.run,
        kalman_run.correct,
        _kalman_moves,
        trust_of,
        _kalman_doubts,
        compass_of,
        events=1,
    ),
}


def go_on(method: Method, record: Record, settings: Settings) -> Record:
    """A state of ``method`` to go on with from ``record``, a checkpoint of the same or another one.

    Another method's walk is taken up as after a gap: from where the foot was, level sought anew.
    """
    own = method.begin(settings, None)
    if record.dtype == own.dtype:
        own = record.copy()
        method.resume(own, settings)
        return own
    turn_rad = settings.start_heading_rad - float(record["north_rad"][0])
    c, s = math.cos(turn_rad), math.sin(turn_rad)
    x, y, z = _position(record)
    own["px"], own["py"], own["pz"] = c * x - s * y, s * x + c * y, z
    own["row"], own["elapsed_ns"], own["lift_row"] = record["row"], record["elapsed_ns"], record["row"] - 1.0
    q0, q1, q2, q3 = (float(record[f"q{i}"][0]) for i in range(4))
    own["heading"] = turn_rad + yaw_of((q0, q1, q2, q3))
    return own


def _position(record: Record) -> tuple[float, float, float]:
    """Where the foot is: the papers' state has the travel of the swing under way apart."""
    travel = "s" if "sx" in (record.dtype.names or ()) else None
    x, y, z = (float(record[f"p{a}"][0]) + (float(record[f"s{a}"][0]) if travel else 0.0) for a in "xyz")
    return x, y, z
