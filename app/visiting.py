"""Heart: a visit to the town: samples and commands in, one picture a frame out. Time comes with each call.

A frame has three parts, so that nothing stands between a decision and the way it moves the walker:
``decide`` what the feet ask for, ``go`` there, and ``look`` at all there is to show, which can wait.
Two pairs of feet may be heard: the sensors', and simulated ones that the keys or the stroller move.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from statistics import median

from app.gestures import hunt as hunts
from app.gestures.setup import SetUpGuide
from app.gestures.steering import STOP, Comfort, Walker, steer
from app.gestures.stroll import Stroller, Wish
from app.gestures.words import Decision, standing
from app.hearing import Hearing, with_threshold
from app.motion.basics import MotionId, Role, role_of
from app.motion.commands import MoverCommand
from app.motion.samples import Sample
from app.simulate.gestures_live import LiveFeet
from app.simulate.gestures_options import GestureOptions
from app.visit import (
    SWITCHES,
    TUNABLE,
    ChooseDecoder,
    GoOn,
    Halt,
    NextVisitor,
    SetUp,
    Steer,
    Switch,
    Tune,
    Visit,
)
from app.world import Town

EYE_M, BOB_M, STEP_M = 1.65, 0.018, 0.7
#: Keys that a browser does not repeat are let go.
KEYS_NS = 350_000_000
#: After the last key the sensors, or the stroller, have the feet back.
TAKEN_NS, STROLL_NS = 2_000_000_000, 12_000_000_000
#: Nobody moves for so long: the next visitor; a warning before.
IDLE_S, WARNING_S = 75.0, 15.0
#: Another operator's "go on" so soon after a stop was pressed by somebody who had not seen it.
UNSEEN_NS = 700_000_000
STIRRING = ("moves", "step", "twist", "back", "taps")
FRESH = "the next visitor: stand still for a moment, then march"
AGAIN_S = 8.0  # after the last target the stroller begins anew
_WISHES = {
    "f": MotionId.FORWARD, "b": MotionId.BACKWARD, "l": MotionId.TURN_CCW, "r": MotionId.TURN_CW,
    "fl": MotionId.FORWARD_LEFT, "fr": MotionId.FORWARD_RIGHT, "ls": MotionId.SIDE_LEFT,
    "rs": MotionId.SIDE_RIGHT,
}  # fmt: skip


class Visiting:
    """One town, one visitor at a time. ``simulated``: there are no sensors, only simulated feet."""

    def __init__(
        self,
        town: Town,
        *,
        role_of: Callable[[str], Role] = role_of,
        name: str = "",
        decoder: str = "default",
        simulated: GestureOptions | None = None,
    ) -> None:
        self.town, self.name, self.simulated = town, name, simulated is not None
        self.sensors = Hearing(role_of)
        self._puppets = Hearing(role_of)
        self._live = LiveFeet(simulated or GestureOptions())
        self._stroller: Stroller | None = None
        self.switches = {key: at_first for key, (_, at_first, _) in SWITCHES.items()}
        self.tuning = {key: knob.default for key, knob in TUNABLE.items()}
        self.walker, self.hunt = Walker(), hunts.begin(town, Walker().north, Walker().east)
        self.decision = standing(0, "")
        self.guide: SetUpGuide | None = None
        self.message = ""
        self.trouble = ""  # of the sensors' lines, which keeps nobody from walking
        self.visitors: tuple[str, ...] = ()
        self.halted = False
        self._halted_ns = -UNSEEN_NS
        self._fresh = False  # the last visitor's gesture is not over yet
        self._swapped_before = False  # the set-up
        self._keys, self._keyed_ns = "", -STROLL_NS
        self._start_ns: int | None = None  # of the simulated feet's clock
        self._now_ns: int | None = None
        self._looked_ns: int | None = None
        self._fault, self._decided_ns = "", 0  # what was found then: a late look is no silence
        self._asked = self.decision  # by the feet, when it was last decided
        self._busy_ns: int | None = None  # when somebody last did something
        self._bob = self._depth = 0.0
        self._lags: deque[float] = deque(maxlen=60)
        self._lagged_ns: int | None = None
        if simulated is not None:
            self.tuning |= {"pace_hz": simulated.cadence_hz, "size": simulated.amplitude}
        self._choose(decoder)

    # --- in ---------------------------------------------------------------------------------------

    def take(self, sample: Sample) -> None:
        """A sensor's sample."""
        reading = self.sensors.take(sample)
        if reading is not None and self.guide is not None and not self._hindrance(sample.host_ns):
            self.guide.take(reading)

    def begin_anew(self) -> None:
        """The source starts again."""
        self.sensors.begin_anew()

    def obey(self, command: MoverCommand, now_ns: int) -> None:
        """What a person asks for; the shell sees to names of visitors."""
        match command:
            case Steer(keys):
                self._keys, self._keyed_ns = "".join(sorted(set(keys))), now_ns
                self._busy_ns = now_ns
            case Halt():
                self.halted, self._halted_ns = True, now_ns
            case GoOn():
                self.halted = self.halted and now_ns - self._halted_ns < UNSEEN_NS
            case NextVisitor():
                self.reset(now_ns)
            case SetUp(on):
                self._set_up(on)
            case ChooseDecoder(name):
                self._choose(name)
            case Tune(name, value):
                self._tune(name, value)
            case Switch(name, on):
                self.switches[name] = on
                if name == "swapped":
                    self.sensors.swap(on)

    def reset(self, now_ns: int) -> None:
        """The next visitor: at the start, nothing found, thresholds as they come."""
        self.walker = Walker()
        self.hunt = hunts.begin(self.town, self.walker.north, self.walker.east, self.hunt.best_s)
        self.guide, self.message, self._busy_ns = None, "", None
        self._fresh, self._start_ns, self._stroller = True, None, None
        self.sensors.intake.sided = False
        self.obey(Switch("swapped", False), now_ns)
        for name in ("on_radps", "sure_rad"):
            self._tune(name, TUNABLE[name].default)

    def _set_up(self, on: bool) -> None:
        """Begin with the feet as they are worn; who leaves it leaves all as it was."""
        swapped = self.sensors.intake.swapped
        if self.guide is None:
            self._swapped_before = swapped
        elif not on:
            swapped = self._swapped_before
        self.guide = SetUpGuide(self.sensors.settings) if on else None
        self.obey(Switch("swapped", swapped and not on), 0)

    def _hindrance(self, now_ns: int) -> str:
        """What keeps the set-up from listening to the feet, in words."""
        if self.halted:
            return "Stopped by the operator: this begins anew at Go on."
        if self._fault:
            return "A sensor was silent: this begins anew as soon as both are heard."
        if self._puppeteered(now_ns) and not self.simulated:
            return "The keys have taken over: this begins anew once they are let go."
        return ""

    def use(self, values: dict[str, float | bool]) -> None:
        """Thresholds of a visitor who was here before."""
        for name in ("on_radps", "sure_rad"):
            if name in values:
                self._tune(name, float(values[name]))
        self.obey(Switch("swapped", bool(values.get("swapped", False))), 0)

    def kept(self) -> dict[str, float | bool]:
        """What to keep of this visitor."""
        s = self.sensors.settings
        return {"on_radps": s.on_radps, "off_radps": s.off_radps, "sure_rad": s.sure_rad,
                "swapped": self.sensors.intake.swapped}  # fmt: skip

    # --- a frame ----------------------------------------------------------------------------------

    def step(self, now_ns: int) -> Visit:
        """The world at this instant of the host's clock: listen, decide, move, look."""
        self.decide(now_ns)
        self.go(now_ns)
        return self.look(now_ns)

    def decide(self, now_ns: int) -> None:
        """What to steer by from now on: what the feet ask for, unless a stop or a fault says otherwise."""
        self._move_puppets(now_ns)
        self.sensors.listen(now_ns)
        hearing = self._heard(now_ns)
        self._asked = hearing.decision
        self._fault, self._decided_ns = hearing.fault(now_ns), now_ns
        self.decision = self._judge(hearing, self._fault, now_ns)

    @property
    def news(self) -> bool:
        """Whether the feet have asked for something else since the last ``decide``."""
        return not self.simulated and self.sensors.decision is not self._asked

    def go(self, now_ns: int) -> tuple[Walker, float]:
        """Move by what was decided: where the walker is now, and how high the eye, m."""
        dt_s = 0.0 if self._now_ns is None else (now_ns - self._now_ns) * 1e-9
        self._now_ns = now_ns
        self.walker = steer(self.walker, self.decision, dt_s, self.town, self._comfort())
        self._nod(dt_s)
        self._note_lag(self._heard(now_ns), now_ns)
        return self.walker, self._eye_m()

    def look(self, now_ns: int) -> Visit:
        """What follows from where the walker is (targets, set-up, nobody there), and all there is to show."""
        dt_s = 0.0 if self._looked_ns is None else (now_ns - self._looked_ns) * 1e-9
        self._looked_ns = now_ns
        self._hunt(dt_s)
        self._go_on_with_guide()
        self._watch_idle(now_ns)
        return self._picture(self._heard(now_ns), self._fault, now_ns)

    def _heard(self, now_ns: int) -> Hearing:
        return self._puppets if self._puppeteered(now_ns) else self.sensors

    def _puppeteered(self, now_ns: int) -> bool:
        return self.simulated or now_ns - self._keyed_ns < TAKEN_NS

    def _judge(self, hearing: Hearing, fault: str, now_ns: int) -> Decision:
        """What to steer by: a stop and a sensor's fault go before everything."""
        if self.halted:
            return STOP._replace(t_ns=now_ns)
        if fault:
            return standing(now_ns, fault)
        if self.guide is not None:
            return standing(now_ns, "the set-up is under way")
        self._fresh = self._fresh and hearing.decision.motion is not MotionId.NONE
        return standing(now_ns, FRESH) if self._fresh else hearing.decision

    def _move_puppets(self, now_ns: int) -> None:
        """The simulated feet do what the keys or the stroller ask, as samples like any."""
        if not self._puppeteered(now_ns):
            self._start_ns = None
            return
        if self._start_ns is None:
            self._start_ns = now_ns
            self._live = LiveFeet(self._live.options)
            self._puppets.begin_anew()
        self._live.pace(self.tuning["pace_hz"], self.tuning["size"])
        wish = self._wish(now_ns)
        self._live.ask(wish.motion, wish.turn_size)
        for sample in self._live.advance((now_ns - self._start_ns) * 1e-9, self._start_ns, now_ns):
            reading = self._puppets.take(sample)
            if reading is not None and self.guide is not None and self.simulated and not self.halted:
                self.guide.take(reading)
        self._puppets.listen(now_ns)

    def _wish(self, now_ns: int) -> Wish:
        keyed = now_ns - self._keyed_ns
        if keyed < KEYS_NS and self._keys:
            keys = self._keys if self._keys in _WISHES else self._keys.replace("s", "")[:1]
            return Wish(_WISHES.get(keys, MotionId.NONE))
        strolls = self.simulated and self.switches["stroll"] and keyed >= STROLL_NS and self.guide is None
        if not strolls:
            return Wish(MotionId.NONE)
        self._stroller = self._stroller or Stroller(self.town)
        w = self.walker
        return self._stroller.wish(w.north, w.east, w.heading_rad, self.hunt.target)

    def _hunt(self, dt_s: float) -> None:
        w = self.walker
        self.hunt = hunts.go_on(self.hunt, w.north, w.east, not w.at_rest, dt_s)
        over = self.hunt.target is None and self.hunt.seconds - self.hunt.reached_s > AGAIN_S
        if over and self.simulated and self.switches["stroll"]:
            self.hunt = hunts.begin(self.town, w.north, w.east, self.hunt.best_s)

    def _nod(self, dt_s: float) -> None:
        """The head rises and sinks once a step, softly in and out."""
        speed = math.hypot(self.walker.ahead_mps, self.walker.right_mps)
        wanted = BOB_M * min(1.0, speed / 1.0) if self.switches["bob"] else 0.0
        self._depth += (wanted - self._depth) * min(1.0, 2.5 * dt_s)
        self._bob = math.remainder(self._bob + math.tau * min(speed, 2.0) / STEP_M * dt_s, math.tau)

    def _eye_m(self) -> float:
        return round(EYE_M + self._depth * math.sin(self._bob), 4)

    def _go_on_with_guide(self) -> None:
        hindrance = self._hindrance(self._decided_ns)
        if self.guide is not None and hindrance:
            self.guide.wait(hindrance)
        if self.guide is None or not self.guide.over or self.guide.fitted is None:
            return
        fitted, self.guide = self.guide.fitted, None
        self.sensors.intake.sided = True
        self.use({**vars(fitted.settings), "swapped": fitted.swapped})

    def _watch_idle(self, now_ns: int) -> None:
        """Nobody moves, but somebody had begun: the next visitor finds the start."""
        moves = self.decision.motion is not MotionId.NONE
        if self._busy_ns is not None:
            stirs = any(f.state in STIRRING for f in self._heard(now_ns).lights(self._decided_ns))
            moves = moves or stirs or self.halted
        if moves or (self.guide is not None and self._busy_ns is None):
            self._busy_ns = now_ns
        if self._idle_s(now_ns) >= IDLE_S:
            self.reset(now_ns)

    def _idle_s(self, now_ns: int) -> float:
        return 0.0 if self._busy_ns is None else (now_ns - self._busy_ns) * 1e-9

    def still(self, now_ns: int, message: str) -> Visit:
        """The start, with nobody walking: what is shown while the program prepares."""
        return replace(self._picture(self.sensors, "", now_ns), message=message)

    # --- out --------------------------------------------------------------------------------------

    def _picture(self, hearing: Hearing, fault: str, now_ns: int) -> Visit:
        w, d = self.walker, self.decision
        left = IDLE_S - self._idle_s(now_ns)
        return Visit(
            t_s=now_ns * 1e-9, north=w.north, east=w.east, heading_rad=w.heading_rad,
            eye_m=self._eye_m(),
            speed_mps=math.hypot(w.ahead_mps, w.right_mps), turn_radps=w.turn_radps, motion=d.motion,
            certain=d.certain, confidence=d.confidence, cadence_hz=d.cadence_hz, reason=d.reason,
            feet=hearing.lights(self._decided_ns), fault=fault,
            message=self.message or self.trouble or hearing.intake.note(),
            halted=self.halted, touching=w.touching,
            goal=hunts.goal(self.hunt, w.north, w.east), score=self.hunt.found,
            targets=len(self.hunt.order), hunt_s=self.hunt.seconds, best_s=self.hunt.best_s,
            reached=self.hunt.found > 0 and self.hunt.cheering,
            task=None if self.guide is None else self.guide.task, decoder=hearing.name,
            feet_from=self._feet_from(now_ns), simulated=self._puppeteered(now_ns),
            latency_ms=median(self._lags) if self._lags else None, idle_s=left if left < WARNING_S else None,
            tuning=self.tuning, switches=self.switches, visitors=self.visitors, machines=hearing.machines(),
        )  # fmt: skip

    def _feet_from(self, now_ns: int) -> str:
        if self.simulated:
            return "simulated feet"
        return "the keys have taken over" if self._puppeteered(now_ns) else self.name

    def _note_lag(self, hearing: Hearing, now_ns: int) -> None:
        """Of the newest sample when a frame first shows it: the median of the last second is told."""
        newest = hearing.newest_host_ns
        if newest is not None and newest != self._lagged_ns:
            self._lagged_ns = newest
            self._lags.append((now_ns - newest) * 1e-6)

    def _comfort(self) -> Comfort:
        return Comfort(start_mps2=self.tuning["start_mps2"], most_mps=self.tuning["most_mps"])

    def _choose(self, name: str) -> None:
        for hearing in (self.sensors, self._puppets):
            hearing.choose(name)

    def _tune(self, name: str, value: float) -> None:
        knob = TUNABLE.get(name)
        if knob is None or not math.isfinite(value):
            return
        self.tuning = {**self.tuning, name: value}
        settings = self.sensors.settings
        if name == "on_radps":
            settings = with_threshold(settings, value)
        elif hasattr(settings, name):
            settings = replace(settings, **{name: value})
        for hearing in (self.sensors, self._puppets):
            hearing.tune(settings)
