"""Heart: leads a person through a calibration: fed with samples, says what to do and what was found."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from app.calibration import ellipsoid, report, turns
from app.calibration.steps import FIELD_STEPS, STEPS, Step, pose_words
from app.calibration.still import Pose, Stillness
from app.calibration.words import Calibration, Correction, correction
from app.motion.basics import G_MPS2, Floats
from app.motion.samples import GAP_NS, Sample
from app.motion.status import GuideView

#: A pose is held until its mean is known so well (0.2 mg: the poses together tell the null to 0.3 mg), but no
#: shorter and no longer than this.
DOUBT_MPS2 = 0.002
HOLD_S, MOST_HOLD_S = 1.5, 3.5
#: The axis may lean so far and still be called down: the table need not be level to a degree.
UPRIGHT = math.cos(math.radians(25.0))
#: Of a whole round, so much must be made.
ROUND_RAD = math.radians(320.0)
#: Readings kept of one turn, and of the field's directions.
MOST, MOST_FIELDS = 60_000, 6_000
#: A reading of the field is kept when it differs from the last by this share.
FIELD_STEP = 0.02
#: From so much of all directions the skew of the magnetometer's axes can be told too.
ENOUGH_COVERAGE = 0.45


@dataclass
class Way:
    """The readings from one pose to the next."""

    stamps_ns: list[int] = field(default_factory=list)
    rates: list[tuple[float, float, float]] = field(default_factory=list)
    fields: list[tuple[float, float, float]] = field(default_factory=list)
    broken: str = ""

    def add(self, sample: Sample) -> None:
        """One more; a hole in it, or an hour of it, spoils it."""
        if self.stamps_ns and not 0 < sample.device_ns - self.stamps_ns[-1] <= GAP_NS:
            self.broken = "samples were lost"
        if sample.saturation & 0b111000:
            self.broken = "the gyro was at the end of its range: turn more slowly"
        if len(self.rates) >= MOST:
            self.broken = "it took too long"
            return
        self.stamps_ns.append(sample.device_ns)
        self.rates.append(sample.angular_rate_b)
        if sample.field_b is not None:
            self.fields.append(sample.field_b)

    def steps_s(self) -> Floats:
        """Seconds between the readings, [n − 1]."""
        return np.diff(np.array(self.stamps_ns, np.int64)).astype(np.float64) * 1e-9


class Leg(NamedTuple):
    """A step that was done: its way and the pose it led to."""

    step: Step
    way: Way
    pose: Pose


class Guide:
    """One sensor's calibration. ``add`` takes its samples as they come, uncorrected."""

    def __init__(self, sensor: str) -> None:
        self.sensor = sensor
        self.legs: list[Leg] = []
        self._steps: tuple[Step, ...] = STEPS + FIELD_STEPS
        self._still = Stillness()
        self._way = Way()
        self._angle = [0.0, 0.0, 0.0]  # rad, of this way
        self._pose: Pose | None = None
        self._said = ""
        self._fields: list[tuple[float, float, float]] = []

    @property
    def done(self) -> bool:
        """Whether every step is done."""
        return len(self.legs) == len(self._steps)

    def add(self, sample: Sample) -> None:
        """One sample."""
        if self.done:
            return
        if self.legs:  # to the first pose leads no turn, however long it takes
            self._way.add(sample)
        self._turn(sample)
        self._note_field(sample)
        self._pose = self._still.add(sample)
        if self._pose is not None:
            self._judge(self._pose)

    def _turn(self, sample: Sample) -> None:
        stamps = self._way.stamps_ns
        if len(stamps) > 1 and self.legs:
            step_s = min((stamps[-1] - stamps[-2]) * 1e-9, GAP_NS * 1e-9)
            null = self.legs[0].pose.rate
            for i, rate in enumerate(sample.angular_rate_b):
                self._angle[i] += (rate - null[i]) * step_s

    def _note_field(self, sample: Sample) -> None:
        now = sample.field_b
        if now is None or len(self._fields) >= MOST_FIELDS:
            return
        if self._fields:
            last = self._fields[-1]
            away = math.dist(now, last)
            if away < FIELD_STEP * max(math.hypot(*now), math.hypot(*last), 1e-9):
                return
        self._fields.append(now)

    def _judge(self, pose: Pose) -> None:
        """A still time: the step's end, or another pose than it should be."""
        step = self._steps[len(self.legs)]
        self._said = ""
        if pose.upright < UPRIGHT:
            self._said = "It lies askew: rest it on one side."
        elif pose.down != (step.down, step.sign):
            if not self.legs or pose.down != self.legs[-1].pose.down:
                self._said = f"Now {pose_words(*pose.down)}; {pose_words(step.down, step.sign)} is wanted."
        elif step.round and abs(self._angle[step.axis]) < ROUND_RAD:
            if abs(self._angle[step.axis]) > 0.5:
                turned = math.degrees(abs(self._angle[step.axis]))
                self._said = f"Turned {turned:.0f}° about {'xyz'[step.axis]}: all the way round, please."
        elif held(pose) >= 1.0:
            self._finish(step, pose)

    def _finish(self, step: Step, pose: Pose) -> None:
        if not self.legs and pose.field is None:
            self._steps = STEPS
        self.legs.append(Leg(step, self._way, pose))
        self._way, self._angle = Way(), [0.0, 0.0, 0.0]
        if not self.done:
            self._still = Stillness()

    def back(self) -> None:
        """Do the last step once more."""
        if self.legs:
            self.legs.pop()
            self._way, self._angle, self._still, self._said = Way(), [0.0, 0.0, 0.0], Stillness(), ""
            if self.legs:
                self._way.broken = "the step before was made again"

    # --- what a person sees ------------------------------------------------------------------------

    def view(self) -> GuideView:
        """The step under way and how far it is."""
        number = len(self.legs)
        step = self._steps[min(number, len(self._steps) - 1)]
        part = 0.0
        if self._pose is not None and not self._said and self._right(step, self._pose):
            part = held(self._pose)
        return GuideView(
            sensor=self.sensor,
            step=number,
            steps=len(self._steps),
            words="Done." if self.done else step.words,
            picture=step.picture,
            held=1.0 if self.done else part,
            note=self._said or self._broken(),
            coverage=coverage(np.array(self._fields)) if len(self._fields) > 3 else 0.0,
            directions=_directions(self._fields),
            done=self.done,
        )

    def _right(self, step: Step, pose: Pose) -> bool:
        turned = not step.round or abs(self._angle[step.axis]) >= ROUND_RAD
        return pose.down == (step.down, step.sign) and turned

    def _broken(self) -> str:
        way = self._way if self._way.broken else self.legs[-1].way if self.legs else self._way
        return f"The turn to this pose counts less: {way.broken}." if way.broken else ""

    # --- what was found ----------------------------------------------------------------------------

    def results(
        self, made: str, gravity_mps2: float = G_MPS2, field_ut: float | None = None
    ) -> tuple[Calibration, Calibration]:
        """The fits and the report's formulas. ``field_ut``: the field's true strength where it is known.

        Raises ``ValueError`` in words where the readings do not allow it.
        """
        return self._fitted(made, gravity_mps2, field_ut), self._reported(made, gravity_mps2, field_ut)

    def _fitted(self, made: str, gravity_mps2: float, field_ut: float | None) -> Calibration:
        poses = [leg.pose for leg in self.legs]
        forces = np.array([pose.force for pose in poses])
        centre, shape, left = ellipsoid.fit(forces, gravity_mps2, skew=False)
        force = correction(centre, shape)
        rates = np.array([pose.rate for pose in poses])
        null = np.median(rates, axis=0)
        scale, missed = turns.fit(self._turns(force.table(forces)), null)
        residuals = {
            "force rms m/s²": left,
            "gyro null scatter rad/s": float(np.std(rates - null, axis=0).max()),
            "turns missed rms rad": missed,
        }
        field_correction = None
        if len(self._steps) > len(STEPS):
            field_correction, left = self._field(field_ut)
            residuals["field rms µT"] = left
        return Calibration(
            self.sensor, made, "fit", force, correction(null, scale), field_correction, residuals
        )

    def _turns(self, forces: Floats) -> list[turns.Turn]:
        return [
            turns.Turn(before, after, np.array(leg.way.rates), leg.way.steps_s())
            for before, after, leg in zip(forces, forces[1:], self.legs[1:], strict=False)
            if not leg.way.broken and len(leg.way.rates) > 1
        ]

    def _field(self, field_ut: float | None) -> tuple[Correction, float]:
        fields = np.array(self._fields)
        skew = coverage(fields) >= ENOUGH_COVERAGE
        centre, shape, left = ellipsoid.fit(fields, 1.0, skew)
        length = field_ut or float(np.mean(np.linalg.norm(fields - centre, axis=1)))
        return correction(centre, shape * length), left * length

    def _reported(self, made: str, gravity_mps2: float, field_ut: float | None) -> Calibration:
        highest, lowest = np.zeros(3), np.zeros(3)
        for leg in self.legs[: len(STEPS)]:
            axis, sign = leg.step.down, leg.step.sign
            (lowest if sign > 0 else highest)[axis] = leg.pose.force[axis]
        force = correction(report.null(highest, lowest), report.scale(highest, lowest, gravity_mps2))
        null = np.array(self.legs[0].pose.rate)
        found: list[list[float]] = [[], [], []]
        for leg in self.legs[1 : len(STEPS)]:
            if not leg.way.broken:
                turned = report.turned(np.array(leg.way.rates), leg.way.steps_s(), null)[leg.step.axis]
                found[leg.step.axis].append(report.turn_scale(math.radians(leg.step.degrees), turned))
        rate = correction(null, np.array([float(np.mean(scales)) if scales else 1.0 for scales in found]))
        return Calibration(self.sensor, made, "report", force, rate, self._reported_field(field_ut))

    def _reported_field(self, field_ut: float | None) -> Correction | None:
        """The extremes of x from the round about y, of y and z from the round about x (steps 15 to 17)."""
        rounds = {leg.step.axis: leg.way.fields for leg in self.legs if leg.step.round}
        if len(rounds) < 2 or min(map(len, rounds.values())) < 50:
            return None
        about_y, about_x = (report.extremes(np.array(rounds[axis])) for axis in (1, 0))
        highest = np.array([about_y[0][0], *about_x[0][1:]])
        lowest = np.array([about_y[1][0], *about_x[1][1:]])
        length = field_ut or float(np.mean(highest - lowest) / 2.0)
        return correction(report.null(highest, lowest), report.scale(highest, lowest, length))


def held(pose: Pose) -> float:
    """How much of the time that a pose needs has passed, 0 to 1: a noisy or slow sensor needs longer."""
    known = (DOUBT_MPS2 / max(pose.doubt_mps2, 1e-9)) ** 2  # the standard error falls with the root of time
    return min(max(min(pose.seconds / HOLD_S, known), pose.seconds / MOST_HOLD_S), 1.0)


# --- coverage ------------------------------------------------------------------------------------

BANDS, SECTORS = 6, 12


def cells(fields: Floats) -> Floats:
    """Which of 72 equal parts of all directions each field [n, 3] points into, from their middle."""
    middle = (fields.max(axis=0) + fields.min(axis=0)) / 2.0
    away = fields - middle
    lengths = np.maximum(np.linalg.norm(away, axis=1), 1e-12)
    band = np.clip(((away[:, 2] / lengths + 1.0) / 2.0 * BANDS).astype(int), 0, BANDS - 1)
    sector = ((np.arctan2(away[:, 1], away[:, 0]) / math.tau + 0.5) * SECTORS).astype(int) % SECTORS
    return np.asarray(band * SECTORS + sector)


def coverage(fields: Floats) -> float:
    """Part of all directions that was seen, 0 to 1."""
    return len(np.unique(cells(fields))) / (BANDS * SECTORS)


def _directions(fields: list[tuple[float, float, float]]) -> frozenset[int]:
    return frozenset(cells(np.array(fields)).tolist()) if len(fields) > 3 else frozenset()
