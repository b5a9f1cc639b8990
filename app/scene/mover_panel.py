"""Edge, scene: the town's panel for its operator: stop, next visitor, set-up, decoder, sliders, figures."""

from __future__ import annotations

import time
from functools import partial

from app.motion.commands import Command
from app.motion.door import GuiRule
from app.scene import words
from app.scene.beat import beat
from app.scene.controls import Ask, Controls, Input
from app.scene.hud import MOTIONS
from app.visit import (
    SWITCHES,
    TUNABLE,
    ChooseDecoder,
    GoOn,
    Halt,
    LoadVisitor,
    NextVisitor,
    SaveVisitor,
    SetUp,
    Steer,
    Switch,
    Tune,
    Visit,
)

WIDTH_PX = 340
DECODERS = ("default", "papers")
STOP, GO, NEXT, GUIDE, LEAVE = "Stop", "Go on", "Next visitor", "Set up", "Leave set-up"
SAVE = "Save visitor"
_NOBODY = "–"
KEYS = (
    ("↑ ↓ ← →", "steer simulated feet; Shift with ← →: aside"), ("Esc", "stop"), ("Space", "go on"),
    ("N", "next visitor"), ("U", "set up a visitor"), ("F", "full screen"), ("H", "hide all words"),
)  # fmt: skip


class MoverPanel:
    """All inputs of the town mode."""

    def __init__(self, controls: Controls) -> None:
        gui = controls.gui
        gui.main_panel.float(x=-12, y=12, width=WIDTH_PX)
        self._controls = controls
        self._hud, self._header = controls.html(), controls.html()
        asks: dict[str, Ask] = {STOP: Halt, GO: GoOn, NEXT: NextVisitor}
        self.buttons = controls.choice("Visit", asks)
        guide: dict[str, Ask] = {GUIDE: partial(SetUp, True), LEAVE: partial(SetUp, False)}
        self.guide = controls.choice("New visitor", guide, "Twenty seconds: stand, march, turn, step aside.")
        self.keys = controls.text("Keys", _steer, longest=12)
        self.keys.handle.visible = False
        self._figures = controls.html()
        self._sliders: dict[str, Input] = {}
        self._switches: dict[str, Input] = {}
        self._visitor = ""  # the name typed so far
        self._more(controls)

    def _more(self, controls: Controls) -> None:
        gui = controls.gui
        with gui.add_folder("View and feet"):
            for name, (label, at_first, sentence) in SWITCHES.items():
                self._switches[name] = controls.checkbox(label, partial(_switch, name), at_first, sentence)
        with gui.add_folder("Thresholds and comfort", expand_by_default=False):
            hint = "default: ours; papers: the dissertation's machines."
            self._decoder = controls.dropdown("Decoder", DECODERS, ChooseDecoder, hint)
            for name, knob in TUNABLE.items():
                rule = GuiRule("number", knob.low, knob.high)
                self._sliders[name] = controls.slider(
                    f"{knob.label}, {knob.unit}", rule, partial(Tune, name), min=knob.low, max=knob.high,
                    step=0.01, initial_value=knob.default, hint=knob.sentence,
                )  # fmt: skip
        with gui.add_folder("Visitors", expand_by_default=False):
            controls.text("Name", self._typed, "Under which this visitor's thresholds are kept.", 40)
            controls.choice("", {SAVE: self._save})
            self._who = controls.dropdown("Load", (_NOBODY,), _load, "Thresholds kept before.")
        with gui.add_folder("Keys", expand_by_default=False):
            rows = "".join(f"<tr><th><kbd>{key}</kbd></th><td>{what}</td></tr>" for key, what in KEYS)
            gui.add_html(f'<table class="ss-table ss-keys">{rows}</table>')

    def presses(self) -> dict[str, tuple[str, str]]:
        """Which control a key presses, and with what value."""
        return {
            "escape": (self.buttons.id, STOP), " ": (self.buttons.id, GO), "n": (self.buttons.id, NEXT),
            "u": (self.guide.id, GUIDE),
        }  # fmt: skip

    def _typed(self, name: str) -> None:
        self._visitor = name.strip()

    def _save(self) -> Command:
        return SaveVisitor(self._visitor)

    def show_hud(self, data: str) -> None:
        """What our own script reads."""
        self._hud.show(data)

    def show(self, visit: Visit) -> None:
        """Words and figures: at most ten times a second."""
        self._header.show(header(visit) + beat(time.time()))
        self._figures.show(figures(visit))
        self._decoder.show(visit.decoder)
        for name, slider in self._sliders.items():
            value = visit.tuning.get(name, TUNABLE[name].default)
            self._controls.widen(slider, value, value)
            slider.show(value)
        for name, box in self._switches.items():
            box.show(visit.switches.get(name, SWITCHES[name][1]))
        self._controls.offer(self._who, (_NOBODY, *visit.visitors))


def header(visit: Visit) -> str:
    """Where the feet come from, why nothing moves, and what else there is to say."""
    where = f'<span class="ss-source">{words.plain(visit.feet_from, 60)}</span>'
    badge = '<span class="ss-link ss-lost">STOPPED</span>' if visit.halted else _badge(visit)
    why = visit.fault or ("" if visit.message else visit.reason)
    lines = [(why, visit.fault or visit.halted), (visit.message, False)]
    said = "".join(f'<div class="ss-message{" ss-bad" if bad else ""}">{words.plain(line)}</div>'
                   for line, bad in lines if line)  # fmt: skip
    return f'<div class="ss-head">{where}{badge}</div>{said}'


def _badge(visit: Visit) -> str:
    kind = "lost" if visit.fault else "live" if visit.speed_mps or visit.turn_radps else "waiting"
    return f'<span class="ss-link ss-{kind}">{"no feet" if visit.fault else MOTIONS[visit.motion]}</span>'


def figures(visit: Visit) -> str:
    """Speed, pace, confidence, latency, place."""
    rows = [
        ("Speed", f"{words.number(visit.speed_mps)} m/s"),
        ("Turning", f"{words.signed(visit.turn_radps)} rad/s, to the right positive"),
        ("Pace", f"{words.number(visit.cadence_hz)} Hz" if visit.cadence_hz else words.DASH),
        (
            "Sure",
            f"{words.number(100 * visit.confidence, 0)} %" + ("" if visit.certain else ", not yet certain"),
        ),
        ("Sample to scene", words.DASH if visit.simulated else f"{words.number(visit.latency_ms, 1)} ms"),
        ("Rates", ", ".join(f"{f.role.value} {words.number(f.rate_hz, 0)} Hz" for f in visit.feet)),
        ("Place", f"{words.number(visit.north, 1)} m north, {words.number(visit.east, 1)} m east"),
        ("Targets", f"{visit.score} of {visit.targets}, {words.clock(visit.hunt_s)}"),
    ]
    if visit.idle_s is not None:
        rows.append(("Nobody there?", f"next visitor in {words.number(visit.idle_s, 0)} s"))
    body = "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows)
    return f'<table class="ss-table">{body}</table>'


def _steer(text: str) -> Command | None:
    """``fr 17``: the keys held, and a number that makes each message a new one."""
    keys = text.partition(" ")[0]
    return Steer(keys) if set(keys) <= set("fblrs") else None


def _switch(name: str, on: bool) -> Command:
    return Switch(name, on)


def _load(name: str) -> Command | None:
    return LoadVisitor(name) if name != _NOBODY else None
