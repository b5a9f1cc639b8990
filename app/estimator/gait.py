"""Heart: the gait-phase detector: two states on the angular rate (2012 paper, II-C and Fig. 5)."""

from __future__ import annotations

from app.compiled import part
from app.motion.basics import GaitPhase

STANCE = float(GaitPhase.STANCE)
SWING = float(GaitPhase.SWING)


@part
def gait_phase(
    phase: float,
    contrary_s: float,
    rate_radps: float,
    threshold_radps: float,
    min_duration_s: float,
    dt_s: float,
) -> tuple[float, float]:
    """One step of the machine of Fig. 5: (phase, γ in seconds) → the same.

    γ counts *consecutive* contrary samples and starts again whenever one is not, or the phase
    changes: the printed pseudo-code (dissertation, Fig. 12) never resets it and finds 239 steps in
    100. It counts seconds, not samples, so that the rate does not matter; the last half sample is
    forgiven, so that uneven stamps do not cost one.
    """
    contrary = rate_radps >= threshold_radps if phase == STANCE else rate_radps <= threshold_radps
    if not contrary:
        return phase, 0.0  # transitions 1 and 3
    contrary_s += dt_s
    if contrary_s < min_duration_s - 0.5 * dt_s:
        return phase, contrary_s
    return (SWING if phase == STANCE else STANCE), 0.0  # transitions 2 and 4
