"""Edge, scene: the tab for before the walk: the pre-flight's lines, and the guided calibration."""

from __future__ import annotations

from collections.abc import Callable

from app.motion.commands import Calibrate, CheckFirst, Command
from app.motion.status import CalibrationView, LineState, PreflightView, Status
from app.scene import pictures, words
from app.scene.controls import Controls

SHAPES = {LineState.GOOD: "✓", LineState.BAD: "■", LineState.NOW: "▶", LineState.WAIT: "·"}
ALL = "first sensor"


class BeforeTab:
    """Two folders: pre-flight, calibration."""

    def __init__(self, controls: Controls) -> None:
        self._controls = controls
        self._sensor = ""
        with controls.gui.add_folder("Pre-flight"):
            self._lines = controls.html()
            controls.choice("", {
                "Check": lambda: CheckFirst("start"), "Skip line": lambda: CheckFirst("skip"),
                "Swap feet": lambda: CheckFirst("swap"),
            })  # fmt: skip
        with controls.gui.add_folder("Calibration"):
            self._applied = controls.html()
            self._list = controls.dropdown("Sensor", (ALL,), self._choose, "Which sensor is calibrated.")
            controls.choice("", {"Start": self._ask("start"), "Step back": self._ask("back"),
                                 "Give up": self._ask("cancel")})  # fmt: skip
            self._guide = controls.html()
            controls.choice("", {"Save and use": self._ask("save"), "Undo": self._ask("undo"),
                                 "Use again": self._ask("redo")})  # fmt: skip

    def show(self, status: Status) -> None:
        """As both are."""
        self._lines.show(preflight(status.preflight))
        view = status.calibration
        if view is not None:
            self._controls.offer(self._list, view.sensors or (ALL,))
            self._applied.show(applied(view))
            self._guide.show(guide(view))

    def _choose(self, sensor: str) -> None:
        self._sensor = "" if sensor == ALL else sensor

    def _ask(self, do: str) -> Callable[[], Command]:
        return lambda: Calibrate(do, self._sensor)


def preflight(view: PreflightView | None) -> str:
    """Its lines: a shape, a word and what was found or is to be done."""
    if view is None:
        return (
            '<div class="ss-note">Still, rate, range, heading, a short loop: under a minute, for one foot '
            "or two. Press Check and stand still.</div>"
        )
    lines = "".join(
        f'<div class="ss-line ss-line-{line.state.name.lower()}"><i>{SHAPES[line.state]}</i>'
        f"<b>{line.name}</b><span>{words.plain(line.told)}</span></div>"
        for line in view.lines
    )
    if not view.done:
        return lines
    end = "Ready to walk." if view.good else "Done, with remarks: see above."
    kept = f"{end} It took {words.clock(view.seconds)} and is kept with this walk."
    return f'{lines}<div class="ss-note">{kept}</div>'


def applied(view: CalibrationView) -> str:
    """Which sensors are corrected, and since when."""
    if not view.sensors:
        return '<div class="ss-note">For live sensors: a recording is left as it was recorded.</div>'
    rows = "".join(
        f"<tr><th>{words.plain(sensor, 40)}</th><td>" + _use(view, sensor) + "</td></tr>"
        for sensor in view.sensors
    )
    bad = f'<div class="ss-message ss-bad">{words.plain(view.damaged)}</div>' if view.damaged else ""
    return f'{bad}<table class="ss-table">{rows}</table>'


def _use(view: CalibrationView, sensor: str) -> str:
    if sensor in view.applied:
        return f"✓ corrected; calibrated {words.plain(view.applied[sensor], 40)}"
    return "as it comes; its calibration is undone" if sensor in view.undone else "as it comes"


def guide(view: CalibrationView) -> str:
    """The step under way with its picture, how long it must still lie, and the directions of the field."""
    now = view.guide
    if now is None:
        return (
            '<div class="ss-note">Six sides, the turns between, and two rounds for the magnetometer: about a '
            "minute on a level table (Bachmann et al. 2001, Appendix B).</div>"
        )
    if view.found:
        lines = "\n".join(words.plain(line, 200) for line in view.found)
        return f'<div class="ss-guide"><b>Found</b><pre>{lines}</pre></div>'
    note = f'<div class="ss-message">{words.plain(now.note)}</div>' if now.note else ""
    done = f"{now.step} of {now.steps}" if now.done else f"Step {now.step + 1} of {now.steps}"
    field = ""
    if now.directions:
        field = (
            f"<div>Field seen in {100 * now.coverage:.0f} % of directions</div>{pictures.sky(now.directions)}"
        )
    return (
        f'<div class="ss-guide"><b>{done}</b><div class="ss-do">{words.plain(now.words)}</div>'
        f'{pictures.pose(now.picture)}<div class="ss-held"><i style="width:{100 * now.held:.0f}%"></i></div>'
        f"{note}{field}</div>"
    )
