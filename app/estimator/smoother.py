"""Heart: the Kalman filter in hindsight: every row by all samples, those after it too.

The adjoint form of the Rauch–Tung–Striebel smoother (G. J. Bierman, "Fixed interval smoothing with
discrete measurements", Int. J. Control 18, 1973): one vector λ of 17 runs backward, x̂ = x − P λ, and no
matrix is inverted. The filter is run twice more: once through, now that the gait on both sides of each
sample is known, then block by block from the last to the first, so that memory does not grow with the walk.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import minimum_filter1d

from app.blocks import BLOCK, Blocks
from app.compiled import kernel, part
from app.estimator import events as e
from app.estimator import state as s
from app.estimator.detectors import ENERGY_BINS, LEAST_BINS
from app.estimator.kalman import step
from app.estimator.kalman_run import AS_RATE, turn_row, write_event, write_row
from app.estimator.kalman_state import (
    BIN_NS,
    FLOOR_AT,
    FLOOR_MEASURE,
    HEIGHT_AT,
    MEASURES,
    NORTH_AT,
    NORTH_MEASURE,
    PARTS,
    VELOCITY_AT,
    YAW_AT,
    KalmanState,
)
from app.estimator.papers import reading_at
from app.estimator.state import Record
from app.estimator.tracker import Tracker
from app.motion.basics import Floats
from app.motion.estimate import RowColumn
from app.motion.samples import Column
from app.rotation import conjugate, exponential, rotate

#: Columns of a trace: what happened; Δt; q at the half step; force in n; whether a floor
#: and a north began; for each measurement its total variance (0: none), how far away it was, what it saw.
_DT, _HALF, _PUSH, _FLOOR, _NORTH, _MEASURED, _EACH = 1, 2, 6, 9, 10, 11, 2 + PARTS
TRACE_WIDTH = _MEASURED + MEASURES * _EACH
#: The gait around a sample: as long as the causal detector looks back, half of it to either side.
ENERGY_S, LEAST_S = ENERGY_BINS * BIN_NS / 1e9, LEAST_BINS * BIN_NS / 1e9


@kernel
def forward(
    state: Record,
    samples: Floats,
    gait: Floats,
    rows: Floats,
    trace: Floats,
    covariances: Floats,
    events: Floats,
) -> int:
    """Run the filter over a block [k, 10]; rows as it made them, before any correction of a swing.

    ``gait`` [k, 2] is the energy and the least statistic around each sample; ``trace`` [k, TRACE_WIDTH]
    and ``covariances`` [k, 17, 17] are what ``backward`` reads. Returns the count of strides, told in
    ``events``.
    """
    now = state[0]
    count = 0
    for i in range(samples.shape[0]):
        reading = reading_at(samples, i)
        now.learnt = 0.0
        now.told, now.told_energy, now.told_least = 1.0, gait[i, 0], gait[i, 1]
        happened = step(now, reading)
        write_row(rows, i, now)
        write_trace(trace[i], now, happened)
        covariances[i] = now.P
        if happened & s.STRIDE:
            write_event(events[count], now, happened)
            count += 1
    return count


@part
def write_trace(trace: Floats, now: KalmanState, happened: int) -> None:
    """One row of the trace. Where level or bias was set anew, what comes after says nothing of before."""
    trace[0] = 2.0 if happened & (s.RESTING | s.LEVEL_FOUND) else now.learnt
    trace[_DT] = now.dt_s
    trace[_HALF], trace[_HALF + 1], trace[_HALF + 2], trace[_HALF + 3] = (
        now.half0,
        now.half1,
        now.half2,
        now.half3,
    )
    trace[_PUSH], trace[_PUSH + 1], trace[_PUSH + 2] = now.push_x, now.push_y, now.push_z
    trace[_FLOOR], trace[_NORTH] = now.floor_began, now.north_began
    for k in range(MEASURES):
        at = _MEASURED + k * _EACH
        trace[at], trace[at + 1] = now.totals[k], now.lefts[k]
        for j in range(PARTS if now.totals[k] > 0.0 else 0):
            trace[at + 2 + j] = now.gains[k, j]


@kernel
def backward(adjoint: Floats, rows: Floats, trace: Floats, covariances: Floats) -> None:
    """Smooth the rows of a block, last to first; ``adjoint`` [17] is λ behind its last row, and changes."""
    shift = np.empty(9)
    for i in range(rows.shape[0] - 1, -1, -1):
        for k in range(9):
            shift[k] = 0.0
            for j in range(PARTS):
                shift[k] -= covariances[i, k, j] * adjoint[j]
        for k in range(6):
            rows[i, k] += shift[k]
        turn_row(rows[i], exponential((shift[6], shift[7], shift[8])))
        if trace[i, 0] == 2.0:
            adjoint[:] = 0.0
            continue
        if trace[i, 0] == 1.0:
            adjoint[9:12] = 0.0
        unmeasure(adjoint, measured(trace[i], NORTH_MEASURE), YAW_AT, NORTH_AT)
        uncopy(adjoint, trace[i, _NORTH], YAW_AT, NORTH_AT)
        unmeasure(adjoint, measured(trace[i], FLOOR_MEASURE), HEIGHT_AT, FLOOR_AT)
        uncopy(adjoint, trace[i, _FLOOR], HEIGHT_AT, FLOOR_AT)
        for k in range(2, -1, -1):
            unmeasure(adjoint, measured(trace[i], k), VELOCITY_AT + k, -1)
        unpredict(adjoint, trace[i])


@part
def measured(trace: Floats, which: int) -> Floats:
    """The columns of one measurement."""
    at = _MEASURED + which * _EACH
    return trace[at : at + _EACH]


@part
def unmeasure(adjoint: Floats, measured: Floats, part: int, less: int) -> None:
    """λ ← λ − h (Kᵀλ + y/S) for one scalar measurement of one part, or of how two differ."""
    total, left = measured[0], measured[1]
    if total == 0.0:
        return
    seen = left
    for j in range(PARTS):
        seen += measured[2 + j] * adjoint[j]
    adjoint[part] -= seen / total
    if less >= 0:
        adjoint[less] += seen / total


@part
def uncopy(adjoint: Floats, began: float, part: int, into: int) -> None:
    """λ ← Cᵀ λ, where ``into`` became a copy of ``part``, if it did."""
    if began != 0.0:
        adjoint[part] += adjoint[into]
        adjoint[into] = 0.0


@part
def unpredict(adjoint: Floats, trace: Floats) -> None:
    """λ ← Fᵀ λ, with the F of ``covariance.propagate``."""
    dt = trace[_DT]
    back = conjugate((trace[_HALF], trace[_HALF + 1], trace[_HALF + 2], trace[_HALF + 3]))
    fx, fy, fz = trace[_PUSH], trace[_PUSH + 1], trace[_PUSH + 2]
    vx, vy, vz = adjoint[3], adjoint[4], adjoint[5]
    turned = rotate(back, (adjoint[6], adjoint[7], adjoint[8]))
    pushed = rotate(back, (vx, vy, vz))
    for k in range(3):
        adjoint[9 + k] -= dt * turned[k]
        adjoint[12 + k] -= dt * pushed[k]
        adjoint[3 + k] += dt * adjoint[k]
    adjoint[6] += dt * (fy * vz - fz * vy)
    adjoint[7] += dt * (fz * vx - fx * vz)
    adjoint[8] += dt * (fx * vy - fy * vx)


def gait_around(tracker: Tracker, samples: Blocks) -> Floats:
    """The energy, (rad/s)², and the least statistic around each row [n, 2]."""
    table = samples.table(samples.start, tracker.rows.end)
    t_s = table[:, Column.ELAPSED_NS] * 1e-9
    rate2 = np.sum(table[:, Column.WX : Column.MX] ** 2, axis=1)
    total = np.append(0.0, np.cumsum(rate2))
    begin, end = (np.searchsorted(t_s, t_s + half) for half in (-ENERGY_S / 2, ENERGY_S / 2))
    statistic = tracker.rows.table(samples.start, tracker.rows.end)[:, RowColumn.STATISTIC] ** 2 / AS_RATE**2
    width = max(1, round(LEAST_S / float(np.median(np.diff(t_s)))))
    energy = (total[end] - total[begin]) / np.maximum(end - begin, 1)
    return np.column_stack([energy, minimum_filter1d(statistic, width)])


def finish(tracker: Tracker, samples: Blocks) -> bool:
    """The walk is over: smooth it if its settings say so. Says whether they do."""
    if tracker.settings.looks_back:
        smooth(tracker, samples)
    return tracker.settings.looks_back


def smooth(tracker: Tracker, samples: Blocks) -> None:
    """Replace a Kalman tracker's rows and strides by the smoothed ones, as far back as there are samples."""
    if tracker.rows.end - tracker.rows.start < 2:
        return
    gait = gait_around(tracker, samples)
    trace, covariances = np.zeros((BLOCK, TRACE_WIDTH)), np.zeros((BLOCK, PARTS, PARTS))
    events = np.zeros((BLOCK, e.WIDTH))
    state = tracker.checkpoints[tracker.rows.start].state.copy()
    states: list[tuple[int, Record]] = []
    strides: list[Floats] = []

    def again(start: int, state: Record) -> tuple[Floats, int]:
        rows, _ = tracker.rows.block(start)
        piece, _ = samples.block(start)
        count = min(BLOCK, tracker.rows.end - start)
        around = gait[start - samples.start :][:count]
        found = forward(state, piece[:count], around, rows[:count], trace, covariances, events)
        return rows[:count], found

    for start in range(tracker.rows.start, tracker.rows.end, BLOCK):
        states.append((start, state.copy()))
        _, found = again(start, state)
        strides += list(events[:found].copy())
    adjoint = np.zeros(PARTS)
    for start, before in reversed(states):
        rows, _ = again(start, before)
        backward(adjoint, rows, trace[: len(rows)], covariances[: len(rows)])
    tracker.retell(strides)
