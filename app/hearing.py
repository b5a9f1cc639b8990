"""Heart: two feet being listened to: samples in, what they ask for out, with the machines to look at."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from app.blocks import BLOCK, Blocks
from app.estimator.tracker import Tracker
from app.gestures.default import DefaultDecoder, DefaultSettings
from app.gestures.intake import Intake
from app.gestures.machines import FootNow, History, feet_now, thresholds
from app.gestures.papers import PapersDecoder
from app.gestures.words import FEET, SILENCE_NS, UNKNOWN_Q, FootReading, standing
from app.motion.basics import Quaternion, Role
from app.motion.estimate import ATTITUDE
from app.motion.samples import SAMPLE_WIDTH, Sample
from app.settings import Settings
from app.visit import FootLight, Machines

#: So long after a reading that is no number a foot is called faulty.
RUBBISH_NS = 300_000_000


class Attitude:
    """One foot's orientation, by the papers' estimator: only the papers' decoder looks at it."""

    def __init__(self) -> None:
        self._tracker, self._samples = Tracker(Settings()), Blocks(SAMPLE_WIDTH)
        self._start_ns: int | None = None

    def take(self, reading: FootReading) -> Quaternion:
        """The orientation after this sample."""
        if not math.isfinite(sum(reading.specific_force_b) + sum(reading.angular_rate_b)):
            return UNKNOWN_Q
        self._start_ns = reading.t_ns if self._start_ns is None else self._start_ns
        nothing = (math.nan,) * 3
        row = (reading.t_ns - self._start_ns, *reading.specific_force_b, *reading.angular_rate_b, *nothing)
        self._samples.extend(np.array([row], dtype=np.float64))
        self._tracker.advance(self._samples)
        if len(self._samples) > 2 * BLOCK:
            self._samples.drop_oldest()
            self._tracker.drop_oldest()
        block, place = self._tracker.rows.block(self._tracker.rows.end - 1)
        w, x, y, z = block[place, ATTITUDE].tolist()
        return w, x, y, z


class Hearing:
    """One pair of feet, one decoder."""

    def __init__(self, role_of: Callable[[str], Role]) -> None:
        self.intake = Intake(role_of)
        self.decoder: DefaultDecoder | PapersDecoder = DefaultDecoder()
        self.settings = DefaultSettings()
        self.decision = standing(0, "")
        self._attitudes = {role: Attitude() for role in FEET}
        self._history = History()
        self._rates = [0.0, 0.0]
        self._rubbish_ns = dict.fromkeys(FEET, -RUBBISH_NS)
        self.newest_host_ns: int | None = None

    def take(self, sample: Sample) -> FootReading | None:
        """One sample; the reading it became, for whoever listens too."""
        reading = self.intake.take(sample)
        if reading is None:
            return None
        self.newest_host_ns = sample.host_ns
        rate = math.hypot(*reading.angular_rate_b)
        if math.isfinite(rate + math.fsum(reading.specific_force_b)):
            which = FEET.index(reading.foot)
            self._rates[which] = max(self._rates[which], rate)
        else:
            self._rubbish_ns[reading.foot] = sample.host_ns
        if isinstance(self.decoder, PapersDecoder):
            reading = reading._replace(q_nb=self._attitudes[reading.foot].take(reading))
        self.decision = self.decoder.take(reading) or self.decision
        return reading

    def listen(self, host_ns: int) -> None:
        """Time has passed: silence is heard, and the machines are written down."""
        now_ns = self.intake.now_ns(host_ns)
        if self.newest_host_ns is not None:
            self.decision = self.decoder.watch(now_ns) or self.decision
        if self._history.add(host_ns * 1e-9, (self._rates[0], self._rates[1]), feet_now(self.decoder)):
            self._rates = [0.0, 0.0]

    def choose(self, name: str) -> None:
        """Another decoder, from rest."""
        self.decoder = PapersDecoder() if name == "papers" else DefaultDecoder(self.settings)
        self._attitudes = {role: Attitude() for role in FEET}
        self.decision = standing(0, "")

    def tune(self, settings: DefaultSettings) -> None:
        """Other thresholds for the default decoder."""
        self.settings = settings
        if isinstance(self.decoder, DefaultDecoder):
            self.decoder.tune(settings)

    def swap(self, on: bool) -> None:
        """The left sensor is on the right foot, or not; the decoder starts from rest."""
        if on != self.intake.swapped:
            self.intake.swapped = on
            self.choose(self.name)

    def begin_anew(self) -> None:
        """The source starts again."""
        swapped = self.intake.swapped
        self.intake.begin_anew()
        self.intake.swapped = swapped
        self.choose(self.name)

    @property
    def name(self) -> str:
        """Of the decoder."""
        return "papers" if isinstance(self.decoder, PapersDecoder) else "default"

    def fault(self, host_ns: int) -> str:
        """What keeps the camera at rest, in words."""
        bad = [role for role in FEET if host_ns - self._rubbish_ns[role] < RUBBISH_NS]
        if bad:
            return f"the {bad[0].value} foot's sensor sends readings that cannot be"
        return self.intake.fault(host_ns)

    def lights(self, host_ns: int) -> tuple[FootLight, FootLight]:
        """Both feet as the page shows them."""
        left, right = (
            self._light(role, now, host_ns) for role, now in zip(FEET, feet_now(self.decoder), strict=True)
        )
        return left, right

    def machines(self) -> Machines | None:
        """The last seconds."""
        return self._history.machines(thresholds(self.decoder))

    def _light(self, role: Role, now: FootNow, host_ns: int) -> FootLight:
        sensor = self.intake.sensor(role)
        word = now.word
        if sensor.heard_ns is None:
            word = "missing"
        elif host_ns - self._rubbish_ns[role] < RUBBISH_NS:
            word = "rubbish"
        elif host_ns - sensor.heard_ns > SILENCE_NS:
            word = "silent"
        return FootLight(role, word, now.size, sensor.rate_hz)


def with_threshold(settings: DefaultSettings, on_radps: float) -> DefaultSettings:
    """A foot begins above this rate and ends below half of it."""
    return replace(settings, on_radps=on_radps, off_radps=0.5 * on_radps)
