"""Edge, scene: the last ten seconds as graphs: |ω| against its threshold, speed, height."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray
from viser import uplot

from app.motion.basics import Role
from app.motion.snapshot import Graph, Snapshot
from app.scene.colours import FOOT, SWING, TRUTH, Rgb, css
from app.scene.guard import finite_rows

Floats = NDArray[np.float64]
Columns = tuple[Floats, ...]

POINTS = 200
SPAN_S = 10.0
HEIGHT_PX = 138
THRESHOLD: Rgb = (222, 90, 80)
#: Short enough to be read over the first of four graphs.
RATE = "|ω|, rad/s  ▒ swing  ┄ Ω_th"
STATISTIC = "0.1·√T, rad/s  ▒ swing  ┄ limit"
#: Which graphs there are.
WALK, TRUE_WALK, PENDULUM = ("speed", "height"), ("speed", "height", "error"), ("tilt", "tilt error")
NAMES = {Role.LEFT: "left", Role.RIGHT: "right", Role.FOOT: "", Role.OTHER: "sensor"}


def times(graphs: Sequence[Graph]) -> Floats:
    """One time axis for all feet: the last seconds up to the newest sample."""
    newest = max((float(g.t_s[-1]) for g in graphs if len(g.t_s)), default=0.0)
    oldest = min((float(g.t_s[0]) for g in graphs if len(g.t_s)), default=0.0)
    return np.linspace(max(oldest, newest - SPAN_S), max(newest, oldest + 1e-3), POINTS)


def on_axis(t_s: Floats, graph: Graph, column: str) -> Floats:
    """One column at those times; the phase is not smoothed, and nothing reaches past the data."""
    at, values = finite_rows((graph.t_s, getattr(graph, column)))
    if len(at) == 0:
        return np.zeros_like(t_s)
    if column == "swing":
        return values[np.clip(np.searchsorted(at, t_s, side="right") - 1, 0, len(at) - 1)]
    return np.interp(t_s, at, values)


class Graphs:
    """Three graphs, made for the feet there are and made anew when those change."""

    def __init__(self, gui: viser.GuiApi, container: Any) -> None:
        self._gui, self._container = gui, container
        self._shown: tuple[str, tuple[str, ...], tuple[tuple[str, Role], ...]] | None = None
        self._plots: list[tuple[viser.GuiUplotHandle, Callable[[Snapshot, Floats], Columns]]] = []
        self._drawn: object = None

    def draw(self, snapshot: Snapshot) -> None:
        """Bring the graphs up to date; the same snapshot's graphs cost nothing."""
        if snapshot.graphs is self._drawn:
            return
        self._drawn = snapshot.graphs
        feet = [f for f in snapshot.main.feet if f.sensor in snapshot.graphs]
        kind = PENDULUM if snapshot.pendulum else TRUE_WALK if snapshot.errors else WALK
        shown = (snapshot.main.settings.estimator, kind, tuple((f.sensor, f.role) for f in feet))
        if shown != self._shown:
            self._make(*shown)
            self._shown = shown
        t_s = times([snapshot.graphs[f.sensor] for f in feet])
        for plot, columns in self._plots:
            plot.data = (t_s, *columns(snapshot, t_s))

    def _make(self, estimator: str, kind: tuple[str, ...], feet: tuple[tuple[str, Role], ...]) -> None:
        for plot, _ in self._plots:
            plot.remove()
        sensors, roles = [sensor for sensor, _ in feet], [role for _, role in feet]
        title = RATE if estimator == "papers" else STATISTIC
        with self._container:
            self._plots = (
                [(_judged_plot(self._gui, title, roles), partial(_judged_columns, sensors))] if feet else []
            )
            for name in kind if feet else ():
                make, values = MORE[name]
                self._plots.append((make(self._gui, roles), partial(values, sensors)))


def _error_columns(sensors: list[str], snapshot: Snapshot, t_s: Floats) -> Columns:
    return tuple(_known(snapshot, s, t_s, 1) for s in sensors)


def _tilt_columns(sensors: list[str], snapshot: Snapshot, t_s: Floats) -> Columns:
    return tuple(np.degrees(_known(snapshot, s, t_s, k)) for s in sensors for k in (2, 3))


def _tilt_error_columns(sensors: list[str], snapshot: Snapshot, t_s: Floats) -> Columns:
    return tuple(a - b for a, b in _pairs(_tilt_columns(sensors, snapshot, t_s)))


def _pairs(columns: Columns) -> list[tuple[Floats, Floats]]:
    """Estimate and truth, sensor by sensor."""
    return list(zip(columns[::2], columns[1::2], strict=True))


def _known(snapshot: Snapshot, sensor: str, t_s: Floats, column: int) -> Floats:
    """A column of what is known beside the truth; nothing before it is known."""
    table = snapshot.errors.get(sensor, np.empty((0, 4)))
    at, values = finite_rows((table[:, 0], table[:, column]))
    return np.interp(t_s, at, values) if len(at) else np.zeros_like(t_s)


def _columns(sensors: list[str], column: str, snapshot: Snapshot, t_s: Floats) -> Columns:
    return tuple(on_axis(t_s, snapshot.graphs[s], column) for s in sensors if s in snapshot.graphs)


def _judged_columns(sensors: list[str], snapshot: Snapshot, t_s: Floats) -> Columns:
    parts = ("swing", "statistic", "threshold")
    return tuple(column for part in parts for column in _columns(sensors, part, snapshot, t_s))


def _lines(roles: Sequence[Role], width: float = 1.6) -> list[uplot.Series]:
    return [
        uplot.Series(label=NAMES[r] or "foot", stroke=css(FOOT[r]), width=width, points={"show": False})
        for r in roles
    ]


def _phases(roles: Sequence[Role]) -> list[uplot.Series]:
    return [
        uplot.Series(
            label=f"swing {NAMES[r]}".strip(), scale="phase", width=0, points={"show": False},
            fill=css(FOOT[r] if len(roles) > 1 else SWING, 0.2),
        )
        for r in roles
    ]  # fmt: skip


def _thresholds(roles: Sequence[Role]) -> list[uplot.Series]:
    hidden = uplot.Series_Points(show=False)
    return [
        uplot.Series(
            label=f"threshold {NAMES[r]}".strip(), width=1.4, dash=(6, 4), points=hidden,
            stroke=css(FOOT[r] if len(roles) > 1 else THRESHOLD),
        )
        for r in roles
    ]  # fmt: skip


def _judged_plot(gui: viser.GuiApi, title: str, roles: Sequence[Role]) -> viser.GuiUplotHandle:
    """What the detector judges by and its threshold, which may follow the gait; swing is shaded behind."""
    return _add(gui, title, [*_phases(roles), *_lines(roles), *_thresholds(roles)])


def _plot(gui: viser.GuiApi, title: str, roles: Sequence[Role]) -> viser.GuiUplotHandle:
    return _add(gui, title, _lines(roles))


def _add(gui: viser.GuiApi, title: str, series: list[uplot.Series]) -> viser.GuiUplotHandle:
    zeros = np.zeros(2)
    font = "11px system-ui, sans-serif"
    return gui.add_uplot(
        (np.array([0.0, 1.0]), *[zeros] * len(series)), (uplot.Series(label="s"), *series), title=title,
        height=HEIGHT_PX, padding=(4, 10, 0, 0), legend={"show": False}, cursor={"show": False},
        scales={"x": {"time": False}, "phase": {"range": (0.0, 1.0)}},
        axes=({"size": 24, "font": font, "space": 60}, {"size": 40, "font": font, "space": 26}),
    )  # fmt: skip


def _speed_plot(gui: viser.GuiApi, roles: Sequence[Role]) -> viser.GuiUplotHandle:
    return _plot(gui, "Speed, m/s", roles)


def _height_plot(gui: viser.GuiApi, roles: Sequence[Role]) -> viser.GuiUplotHandle:
    return _plot(gui, "Height, m", roles)


def _error_plot(gui: viser.GuiApi, roles: Sequence[Role]) -> viser.GuiUplotHandle:
    return _plot(gui, "Error to truth, m", roles)


def _tilt_plot(gui: viser.GuiApi, roles: Sequence[Role]) -> viser.GuiUplotHandle:
    """The estimate, and the truth dashed."""
    hidden = uplot.Series_Points(show=False)
    truth = uplot.Series(label="truth", stroke=css(TRUTH), width=1.4, dash=(6, 4), points=hidden)
    return _add(gui, "Angle, ° (dashed truth)", [line for one in _lines(roles) for line in (one, truth)])


def _tilt_error_plot(gui: viser.GuiApi, roles: Sequence[Role]) -> viser.GuiUplotHandle:
    return _plot(gui, "Error of the angle, °", roles)


Maker = Callable[[viser.GuiApi, Sequence[Role]], viser.GuiUplotHandle]
#: The graphs beside the detector's.
MORE: dict[str, tuple[Maker, Callable[[list[str], Snapshot, Floats], Columns]]] = {
    "speed": (_speed_plot, lambda sensors, *now: _columns(sensors, "speed_mps", *now)),
    "height": (_height_plot, lambda sensors, *now: _columns(sensors, "height_m", *now)),
    "error": (_error_plot, _error_columns),
    "tilt": (_tilt_plot, _tilt_columns),
    "tilt error": (_tilt_error_plot, _tilt_error_columns),
}
