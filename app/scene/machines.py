"""Edge, scene: the decoder's machines as graphs (dissertation, Fig. 102 and 103), the last six seconds."""

from __future__ import annotations

from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray
from viser import uplot

from app.motion.basics import Role
from app.scene.colours import FOOT, Rgb, css
from app.visit import Machines

WIDTH_PX, HEIGHT_PX, EACH_PX = 350, 520, 138
_LIMIT: Rgb = (222, 90, 80)
_SIDES = (Role.LEFT, Role.RIGHT)


class MachineGraphs:
    """Per foot the rate with Swing and Motion behind it; the yaw of both with Yaw behind it."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._drawn: Machines | None = None
        panel = gui.add_panel()
        tab: Any = panel.add_tab("Machines, last 6 s")
        panel.float(x=12, y=12, width=WIDTH_PX, height=HEIGHT_PX)
        with tab:
            self._rates = [_rate_plot(gui, role) for role in _SIDES]
            self._yaw = _yaw_plot(gui)

    def draw(self, machines: Machines | None) -> None:
        """Show these; the same ones cost nothing."""
        if machines is None or machines is self._drawn:
            return
        self._drawn = m = machines
        t_s = m.t_s - m.t_s[-1]
        limit = np.full(len(t_s), m.rate_threshold_radps)
        for i, plot in enumerate(self._rates):
            plot.data = (t_s, m.motion[i], m.swing[i], m.rate_radps[i], limit)
        bound = np.full(len(t_s), m.yaw_threshold_rad)
        self._yaw.data = (t_s, m.yaw[0], m.yaw[1], m.yaw_rad[0], m.yaw_rad[1], bound, -bound)


def _rate_plot(gui: viser.GuiApi, role: Role) -> viser.GuiUplotHandle:
    ink = FOOT[role]
    series = [_state("Motion", ink, 0.14), _state("Swing", ink, 0.3), _line("|ω|", ink), _dashed("threshold")]
    return _add(gui, f"{role.value} foot: |ω|, rad/s (dark: Swing, pale: Motion)", series)


def _yaw_plot(gui: viser.GuiApi) -> viser.GuiUplotHandle:
    left, right = (FOOT[role] for role in _SIDES)
    series = [_state("Yaw left", left, 0.25), _state("Yaw right", right, 0.25), _line("left", left),
              _line("right", right), _dashed("threshold"), _dashed("−threshold")]  # fmt: skip
    return _add(gui, "yaw since the action began, rad (shaded: Yaw)", series)


def _line(label: str, ink: Rgb) -> uplot.Series:
    return uplot.Series(label=label, stroke=css(ink), width=1.6, points={"show": False})


def _dashed(label: str) -> uplot.Series:
    return uplot.Series(label=label, stroke=css(_LIMIT), width=1.2, dash=(6, 4), points={"show": False})


def _state(label: str, ink: Rgb, alpha: float) -> uplot.Series:
    return uplot.Series(label=label, scale="state", width=0, fill=css(ink, alpha), points={"show": False})


def _add(gui: viser.GuiApi, title: str, series: list[uplot.Series]) -> viser.GuiUplotHandle:
    zeros: NDArray[np.float64] = np.zeros(2)
    font = "11px system-ui, sans-serif"
    return gui.add_uplot(
        (np.array([0.0, 1.0]), *[zeros] * len(series)), (uplot.Series(label="s"), *series), title=title,
        height=EACH_PX, padding=(4, 10, 0, 0), legend={"show": False}, cursor={"show": False},
        scales={"x": {"time": False}, "state": {"range": (0.0, 1.0)}},
        axes=({"size": 24, "font": font, "space": 60}, {"size": 40, "font": font, "space": 26}),
    )  # fmt: skip
