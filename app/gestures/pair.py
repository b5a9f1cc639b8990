"""Heart: both feet of the default decoder together: pace, class, stop, and why."""

from __future__ import annotations

from app.compiled import kernel, part
from app.gestures import state as s
from app.gestures.foot import REST_CYCLES, reset_foot, step_foot
from app.gestures.state import BACK, STEP, TOE_UP, TWIST, UNKNOWN, Foot, Pair, Record, Tuning
from app.motion.basics import MotionId

_, _FORWARD, _FORWARD_RIGHT, _FORWARD_LEFT, _SIDE_RIGHT, _SIDE_LEFT, _TURN_CW, _TURN_CCW, _BACKWARD = map(
    int, MotionId
)
_USUAL_CYCLE_S = 1.0
_DUTY = 2.35  # cycles are about so many actions long
_APART = 2.0  # the other foot follows within so many actions' lengths
_FAULT_S = 0.3  # so long after rubbish a foot is not believed


@kernel
def step(
    feet: Record,
    pairs: Record,
    tunings: Record,
    which: int,
    now_s: float,
    f: tuple[float, float, float],
    w: tuple[float, float, float],
) -> bool:
    """One sample of foot 0 (left) or 1 (right); whether what is decided has changed."""
    pair, tuning = pairs[0], tunings[0]
    foot, other = feet[which], feet[1 - which]
    total = f[0] + f[1] + f[2] + w[0] + w[1] + w[2]
    if not abs(total) < 1e6:  # NaN too
        foot.fault_s, foot.t_s, foot.seen = now_s, now_s, 1.0
        reset_foot(foot)
        return decide(feet, pair, tuning, now_s)
    if foot.seen == 0.0 or now_s - foot.t_s > tuning.silence_s:
        reset_foot(foot)
        foot.t_s = now_s
    foot.seen = 1.0
    quiet_radps, enough_rad = large_enough(foot, other, tuning.off_radps, tuning.sure_rad, now_s)
    if step_foot(foot, now_s, f, w, tuning.on_radps, quiet_radps, enough_rad):
        note_onset(foot, other, pair)
    return decide(feet, pair, tuning, now_s)


@part
def large_enough(
    foot: Foot, other: Foot, off_radps: float, sure_rad: float, now_s: float
) -> tuple[float, float]:
    """The rate above which this foot moves at all, and the angle that counts as an action.

    Both are a share of what the feet did just now, for a standing foot gives under the other's weight.
    """
    quiet, enough = off_radps, sure_rad
    if acts(foot) or now_s - foot.on_s < REST_CYCLES * foot.duration_s:
        quiet = max(quiet, 0.1 * foot.rate_peak)
        enough = max(enough, 0.35 * foot.size)
    if acts(other):
        quiet = max(quiet, 0.07 * other.rate_peak)
        enough = max(enough, 0.25 * max(other.yaw_peak, other.pitch_peak))
    elif now_s - other.on_s < REST_CYCLES * other.duration_s:
        quiet = max(quiet, 0.07 * other.rate_peak)
        enough = max(enough, 0.25 * other.size)
    return quiet, enough


@part
def note_onset(foot: Foot, other: Foot, pair: Pair) -> None:
    """The pace from this foot's last two onsets: a running mean of up to eight."""
    pair.stopped = 0.0
    interval = foot.on_s - foot.previous_on_s
    if interval > 1e6:  # the first of a bout
        if other.actions == 0.0 or foot.on_s - other.on_s > _APART * other.duration_s:
            pair.intervals = 0.0
        return
    if pair.intervals == 0.0 or (pair.odd != 0.0 and abs(interval - pair.cycle_s) > 0.4 * pair.cycle_s):
        pair.cycle_s, pair.intervals, pair.odd = interval, 1.0, 0.0
        return
    pair.odd = 1.0 if abs(interval - pair.cycle_s) > 0.4 * pair.cycle_s else 0.0
    if pair.odd != 0.0:
        return
    pair.intervals = min(pair.intervals + 1.0, 8.0)
    pair.cycle_s += (interval - pair.cycle_s) / pair.intervals


@part
def cycle_of(left: Foot, right: Foot, pair: Pair) -> float:
    """The best guess of the cycle: measured, or twice from foot to foot, or from one action's length."""
    if pair.intervals > 0.0:
        return pair.cycle_s
    newest = left if left.on_s > right.on_s else right
    older = right if left.on_s > right.on_s else left
    apart = newest.on_s - older.on_s
    if acts(older) or apart < _APART * older.duration_s:
        return max(2.0 * apart, 0.3)
    if newest.end_s > newest.on_s:
        return max(_DUTY * newest.duration_s, 0.3)
    return _USUAL_CYCLE_S


@part
def acts(foot: Foot) -> bool:
    """Whether the foot is in an action that counts."""
    return foot.moving != 0.0 and foot.sure != 0.0


@part
def takes_part(foot: Foot, other: Foot, cycle_s: float, now_s: float) -> float:
    """The kind with which the foot takes part in the gesture; ``UNKNOWN`` if it does not."""
    kind = foot.kind
    if kind == TOE_UP and other.kind == BACK and now_s - other.on_s < 1.35 * cycle_s + 0.05:
        kind = BACK
    if kind == TOE_UP or not (acts(foot) or now_s - foot.on_s < 1.35 * cycle_s + 0.05):
        return UNKNOWN
    return kind


@kernel
def decide(feet: Record, pair: Pair, tuning: Tuning, now_s: float) -> bool:
    """What both feet ask for now; whether that differs from before."""
    left, right = feet[0], feet[1]
    why = fault(left, right, tuning.silence_s, now_s)
    if why != 0:
        return stand(pair, why)
    if pair.stopped != 0.0 and not acts(left) and not acts(right):
        return stand(pair, 10 * s.STILL + 2)
    cycle = cycle_of(left, right, pair)
    a, b = takes_part(left, right, cycle, now_s), takes_part(right, left, cycle, now_s)
    if a != UNKNOWN and b != UNKNOWN:
        return both(left, right, a, b, cycle, pair, tuning, now_s)
    if a != UNKNOWN:
        return alone(left, right, a, 0, cycle, pair, tuning, now_s)
    if b != UNKNOWN:
        return alone(right, left, b, 1, cycle, pair, tuning, now_s)
    if acts(left) or acts(right):
        foot = left if acts(left) else right
        return stand(pair, 10 * (s.TAPS if foot.kind == TOE_UP else s.UNCLEAR) + (0 if acts(left) else 1))
    return stand(pair, 10 * s.STILL + 2)


@part
def fault(left: Foot, right: Foot, silence_s: float, now_s: float) -> int:
    """A reason to stand that is no gesture: a sensor is missing, silent or sends rubbish; or 0."""
    for i, foot in ((0, left), (1, right)):
        if foot.seen == 0.0:
            return 10 * s.MISSING + i
        if now_s - foot.t_s > silence_s:
            return 10 * s.SILENT + i
        if now_s - foot.fault_s < _FAULT_S:
            return 10 * s.RUBBISH + i
    return 0


@part
def stand(pair: Pair, reason: int) -> bool:
    """Nothing is asked for."""
    changed = pair.motion != 0.0 or pair.reason != reason
    pair.motion, pair.certain, pair.confidence, pair.speed, pair.turn = 0.0, 1.0, 1.0, 0.0, 0.0
    pair.pace = 0.0
    pair.reason = reason
    return changed


@part
def say(
    pair: Pair, motion: int, certain: bool, confidence: float, way: tuple[float, float, float], reason: int
) -> bool:
    """Something is asked for. ``way``: speed, turn, and the pace they are made of."""
    speed, turn, pace = way
    changed = (
        pair.motion != motion
        or (pair.certain != 0.0) != certain
        or abs(pair.speed - speed) > 0.005
        or abs(pair.turn - turn) > 0.02
        or pair.reason != reason
    )
    if changed:
        pair.motion, pair.certain, pair.confidence = motion, 1.0 if certain else 0.0, confidence
        pair.speed, pair.turn, pair.pace, pair.reason = speed, turn, pace, reason
    return changed


@part
def both(
    left: Foot, right: Foot, a: float, b: float, cycle_s: float, pair: Pair, tuning: Tuning, now_s: float
) -> bool:
    """Both feet take part."""
    if not acts(left) and not acts(right) and now_s - max(left.on_s, right.on_s) > 0.75 * cycle_s + 0.05:
        pair.stopped = 1.0
        return stand(pair, 10 * s.STILL + 2)
    confidence = 0.5 + 0.25 * (left.margin + right.margin)
    pace, reason = 1.0 / cycle_s, 10 * s.CLASS + 2
    ahead, share = tuning.forward_m * pace, tuning.turn_share * pace
    if a == STEP and b == STEP:
        return say(pair, _FORWARD, True, confidence, (ahead, 0.0, pace), reason)
    if a == BACK and b == BACK:
        return say(pair, _BACKWARD, True, confidence, (tuning.back_m * pace, 0.0, pace), reason)
    if a == STEP and b == TWIST:
        return say(pair, _FORWARD_RIGHT, True, confidence, (ahead, share * right.size, pace), reason)
    if a == TWIST and b == STEP:
        return say(pair, _FORWARD_LEFT, True, confidence, (ahead, -share * left.size, pace), reason)
    return stand(pair, 10 * (s.TWISTS if a == TWIST and b == TWIST else s.MIXED) + 2)


@part
def alone(
    foot: Foot, other: Foot, kind: float, which: int, cycle_s: float, pair: Pair, tuning: Tuning, now_s: float
) -> bool:
    """One foot takes part: for good, or the other has not yet begun."""
    since = now_s - foot.on_s
    if not acts(foot) and since > 1.2 * cycle_s + 0.03:
        pair.stopped = 1.0
        return stand(pair, 10 * s.STILL + 2)
    again = foot.on_s - foot.previous_on_s < 1.6 * cycle_s and other.on_s < foot.previous_on_s
    certain = again or (not acts(foot) and since > 0.85 * cycle_s)
    confidence = 0.5 + 0.5 * foot.margin if certain else 0.4
    reason = 10 * (s.CLASS if certain else s.FIRST) + which
    sign = 1.0 if which == 1 else -1.0
    pace = 1.0 / cycle_s if certain else 0.0
    if kind == TWIST:
        turn = sign * (tuning.turn_share * foot.size * pace if certain else tuning.gentle_radps)
        return say(
            pair, _TURN_CW if which == 1 else _TURN_CCW, certain, confidence, (0.0, turn, pace), reason
        )
    if kind == BACK and certain:
        return stand(pair, 10 * s.LONE_BACK + which)
    if not certain:
        ahead = _BACKWARD if kind == BACK else _FORWARD
        return say(pair, ahead, False, confidence, (tuning.gentle_mps, 0.0, pace), reason)
    side = _SIDE_RIGHT if which == 1 else _SIDE_LEFT
    return say(pair, side, True, confidence, (tuning.side_m * pace, 0.0, pace), reason)
