"""Edge, scene: the page as a function of a snapshot: opens viser, draws, hands orders over."""

from __future__ import annotations

import logging
import time
from collections.abc import Mapping
from functools import partial

import viser

from app.motion.basics import Vector
from app.motion.door import GuiRule
from app.motion.snapshot import Snapshot
from app.motion.source import Outline
from app.motion.status import Reference, Status
from app.scene import private
from app.scene.controls import Controls, Submit
from app.scene.follow import NED_WXYZ, Glide, middle
from app.scene.ground import Ground
from app.scene.head import head
from app.scene.once import Once
from app.scene.outline import outline_nodes
from app.scene.panel import Panel
from app.scene.reference import reference_line
from app.scene.shoe import SENSOR_HEIGHT_M
from app.scene.stage import Stage

log = logging.getLogger(__name__)

TEXT_S, GRAPH_S = 0.125, 0.125
LONGEST_STEP_S = 0.1


def in_view(centre: Vector) -> Vector:
    """Where ``/ned`` stands so that ``centre`` (in *n*) is in the middle and its floor at 0."""
    north, east, down = centre
    return (-east, -north, down + SENSOR_HEIGHT_M)


class Scene:
    """The page. ``submit`` is called from viser's thread with each order a browser gives."""

    def __init__(self, submit: Submit) -> None:
        self._server = private.open_server("Stridescope")
        self.port = self._server.get_port()
        self._view = {"follow": True, "dark": True, "axes": False, "own": False}
        self._glide, self._drawn_at, self._next_text, self._next_graph = Glide(), 0.0, 0.0, 0.0
        self._centre: Vector = self._glide.centre
        self._controls = Controls(self._server.gui, submit)
        self._root = self._server.scene.add_frame(
            "/ned", wxyz=NED_WXYZ, position=in_view(self._glide.centre), show_axes=False
        )
        self._ground = Ground(self._server.scene, dark=True)
        self._stage = Stage(self._server.scene, time.monotonic)
        self._reference = Once[Reference](partial(reference_line, self._server.scene))
        self._outline = Once[Outline](partial(outline_nodes, self._server.scene))
        self._theme(dark=True)
        self.panel = Panel(self._controls, self._set_view, self._view)
        self.head = head(self.panel.keys(), self.panel.resets())
        place_camera(self._server)

    def draw(self, snapshot: Snapshot, status: Status) -> None:
        """Make every browser show this; cheap for what has not changed."""
        now = time.monotonic()
        self._follow(self._stage.draw(snapshot), min(now - self._drawn_at, LONGEST_STEP_S))
        self._drawn_at = now
        self._server.flush()  # the shoe need not wait for trails, words and graphs
        self._stage.draw_ways(snapshot)
        if now >= self._next_graph:
            self._next_graph = now + GRAPH_S
            self.panel.show_graphs(snapshot)
        if now >= self._next_text:
            self._next_text = now + TEXT_S
            self._reference.draw(status.reference)
            self._outline.draw(status.source.outline)
            self.panel.show_text(snapshot, status, self._view)
        self._server.flush()

    def rules(self) -> Mapping[str, GuiRule]:
        """What a browser may write into each control, by the control's uuid."""
        return self._controls.rules()

    @property
    def dark(self) -> bool:
        """Whether the page is dark now."""
        return self._view["dark"]

    def close(self) -> None:
        """Stop viser."""
        private.close_server(self._server)

    def _follow(self, places: list[Vector], elapsed_s: float) -> None:
        if not self._view["follow"] or not places:
            return
        centre = self._glide.towards(middle(places), elapsed_s)
        north, east, down = (round(c, 4) for c in centre)
        if (north, east, down) != self._centre:
            self._centre = (north, east, down)
            private.force_pose(self._root, NED_WXYZ, in_view(self._centre))
            self._ground.reach(self._centre)

    def _set_view(self, name: str, on: bool) -> None:
        self._view[name] = on
        if name == "dark":
            self._theme(on)
            self._ground.recolour(on)
        if name == "axes":
            self._stage.walkers.show_axes(on)
        if name == "own":
            self._stage.walkers.show_own(on)

    def _theme(self, dark: bool) -> None:
        self._server.gui.configure_theme(
            dark_mode=dark, show_logo=False, show_share_button=False, brand_color=(0, 114, 178)
        )


def place_camera(server: viser.ViserServer, back: float = 1.0) -> None:
    """From behind and to the right, near enough to see the shoe, far enough for a stride."""
    camera = server.initial_camera
    camera.position = (1.15 * back, -1.65 * back, 0.95 * back)
    camera.look_at = (0.05, 0.1, -0.12)
    camera.up = (0.0, 0.0, 1.0)
    camera.fov = 0.72
    camera.near, camera.far = 0.02, 500.0
