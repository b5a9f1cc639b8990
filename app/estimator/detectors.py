"""Heart: zero-velocity detectors behind one question: does the foot stand at this sample?

All look back over a window of 50 ms. ADAPTIVE and SHOE use the statistic of I. Skog, P. Händel,
J.-O. Nilsson, J. Rantakokko, "Zero-Velocity Detection: An Algorithm Evaluation", IEEE TBME 57(11), 2010,
ARED its energy of the rate alone; RATE is the papers' two-state machine (``gait.py``).
"""

from __future__ import annotations

import math

from app.compiled import part
from app.estimator.gait import STANCE, gait_phase
from app.estimator.kalman_state import (
    BIN_NS,
    BINS,
    RING,
    RING_F,
    RING_NS,
    RING_W2,
    Detector,
    KalmanState,
)

#: Samples older than this are outside the window (50 ms, uneven stamps forgiven).
WINDOW_NS = 49_900_000
#: σ² of the statistic: (0.1 m/s²)² and (0.1 rad/s)², so that 0.1 √T is a rate in rad/s.
VARIANCE = 0.01
#: The adaptive threshold is a share of the gait's energy, between these.
LEAST_THRESHOLD, MOST_THRESHOLD = 7.0, 5000.0
#: … and never more than so many times the least statistic of the last stride, or of a quiet foot.
OVER_LEAST, LEAST_FLOOR = 5.0, 20.0
#: Bins of 50 ms: the gait's energy is the mean of 1.5 s, its least statistic that of 1.2 s.
ENERGY_BINS, LEAST_BINS = 30, 24
#: Walking is a mean |ω|² above this, (rad/s)²; without a stance for a second then, the threshold loosens.
WALKING = 1.0
STARVED_S, DOUBLING_S, NEAR_LEAST = 1.0, 0.25, 1.5
#: A statistic so far over the threshold may still be a stance, if the foot has no speed to speak of.
NEARLY_OVER = 3.0
SHORTEST_NS = 250_000_000
#: What a detector answers.
MOVES, STANDS, NEARLY, STARVED = 0, 1, 2, 3

_ADAPTIVE, _SHOE, _ARED = int(Detector.ADAPTIVE), int(Detector.SHOE), int(Detector.ARED)


@part
def forget_gait(state: KalmanState) -> None:
    """Empty windows: a new segment."""
    state.ring_n = 0.0
    state.bin_ns = state.elapsed_ns
    for b in range(BINS):
        state.bins[b, 0], state.bins[b, 1], state.bins[b, 2] = 0.0, 0.0, math.inf
    state.quiet_ns = state.elapsed_ns
    state.sure_ns = state.elapsed_ns


@part
def remember(state: KalmanState) -> int:
    """Put the newest sample into the ring; returns its place."""
    place = (int(state.ring_at) + 1) % RING
    state.ring_at = float(place)
    state.ring_n = min(state.ring_n + 1.0, float(RING))
    state.ring[place, RING_NS] = state.elapsed_ns
    state.ring[place, RING_F] = state.f0
    state.ring[place, RING_F + 1] = state.f1
    state.ring[place, RING_F + 2] = state.f2
    state.ring[place, RING_W2] = state.w0 * state.w0 + state.w1 * state.w1 + state.w2 * state.w2
    return place


@part
def window_statistic(state: KalmanState) -> tuple[float, float]:
    """T of the window that ends now, and its mean |ω|².

    T = mean(|f − g·f̄/|f̄||² + |ω|²)/σ², which needs only sums: |f̄·u − …| opens to mean|f|² − 2g|f̄| + g².
    Where gravity is not known yet, |f̄| stands for it.
    """
    x, y, z, squares, rates = 0.0, 0.0, 0.0, 0.0, 0.0
    count, place = 0, int(state.ring_at)
    for back in range(int(state.ring_n)):
        i = (place - back) % RING
        if state.elapsed_ns - state.ring[i, RING_NS] > WINDOW_NS:
            break
        fx, fy, fz = state.ring[i, RING_F], state.ring[i, RING_F + 1], state.ring[i, RING_F + 2]
        x, y, z = x + fx, y + fy, z + fz
        squares += fx * fx + fy * fy + fz * fz
        rates += state.ring[i, RING_W2]
        count += 1
    mean = math.sqrt(x * x + y * y + z * z) / count
    gravity = state.gravity if state.levelled != 0.0 else mean
    away = max(0.0, squares / count - 2.0 * gravity * mean + gravity * gravity)
    return (away + rates / count) / VARIANCE, rates / count


@part
def remember_gait(state: KalmanState) -> tuple[float, float]:
    """The newest sample into the bins; returns E, the gait's mean |ω|², and M, its least statistic."""
    at = int(state.bin_at)
    while state.elapsed_ns - state.bin_ns >= BIN_NS:
        state.bin_ns += BIN_NS
        at = (at + 1) % BINS
        state.bins[at, 0], state.bins[at, 1], state.bins[at, 2] = 0.0, 0.0, math.inf
    state.bin_at = float(at)
    state.bins[at, 0] += state.ring[int(state.ring_at), RING_W2]
    state.bins[at, 1] += 1.0
    state.bins[at, 2] = min(state.bins[at, 2], state.statistic)
    energy, count, least = 0.0, 0.0, state.statistic
    for back in range(ENERGY_BINS):
        b = (at - back) % BINS
        energy += state.bins[b, 0]
        count += state.bins[b, 1]
        if back < LEAST_BINS:
            least = min(least, state.bins[b, 2])
    return energy / count, least


@part
def stands(state: KalmanState, energy: float, least: float, rate2: float, dt_s: float) -> int:
    """Whether the foot has zero velocity now, by the detector chosen; notes the threshold it was held to.

    Returns ``MOVES``, ``STANDS``, or what the filter's own velocity has to confirm: ``NEARLY``, ``STARVED``.
    """
    kind = int(state.detector)
    if kind == _ADAPTIVE:
        return adapts(state, energy, least)
    if kind == _SHOE:
        state.threshold = state.still_statistic
        return STANDS if state.statistic < state.threshold else MOVES
    if kind == _ARED:
        state.threshold = state.threshold_radps * state.threshold_radps / VARIANCE
        return STANDS if rate2 / VARIANCE < state.threshold else MOVES
    state.threshold = state.threshold_radps * state.threshold_radps / VARIANCE
    rate = math.sqrt(state.w0 * state.w0 + state.w1 * state.w1 + state.w2 * state.w2)
    phase, limit, least_s = state.phase, state.threshold_radps, state.min_duration_s
    phase, state.contrary_s = gait_phase(phase, state.contrary_s, rate, limit, least_s, dt_s)
    return STANDS if phase == STANCE else MOVES


@part
def adapts(state: KalmanState, energy: float, least: float) -> int:
    """The largest safe statistic of a stance grows with the energy of the gait: walking and running alike.

    A fixed threshold serves one of them. The second condition keeps to the quietest part of a stance;
    the third, when no stance was found for a second of walking, takes what is least, however loud.
    """
    threshold = min(max(state.gait_factor * energy, LEAST_THRESHOLD), MOST_THRESHOLD)
    state.threshold = min(threshold, OVER_LEAST * max(least, LEAST_FLOOR))
    if state.statistic < state.threshold:
        state.sure_ns = state.elapsed_ns
        return STANDS
    if energy <= WALKING:
        return MOVES
    hungry_s = (state.elapsed_ns - state.quiet_ns) * 1e-9 - STARVED_S
    if hungry_s <= 0.0:
        missed = state.statistic > state.statistic_before and state.elapsed_ns - state.sure_ns > SHORTEST_NS
        return NEARLY if missed and state.statistic < NEARLY_OVER * threshold else MOVES
    loosened = min(threshold * 2.0 ** min(hungry_s / DOUBLING_S, 10.0), MOST_THRESHOLD)
    state.threshold = min(loosened, NEAR_LEAST * least)
    return STARVED if state.statistic < state.threshold else MOVES
