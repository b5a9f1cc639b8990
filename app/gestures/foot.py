"""Heart: one foot of the default decoder: where an action begins and ends, and what kind it is.

Angles are turned about the foot's own level, found while it rests, from the moment the action
begins: no heading is needed, and no drift can grow.
"""

from __future__ import annotations

import math

from app.compiled import kernel, part
from app.gestures.state import BACK, STEP, TOE_UP, TWIST, UNKNOWN, Foot

_REST_S = 0.4  # time constant of level and bias
_LONGEST_S = 3.0  # no action lasts longer
_STUCK_S = 0.35  # quiet for so long is an end, wherever the foot is
_QUIET_S = 0.05
REST_CYCLES = 3.6  # from onset to onset, in lengths of an action: more is a rest between


@part
def reset_foot(foot: Foot) -> None:
    """Back to rest; level and bias stay."""
    foot.moving, foot.sure, foot.below_s = 0.0, 0.0, 0.0
    foot.now, foot.margin = UNKNOWN, 0.0
    forget_actions(foot)


@part
def forget_actions(foot: Foot) -> None:
    """A new bout begins."""
    foot.kind, foot.energy, foot.actions, foot.size = UNKNOWN, 0.0, 0.0, 0.0
    foot.on_s, foot.previous_on_s, foot.end_s, foot.duration_s = -1e9, -1e9, -1e9, 0.0


@part
def find_level(foot: Foot, f: tuple[float, float, float], w: tuple[float, float, float], dt_s: float) -> None:
    """Gravity and bias follow the readings slowly while the foot rests, at once at the first sample."""
    norm = math.sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2])
    if norm < 5.0 or norm > 15.0:
        return
    if foot.levelled == 0.0:
        foot.levelled = 1.0
        foot.dx, foot.dy, foot.dz, foot.gravity = -f[0] / norm, -f[1] / norm, -f[2] / norm, norm
        if w[0] * w[0] + w[1] * w[1] + w[2] * w[2] < 0.01:
            foot.bx, foot.by, foot.bz = w[0], w[1], w[2]
        return
    share = dt_s / (_REST_S + dt_s)
    dx, dy, dz = (
        foot.dx - share * (f[0] / norm + foot.dx),
        foot.dy - share * (f[1] / norm + foot.dy),
        foot.dz - share * (f[2] / norm + foot.dz),
    )
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    foot.dx, foot.dy, foot.dz = dx / length, dy / length, dz / length
    foot.gravity += share * (norm - foot.gravity)
    if abs(w[0]) < 0.1 and abs(w[1]) < 0.1 and abs(w[2]) < 0.1:
        share = dt_s / (2.0 + dt_s)
        foot.bx += share * (w[0] - foot.bx)
        foot.by += share * (w[1] - foot.by)
        foot.bz += share * (w[2] - foot.bz)


@part
def level_rates(foot: Foot, w: tuple[float, float, float]) -> tuple[float, float, float]:
    """(yaw, pitch, roll) rates about down, and about the horizontal right and toe axes, bias removed."""
    x, y, z = w[0] - foot.bx, w[1] - foot.by, w[2] - foot.bz
    yaw = x * foot.dx + y * foot.dy + z * foot.dz
    # the right axis made horizontal: y − (y·d) d
    ux, uy, uz = -foot.dy * foot.dx, 1.0 - foot.dy * foot.dy, -foot.dy * foot.dz
    length = math.sqrt(ux * ux + uy * uy + uz * uz) + 1e-9
    pitch = (x * ux + y * uy + z * uz) / length
    rest = x * x + y * y + z * z - yaw * yaw - pitch * pitch
    return yaw, pitch, math.sqrt(max(rest, 0.0))


@part
def begin(foot: Foot, now_s: float) -> None:
    """The rate has just passed the threshold."""
    foot.moving, foot.sure, foot.below_s = 1.0, 0.0, 0.0
    foot.begin_s = now_s
    foot.yaw, foot.pitch, foot.roll = 0.0, 0.0, 0.0
    foot.yaw_peak, foot.pitch_peak, foot.pitch_least, foot.pitch_most = 0.0, 0.0, 0.0, 0.0
    foot.rate_most = 0.0
    foot.yaw_energy, foot.tilt_energy, foot.now, foot.margin = 0.0, 0.0, UNKNOWN, 0.0


@part
def add_up(foot: Foot, rates: tuple[float, float, float], dt_s: float) -> None:
    """The action goes on."""
    yaw, pitch, roll = rates
    foot.yaw += yaw * dt_s
    foot.pitch += pitch * dt_s
    foot.roll += roll * dt_s
    foot.yaw_peak = max(foot.yaw_peak, abs(foot.yaw))
    foot.pitch_peak = max(foot.pitch_peak, abs(foot.pitch))
    foot.pitch_least = min(foot.pitch_least, foot.pitch)
    foot.pitch_most = max(foot.pitch_most, foot.pitch)
    foot.yaw_energy += yaw * yaw * dt_s
    foot.tilt_energy += (pitch * pitch + 0.5 * roll * roll) * dt_s


@part
def kind_now(foot: Foot) -> tuple[float, float]:
    """What the action under way is, and how clearly (0 to 1)."""
    total = foot.yaw_energy + foot.tilt_energy + 1e-9
    twisted = (foot.yaw_energy - foot.tilt_energy) / total
    if twisted > 0.0:
        return TWIST, twisted
    if foot.pitch_most > -foot.pitch_least or foot.now == TOE_UP or foot.now == BACK:
        # the toe rose first; only a foot that has left the floor can tip the other way
        if foot.pitch_least < -0.2 * foot.pitch_most - 0.015 and foot.pitch_most > 0.03:
            return BACK, -twisted
        if foot.now != STEP:
            return (BACK if foot.now == BACK else TOE_UP), -twisted
    return STEP, -twisted


@kernel
def step_foot(
    foot: Foot,
    now_s: float,
    f: tuple[float, float, float],
    w: tuple[float, float, float],
    on_radps: float,
    off_radps: float,
    sure_rad: float,
) -> bool:
    """One sample of one foot; whether an action has just become sure."""
    dt_s = min(max(now_s - foot.t_s, 0.0), 0.1)
    foot.t_s = now_s
    if foot.levelled == 0.0:
        find_level(foot, f, w, dt_s)
        return False
    rates = level_rates(foot, w)
    rate = math.sqrt(rates[0] * rates[0] + rates[1] * rates[1] + rates[2] * rates[2])
    if foot.moving == 0.0:
        if rate < off_radps:
            find_level(foot, f, w, dt_s)
            return False
        begin(foot, now_s)
    add_up(foot, rates, dt_s)
    foot.rate_most = max(foot.rate_most, rate)
    foot.now, foot.margin = kind_now(foot)
    turned = math.sqrt(foot.yaw * foot.yaw + foot.pitch * foot.pitch + foot.roll * foot.roll)
    turned = max(turned, foot.pitch_most - foot.pitch_least)  # a small step back tips both ways
    fresh = foot.sure == 0.0 and turned >= sure_rad and foot.rate_most >= on_radps
    if fresh:
        become_sure(foot)
    if foot.sure != 0.0:
        foot.rate_peak = foot.rate_most
    settle_kind(foot)
    foot.below_s = foot.below_s + dt_s if rate < off_radps else 0.0
    if ended(foot, now_s):
        end(foot, now_s)
    return fresh


@part
def become_sure(foot: Foot) -> None:
    """It is an action: it counts from its onset on. After a rest it is the first of a new bout."""
    foot.sure = 1.0
    if foot.begin_s - foot.on_s > REST_CYCLES * foot.duration_s:
        forget_actions(foot)
    foot.previous_on_s, foot.on_s = foot.on_s, foot.begin_s
    foot.actions += 1.0


@part
def settle_kind(foot: Foot) -> None:
    """The kind of this action, once it is clear; until then the last one's, if there was one."""
    if foot.sure == 0.0:
        return
    fresh = foot.kind == UNKNOWN or foot.kind == TOE_UP
    strong = foot.yaw_energy + foot.tilt_energy > 0.4 * foot.energy and foot.margin > 0.3
    if (fresh and foot.margin > 0.2) or (strong and (foot.now != TOE_UP or foot.kind != BACK)):
        foot.kind = foot.now


@part
def ended(foot: Foot, now_s: float) -> bool:
    """Quiet, and back where it began; or quiet for long; or too long.

    Turning about one axis leaks into the other, the more the further it goes.
    """
    yaw_room = 0.03 + max(0.35 * foot.yaw_peak, 0.25 * foot.pitch_peak)
    pitch_room = 0.03 + max(0.35 * foot.pitch_peak, 0.25 * foot.yaw_peak)
    back = abs(foot.yaw) < yaw_room and abs(foot.pitch) < pitch_room
    quiet = foot.below_s >= _QUIET_S and back
    return quiet or foot.below_s >= _STUCK_S or now_s - foot.begin_s > _LONGEST_S


@part
def end(foot: Foot, now_s: float) -> None:
    """The foot rests again."""
    foot.moving = 0.0
    if foot.sure != 0.0:
        if foot.now != TOE_UP or foot.kind != BACK:
            foot.kind = foot.now
        foot.end_s = now_s - foot.below_s
        foot.duration_s = foot.end_s - foot.on_s
        foot.energy = foot.yaw_energy + foot.tilt_energy
        size = foot.yaw_peak if foot.now == TWIST else foot.pitch_peak
        foot.size = size if foot.size == 0.0 else 0.5 * (foot.size + size)
