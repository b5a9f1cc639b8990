"""Heart: the walk so far under a whole grid of gains, in one pass.

What the gains do not touch is done once a sample (``observe``, ``aid``), what they do is done for
all pairs side by side (``navigate``): the same functions as the live step, so the best pair, run
live, ends at the same place to the bit.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from app.blocks import Blocks
from app.compiled import kernel
from app.estimator import state as s
from app.estimator.attitude import share_of
from app.estimator.gait import STANCE
from app.estimator.papers import aid, leave_segment, level, navigate, observe, reading_at
from app.estimator.resume import resume
from app.estimator.state import NAV, Record
from app.estimator.tracker import Checkpoint
from app.motion.basics import Floats, InputError
from app.motion.estimate import Sweep
from app.settings import Settings

#: The grid "Find gains" looks at: k_s and k_d in 1/s.
GAINS_STANCE = np.linspace(0.0, 4.0, 41)
GAINS_SWING = np.linspace(0.0, 1.0, 21)


@kernel
def sweep_run(
    state: Record, navs: Record, gains_stance: Floats, gains_swing: Floats, shares: Floats, samples: Floats
) -> None:
    """Step ``samples`` [k, 10] through all ``navs`` [a · b]: ``state`` [1] holds what they share.

    ``shares`` [max(a, b)] is working space.
    """
    now = state[0]
    columns = gains_swing.shape[0]
    for i in range(samples.shape[0]):
        reading = reading_at(samples, i)
        force_before, rate_before = (now.fx, now.fy, now.fz), (now.wx, now.wy, now.wz)
        happened, dt_s = observe(now, reading)
        if happened & s.SEGMENT:
            for j in range(navs.shape[0]):
                leave_segment(navs[j], now, happened)
        if happened & (s.RESTING | s.LEVEL_FOUND):
            for j in range(navs.shape[0]):
                level(navs[j], now)
        if not happened & s.RESTING:
            aiding = aid(now, reading, rate_before, dt_s)
            stance = now.phase == STANCE
            gains = gains_stance if stance else gains_swing
            for g in range(gains.shape[0]):
                shares[g] = share_of(gains[g], dt_s)
            for j in range(navs.shape[0]):
                share = shares[j // columns] if stance else shares[j % columns]
                navigate(navs[j], now, happened, aiding, share, force_before, dt_s)
        now.row += 1.0


def demand_gains(settings: Settings) -> None:
    """``InputError`` under an estimator that has no gains k_s and k_d."""
    if settings.estimator != "papers":
        raise InputError(
            f"find gains: the estimator {settings.estimator} has none, expected papers: change it"
        )


def sweep(
    samples: Blocks,
    settings: Settings,
    gains_stance: Floats = GAINS_STANCE,
    gains_swing: Floats = GAINS_SWING,
    progress: Callable[[float], bool] = lambda done: True,
    base: Checkpoint | None = None,
) -> Floats:
    """Horizontal distance from start to end, m [a, b], for every k_s [a] and k_d [b].

    Where the oldest samples are gone, ``base`` is a tracker's checkpoint at the oldest still here.
    Under another estimator than the papers', which has no such gains, it is ``InputError``.
    ``progress`` is told how much is done, 0…1, and returns False to give up (then ``InterruptedError``).
    """
    demand_gains(settings)
    state = s.new_state(settings) if base is None else base.state.copy()
    resume(state, settings)
    navs = np.zeros(len(gains_stance) * len(gains_swing), NAV)
    for name in NAV.names or ():
        navs[name] = state[name]
    shares = np.zeros(max(len(gains_stance), len(gains_swing)))
    for piece, row in samples.pieces(samples.start, samples.end):
        sweep_run(state, navs, gains_stance, gains_swing, shares, piece)
        if not progress((row + len(piece) - samples.start) / max(1, len(samples))):
            raise InterruptedError("the sweep was given up")
    closure_m: Floats = np.hypot(navs["px"] + navs["sx"], navs["py"] + navs["sy"])
    return closure_m.reshape(len(gains_stance), len(gains_swing))


def best_of(
    closures_m: list[Floats], gains_stance: Floats = GAINS_STANCE, gains_swing: Floats = GAINS_SWING
) -> Sweep:
    """The pair of gains with the least mean closure over the feet, and the surface it lies on."""
    mean_m = np.mean(closures_m, axis=0)
    a, b = np.unravel_index(int(np.argmin(mean_m)), mean_m.shape)
    return Sweep(gains_stance, gains_swing, mean_m, (float(gains_stance[a]), float(gains_swing[b])))
