"""Heart: two feet of one person while they walk: no further apart than legs let them. Read ``take``.

A small filter beside both feet's own: how far each foot's walk is shifted and turned, and how fast that turn
grows. It moves at contacts only. There each foot stands within a step of where the other stood last (after
I. Skog, J.-O. Nilsson, D. Zachariah, P. Händel, "Fusing the information from two navigation systems using an
upper bound on their maximum spatial separation", IPIN 2012). A bound that holds changes nothing but what is
not known; where it is broken the feet are taken to be anywhere within it, which as a normal distribution has
half of it as σ. Contacts come in the order of the clock that both share, whenever their samples arrived.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from app.estimator.strides import Step
from app.estimator.turns import Turn, Turns
from app.motion.basics import Floats

#: Feet stand so far apart, side by side, when a walk begins (as they are drawn).
BESIDE_M = 0.2
#: σ of the heading that a gyro's noise gathers, rad/√s, and of the headings at the start, rad: the left
#: foot's is north for both.
WANDER_RADPS, START_RAD = 1e-3, (1e-6, 0.2)
#: σ of where the feet stand at the start, and of a stride: of its own, m, and a share of its length.
START_M, STRIDE_M, STRIDE_SHARE = 0.05, 0.01, 0.01
#: σ of the bound, m; a runner's feet are this share of a stride apart at most.
BOUND_M, OF_A_STRIDE = 0.05, 0.65
#: χ² of two parts beyond which the feet are not pulled; so much over the bound they are not one person's.
MOST_MISFIT, TOO_FAR_M = 25.0, 0.5
#: The headings at the start are found anew at each of so many contacts, if the bound is broken in them.
FIRST_CONTACTS = 24
#: Without samples a foot may go so far, m/s, and turn so fast, rad/s.
GAP_SPEED, GAP_TURN = 1.0, 0.3
#: After so long without it is put beside the other one; σ of its heading then, rad.
LOST_S, FOUND_RAD = 1.0, 0.3
#: σ of both where hindsight has put them together, m and rad.
AGAIN_M, AGAIN_RAD = 0.2, 0.02
#: A gyro's bias that has moved moves as far again in so long, s.
MOVES_S = 100.0
#: The walk is linked anew when a gyro's doubt (its square) has grown so many times, up to so many strides.
ANEW_TIMES, MOST_ANEW = 2.0, 2000
#: Contacts without a pull for so long tell that nothing holds the feet together.
LEAST_CONTACTS = 6
#: Parts of the state for each foot: shift north and east, turn, and how fast that grows.
_EACH, _TURN, _RATE = 4, 2, 3


class Together:
    """Left is 0, right is 1."""

    def __init__(
        self, apart_m: float, start_heading_rad: float = 0.0, after: tuple[Step, Step] | None = None
    ) -> None:
        """``apart_m``: the bound; at the start the right foot stands to the right of the heading.

        ``after``: the feet are together already, and these were their last strides.
        """
        self.apart_m = apart_m
        self.beside = BESIDE_M * np.array([-math.sin(start_heading_rad), math.cos(start_heading_rad)])
        self.anew = 0  # times the whole walk was turned
        self._first_rad = 0.0
        self._broken = False  # the bound, in the first contacts
        self._strangers = False
        self._strides: list[tuple[int, Step]] = []
        self._bias2 = [0.0, 0.0]  # the largest doubt so far about each gyro's bias, (rad/s)²
        self._from_start = after is None
        self._begin()
        if after is not None:
            self._contacts = FIRST_CONTACTS
            self._last[:] = after
            self._P = np.diag([AGAIN_M**2, AGAIN_M**2, AGAIN_RAD**2, 0.0] * 2)
            for side, step in enumerate(after):
                self._doubt_bias(side, step)

    def _begin(self) -> None:
        self.turns = (Turns(), Turns())
        self.turns[1].add(Turn(-1.0, 0.0, 1.0, self._first_rad, 0.0, 0.0, 0.0, 0.0))
        self._x = np.zeros(2 * _EACH)
        self._x[_EACH + _TURN] = self._first_rad
        self._P = np.zeros((2 * _EACH, 2 * _EACH))
        for side in (0, 1):
            self._doubt(side, START_M**2, START_RAD[side] ** 2)
            self._P[_EACH * side + _RATE, _EACH * side + _RATE] = self._bias2[side]
        self._begun2 = list(self._bias2)  # … as it was when the walk was last begun
        self._last: list[Step | None] = [None, None]
        self._since = [1, 1]  # the other's contacts since this foot's
        self._went_m = [0.0, 0.0]  # … and how far it went
        self._pairs: list[tuple[float, ...]] = []
        self._contacts, self._misfits, self._over_m = 0, 0, 0.0
        self._toes = 0j  # how much further clockwise the right toe points than the left, summed as e^iψ

    @property
    def linked(self) -> bool:
        """Whether the feet are held together now."""
        return self._contacts >= LEAST_CONTACTS and self._over_m < TOO_FAR_M and not self._strangers

    def take(self, side: int, step: Step) -> None:
        """One contact more, later than all before."""
        early = self._contacts < FIRST_CONTACTS
        broken = self._move(side, step)
        if not self._from_start or len(self._strides) >= MOST_ANEW:
            return
        self._strides.append((side, step))
        self._broken |= early and broken
        if early and self._broken:
            self._first_rad = _yaw_between(np.array(self._pairs))
            self._strangers = self._contacts == FIRST_CONTACTS and 2 * self._misfits > FIRST_CONTACTS
            self._first_rad *= not self._strangers
            self._anew()
        elif 0.0 < self._begun2[side] * ANEW_TIMES < self._bias2[side]:
            self._anew()
        else:
            self._begun2[side] = self._begun2[side] or self._bias2[side]

    def _anew(self) -> None:
        """All strides so far once more, by what is known now."""
        self._begin()
        for before in self._strides:
            self._move(*before)
        self.anew += 1

    def _move(self, side: int, step: Step) -> bool:
        """The filter over one stride; says whether the bound was broken at its end."""
        self._contacts += 1
        self._predict(side, step)
        other = 1 - side
        alternates = self._since[side] > 0
        self._since[side], self._went_m[side] = 0, 0.0
        self._since[other] += 1
        self._went_m[other] += step.length_m
        self._last[side] = step
        if step.gap_s > LOST_S:
            self._find(side)
        if alternates:
            self._toes += cmath.rect(1.0, self._heading(1) - self._heading(0))
        if self._contacts <= FIRST_CONTACTS:
            self._pairs.append((*self._place(0), *self._place(1)))
        broken = alternates and not self._strangers and self._bind(step)
        at, (north, east) = _EACH * side, step.place_n
        shift_north, shift_east, yaw = self._x[at : at + 3].tolist()
        self.turns[side].add(
            Turn(step.lift_row, step.contact_row, step.swing_s, yaw, shift_north, shift_east, north, east)
        )
        return broken

    def _place(self, side: int) -> tuple[float, float]:
        """The last footprint by the foot's own estimate."""
        last = self._last[side]
        return last.place_n if last else (0.0, 0.0)

    def _heading(self, side: int) -> float:
        """Which way a toe points."""
        last = self._last[side]
        return float(self._x[_EACH * side + _TURN]) + (last.heading_rad if last else 0.0)

    def _find(self, side: int) -> None:
        """A foot that was lost: beside the other, its toe as far from the other's as it used to be."""
        at, sign = _EACH * side, 1.0 if side else -1.0
        if not self._toes or self._last[1 - side] is None:
            return
        self._x[at : at + 2] -= sign * self._away()
        self._x[at + _TURN] += self._heading(1 - side) + sign * cmath.phase(self._toes) - self._heading(side)
        self._P[at : at + _RATE, :] = 0.0
        self._P[:, at : at + _RATE] = 0.0
        self._doubt(side, (0.5 * self.apart_m) ** 2, FOUND_RAD**2)

    def _predict(self, side: int, step: Step) -> None:
        """A stride, turned by half of what the turn grows in it."""
        at, (north, east), last = _EACH * side, self._place(side), self._last[side]
        begin_s = last.end_s if last else step.start_s
        dt_s = step.end_s - begin_s
        along = (step.place_n[0] - north, step.place_n[1] - east)
        yaw = float(self._x[at + _TURN] + 0.5 * dt_s * self._x[at + _RATE])
        c, s = math.cos(yaw), math.sin(yaw)
        turned = (c * along[0] - s * along[1], s * along[0] + c * along[1])
        self._x[at] += turned[0] - along[0]
        self._x[at + 1] += turned[1] - along[1]
        self._x[at + _TURN] += dt_s * self._x[at + _RATE]
        F = np.eye(2 * _EACH)
        F[at, at + _TURN], F[at + 1, at + _TURN] = -turned[1], turned[0]
        F[at : at + 2, at + _RATE] = 0.5 * dt_s * F[at : at + 2, at + _TURN]
        F[at + _TURN, at + _RATE] = dt_s
        self._doubt_bias(side, step)
        self._P[at + _RATE, at + _RATE] += step.bias_moved_radps**2 * dt_s / MOVES_S
        self._P = F @ self._P @ F.T
        far2, turn2 = STRIDE_M**2 + (STRIDE_SHARE * step.length_m) ** 2, WANDER_RADPS**2 * dt_s
        far2 += step.doubt_m2 - (last.doubt_m2 if last else 0.0)
        if self._since[side] > 1:  # strides of it were not seen: it may be anywhere the other went
            far2 += self._went_m[side] ** 2
        far2 += (GAP_SPEED * step.gap_s) ** 2
        turn2 += (GAP_TURN * step.gap_s) ** 2
        self._doubt(side, far2, turn2)

    def _doubt_bias(self, side: int, step: Step) -> None:
        """A gyro's bias that has moved about the axes that zero velocities tell may have about down."""
        bias2 = max(self._bias2[side], step.bias_doubt_radps**2, step.bias_moved_radps**2)
        self._P[_EACH * side + _RATE, _EACH * side + _RATE] += bias2 - self._bias2[side]
        self._bias2[side] = bias2

    def _doubt(self, side: int, far2_m2: float, turn2_rad2: float) -> None:
        at = _EACH * side
        self._P[at, at] += far2_m2
        self._P[at + 1, at + 1] += far2_m2
        self._P[at + _TURN, at + _TURN] += turn2_rad2

    def _bind(self, step: Step) -> bool:
        """The bound at a contact; says whether it was broken."""
        bound_m = max(self.apart_m, OF_A_STRIDE * step.length_m)
        spread2 = (0.5 * bound_m) ** 2
        away = self._away()
        self._over_m = math.hypot(*away) - bound_m
        if self._over_m <= 0.0:
            self._know(spread2)
            return False
        within = _APART @ self._P @ _APART.T + spread2 * np.eye(2)
        if away @ np.linalg.solve(within, away) > MOST_MISFIT:
            self._misfits += 1
            return True
        self._update(_APART, -away, spread2 * np.eye(2))
        away = self._away()
        far_m = math.hypot(*away)
        if far_m > bound_m:
            self._update(away[None] / far_m @ _APART, np.array([bound_m - far_m]), BOUND_M**2 * np.eye(1))
        self._over_m = math.hypot(*self._away()) - bound_m
        return True

    def _away(self) -> Floats:
        """From the left foot to the right."""
        left, right = np.array(self._place(0)), np.array(self._place(1))
        away: Floats = right + self.beside - left + _APART @ self._x
        return away

    def _know(self, spread2: float) -> None:
        """The bound holds: how far apart the feet are is known to no less than that."""
        values, vectors = np.linalg.eigh(_APART @ self._P @ _APART.T)
        for value, vector in zip(values, vectors.T, strict=True):
            if value > spread2:
                variance = 1.0 / (1.0 / spread2 - 1.0 / value)
                self._update(vector[None] @ _APART, np.zeros(1), variance * np.eye(1))

    def _update(self, H: Floats, left: Floats, variance: Floats) -> None:
        """One measurement, of which ``left`` is not explained."""
        S = H @ self._P @ H.T + variance
        K = np.linalg.solve(S, H @ self._P).T
        self._x = self._x + K @ left
        P = self._P - K @ S @ K.T
        self._P = 0.5 * (P + P.T)


#: What tells how far the right foot is from the left.
_APART = np.hstack([-np.eye(2, _EACH), np.eye(2, _EACH)])


def _yaw_between(pairs: Floats) -> float:
    """The least-squares yaw of the right foot's places onto the left's [k, 4], about the start."""
    left_north, left_east, north, east = pairs.T
    cosine = float(left_north @ north + left_east @ east)
    sine = float(north @ left_east - east @ left_north)
    return math.atan2(sine, cosine)
