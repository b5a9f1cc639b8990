"""Heart: lifts and contacts by the zero-velocity detector, and when a swing is over and can be corrected.

A zero velocity is soft at first and sharpens through a stance, so the swing before it is corrected when
the foot has stood for a tenth of a second, or lifts again.
"""

from __future__ import annotations

import math

from app.compiled import part
from app.estimator import state as s
from app.estimator.floor import stand_on_floor
from app.estimator.gait import STANCE, SWING
from app.estimator.kalman_state import KalmanState
from app.estimator.north import hold_heading

#: A swing is corrected so long after its contact.
SETTLED_NS = 100_000_000
#: A zero velocity shorter than this in mid-swing is no contact; a swing shorter than this no stride.
SHORTEST_STANCE_NS, SHORTEST_SWING_NS = 15_000_000, 150_000_000
#: … unless the foot was at rest there by its own account, m/s: the stances of a run are short.
AT_REST_MPS = 0.5
#: Nobody sets the same foot down twice within this: sprinters take 0.4 s. A foot that settles does.
SHORTEST_STRIDE_NS = 330_000_000


@part
def note_contact(state: KalmanState) -> bool:
    """Before an update: the first zero velocity of a swing under way is its contact. Says whether it is."""
    if state.moving == 0.0 or state.contact_row >= 0.0:
        return False
    state.contact_row, state.contact_ns = state.row, state.elapsed_ns
    state.contact_mps = math.sqrt(state.aways[0] ** 2 + state.aways[1] ** 2 + state.aways[2] ** 2)
    state.before_x, state.before_y, state.before_z = state.corrected_x, state.corrected_y, state.corrected_z
    state.at_x = state.px - state.corrected_x
    state.at_y = state.py - state.corrected_y
    state.at_z = state.pz - state.corrected_z
    state.unturned_x, state.unturned_y, state.unturned_z = state.turned_x, state.turned_y, state.turned_z
    state.slowed_x, state.slowed_y, state.slowed_z = 0.0, 0.0, 0.0
    return True


@part
def footfall(state: KalmanState, stood: bool) -> int:
    """After an update: the phase, and whether the swing behind is over: ``STRIDE``, or ``FLICKER``."""
    happened = 0
    stood_ns = state.elapsed_ns - state.contact_ns
    if state.contact_row >= 0.0 and (stood_ns >= SETTLED_NS or not stood):
        if stood or stood_ns >= SHORTEST_STANCE_NS or state.contact_mps < AT_REST_MPS:
            stand_on_floor(state)
            hold_heading(state)
            happened = finish(state)
        else:
            state.contact_row = -1.0
    if stood:
        state.quiet_ns = state.elapsed_ns
    if stood and state.moving == 0.0:
        stand(state)
    elif not stood:
        state.moving = 1.0
    state.phase = STANCE if stood else SWING
    return happened


@part
def finish(state: KalmanState) -> int:
    """The swing under way ended at its contact: note what the row's correction needs."""
    since_contact_ns = state.contact_ns - state.done_lift_ns - 1e9 * state.done_swing_s
    state.done_lift_row, state.done_lift_ns = state.lift_row, state.lift_ns
    state.done_contact_row = state.contact_row
    state.done_swing_s = (state.contact_ns - state.lift_ns) * 1e-9
    state.start_x, state.start_y, state.start_z = state.from_x, state.from_y, state.from_z
    state.moving, state.contact_row = 0.0, -1.0
    state.lift_row, state.lift_ns = state.row - 1.0, state.elapsed_ns
    state.from_x, state.from_y, state.from_z = state.px, state.py, state.pz
    long = state.contact_ns - state.done_lift_ns >= SHORTEST_SWING_NS
    return s.STRIDE if long and since_contact_ns >= SHORTEST_STRIDE_NS else s.FLICKER


@part
def end_footfalls(state: KalmanState) -> int:
    """A gap in time: a swing whose contact was seen is over, one cut short keeps its travel."""
    happened = finish(state) if state.contact_row >= 0.0 else 0
    state.moving = 0.0
    stand(state)
    return happened


@part
def stand(state: KalmanState) -> None:
    """The foot stands, or rests until level is found: the next swing begins here, if it does not stand on."""
    state.lift_row, state.lift_ns = state.row, state.elapsed_ns
    state.from_x, state.from_y, state.from_z = state.px, state.py, state.pz
