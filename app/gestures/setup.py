"""Heart: the guided set-up of a new visitor: stand, march, turn left and right, step aside; 20 seconds.

It listens with a sensitive decoder of its own, learns how large this visitor's actions are and how
still their feet stand, sets the thresholds between, and checks that left is left.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from app.gestures.default import DefaultDecoder, DefaultSettings
from app.gestures.words import FootReading
from app.motion.basics import Role
from app.visit import Task

_SENSITIVE = replace(DefaultSettings(), on_radps=0.35, off_radps=0.18, sure_rad=0.05)


class Step(NamedTuple):
    """One thing to do: its name, how long, what is said, how many actions are enough to go on early."""

    name: str
    seconds: float
    title: str
    words: str
    enough: int


STEPS = (
    Step("stand", 3.0, "Stand still", "Both feet on the floor.", 0),
    Step("march", 5.0, "March in place", "Lift one foot after the other, as you like to walk.", 8),
    Step("left", 4.0, "Turn left", "Twist your left foot out and back; keep the right one still.", 3),
    Step("right", 4.0, "Turn right", "Twist your right foot out and back; keep the left one still.", 3),
    Step("aside", 4.0, "Step aside", "Lift only your right foot, out and back.", 3),
)
#: The steps that one foot does alone (0 left), by which it is found out which sensor is on which foot.
ONE_SIDED = {"left": 0, "right": 1, "aside": 1}
_FEWEST = 2  # actions of a step that was done
_SHAKY_RADPS = 0.6  # nobody who stands still turns a foot so fast
_DONE_S = 3.0


class Action(NamedTuple):
    """What a foot did once: which foot (0 left), how far, how fast at most."""

    foot: int
    size_rad: float
    rate_radps: float


@dataclass(frozen=True)
class Fitted:
    """What the set-up found."""

    settings: DefaultSettings
    swapped: bool  # the left sensor is on the right foot
    words: str


@dataclass
class SetUpGuide:
    """Feed readings, look at ``task``; ``fitted`` holds the result once all is done."""

    before: DefaultSettings
    fitted: Fitted | None = None
    over: bool = False
    _decoder: DefaultDecoder = field(default_factory=lambda: DefaultDecoder(_SENSITIVE))
    _number: int = 0
    _began_ns: int | None = None
    _now_ns: int = 0
    _note: str = ""
    _asked_again: bool = False  # whether left is left
    _rest_radps: float = 0.0
    _seen: list[float] = field(default_factory=lambda: [-1e9, -1e9])
    _actions: dict[str, list[Action]] = field(default_factory=lambda: {step.name: [] for step in STEPS})

    def take(self, reading: FootReading) -> None:
        """One sample of either foot, in the order of time."""
        if not all(map(math.isfinite, (*reading.angular_rate_b, *reading.specific_force_b))):
            return
        self._began_ns = reading.t_ns if self._began_ns is None else self._began_ns
        self._now_ns = max(self._now_ns, reading.t_ns)
        self._decoder.take(reading)
        if self.fitted is not None:
            self.over = self._passed_s() > _DONE_S
            return
        self._listen(0 if reading.foot is Role.LEFT else 1, math.hypot(*reading.angular_rate_b))
        self._go_on()

    def wait(self, why: str) -> None:
        """The feet are not listened to now: what was under way begins anew with the next reading."""
        if self.fitted is None:
            self._again(why)
            self._began_ns = None

    @property
    def task(self) -> Task:
        """What to show."""
        count = len(STEPS)
        if self.fitted is not None:
            return Task("Ready", self.fitted.words, 1.0, count, count, True, "Walk to the light.")
        step = STEPS[self._number]
        part = min(1.0, self._passed_s() / step.seconds)
        return Task(step.title, step.words, part, self._number + 1, count, None, self._note)

    def _passed_s(self) -> float:
        return 0.0 if self._began_ns is None else (self._now_ns - self._began_ns) * 1e-9

    def _listen(self, which: int, rate_radps: float) -> None:
        step, foot = STEPS[self._number], self._decoder.foot(which)
        if step.name == "stand":
            if self._passed_s() > 0.5:
                self._rest_radps = max(self._rest_radps, rate_radps)
            return
        ended = float(foot["end_s"])
        if ended > self._seen[which] and foot["moving"] == 0.0:
            self._seen[which] = ended
            action = Action(which, float(foot["size"]), float(foot["rate_peak"]))
            self._actions[step.name].append(action)

    def _go_on(self) -> None:
        step = STEPS[self._number]
        done = len(self._actions[step.name])
        early = step.enough and done >= step.enough and self._passed_s() > 0.5 * step.seconds
        if not early and self._passed_s() < step.seconds:
            return
        if step.name == "stand" and self._rest_radps > _SHAKY_RADPS:
            self._again("That was not still: stand with both feet on the floor.")
        elif step.name != "stand" and done < _FEWEST:
            self._again("Nothing was heard: do it once more, a little larger.")
        else:
            self._number, self._note, self._began_ns = self._number + 1, "", self._now_ns
        if self._number == len(STEPS):
            self._number -= 1
            self._end()

    def _end(self) -> None:
        """Fit, or ask once more where the one-sided steps do not tell the feet apart."""
        wrong, right = self._sides()
        if wrong < right or wrong == len(ONE_SIDED) or self._asked_again:
            self.fitted = self._fit()
            return
        self._asked_again = True
        for name in ONE_SIDED:
            self._actions[name].clear()
        self._number = [step.name for step in STEPS].index("left")
        self._note = "Left and right did not agree: once more, with the foot that is named."

    def _again(self, note: str) -> None:
        self._note, self._began_ns, self._rest_radps = note, self._now_ns, 0.0
        self._actions[STEPS[self._number].name].clear()

    def _fit(self) -> Fitted:
        """Between rest and the smallest third of the visitor's own actions."""
        wrong, right = self._sides()
        swapped = wrong == len(ONE_SIDED)
        actions = [action for done in self._actions.values() for action in done]
        sizes = sorted(action.size_rad for action in actions if action.size_rad > 0.0)
        rates = sorted(action.rate_radps for action in actions if action.rate_radps > 0.0)
        small, slow = sizes[len(sizes) // 5], rates[len(rates) // 5]
        on = min(max(0.25 * slow, 2.5 * self._rest_radps, 0.25), 0.6 * slow, 1.5)
        sure = min(max(0.25 * small, 0.035), 0.2)
        settings = replace(
            self.before, on_radps=round(on, 3), off_radps=round(0.5 * on, 3), sure_rad=round(sure, 3)
        )
        said = f"A foot moves above {settings.on_radps:.2f} rad/s and {math.degrees(settings.sure_rad):.0f}°."
        turned = " Left is left." if right > wrong else " Left or right is not clear: kept as they were."
        if swapped:
            turned = " Left and right were swapped: put right here."
        return Fitted(settings, swapped, said + turned)

    def _sides(self) -> tuple[int, int]:
        """How many one-sided steps the wrong foot did most of, and how many the right one.

        Feet are swapped only where all three say so: one action done with the other foot, or two, never
        turn sound feet about.
        """
        wrong = right = 0
        for name, foot in ONE_SIDED.items():
            wanted = sum(action.foot == foot for action in self._actions[name])
            other = len(self._actions[name]) - wanted
            wrong += other > wanted
            right += wanted > other
        return wrong, right
