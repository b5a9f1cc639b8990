"""Edge, scene: the town mode's page as a function of a visit: the world moves, the camera never does."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Mapping
from pathlib import Path

from app.motion.basics import Quaternion, Vector
from app.motion.door import GuiRule
from app.scene import hud, private, town
from app.scene.controls import Controls, Submit
from app.scene.head import marks
from app.scene.machines import MachineGraphs
from app.scene.mover_panel import MoverPanel
from app.scene.mover_view import beacon, in_view
from app.visit import Goal, Visit
from app.world import Town

HERE = Path(__file__).parent
HUD_S, TEXT_S, GRAPH_S = 1 / 15, 0.12, 0.1
#: Up and down at most; a picture wider than high keeps the sides in bounds (mover_camera.js).
FOV_DEG = 62.0
NEAR_M, FAR_M = 0.1, 1600.0
_TARGET_RADIUS_M = 1.5


class MoverScene:
    """The page. ``submit`` is called from viser's thread with each order a browser gives."""

    def __init__(
        self, submit: Submit, plan: Town, wall: tuple[int, int] = (3, 1), kiosk: bool = False
    ) -> None:
        self._server = private.open_server("Stridescope")
        self.port = self._server.get_port()
        self._pose: tuple[Quaternion, Vector] | None = None
        self._goal: tuple[float, float] | None = None
        self._next_hud = self._next_text = self._next_graph = 0.0
        self._server.gui.configure_theme(
            dark_mode=True, show_logo=False, show_share_button=False, brand_color=(0, 114, 178)
        )
        self._build()
        self._controls = Controls(self._server.gui, submit)
        self.panel = MoverPanel(self._controls)
        self._graphs = MachineGraphs(self._server.gui)
        self.head = head(self.panel, plan, wall, kiosk)

    def draw(self, visit: Visit) -> None:
        """Make every browser show this; cheap for what has not changed."""
        self.move(visit.north, visit.east, visit.heading_rad, visit.eye_m)
        self.tell(visit)

    def move(self, north: float, east: float, heading_rad: float, eye_m: float) -> None:
        """Only the place: away at once."""
        pose = in_view(north, east, heading_rad, eye_m)
        if pose != self._pose:
            self._pose = pose
            private.force_pose(self._world, *pose)
            self._server.flush()

    @property
    def due(self) -> bool:
        """Whether it is time for words, figures or graphs again."""
        return time.monotonic() >= min(self._next_hud, self._next_text, self._next_graph)

    def tell(self, visit: Visit) -> None:
        """Words, figures and graphs, each at its own pace."""
        now = time.monotonic()
        if now >= self._next_hud:
            self._next_hud = now + HUD_S
            self._show_goal(visit.goal)
            self.panel.show_hud(hud.data(visit))
        if now >= self._next_text:
            self._next_text = now + TEXT_S
            self.panel.show(visit)
        if now >= self._next_graph:
            self._next_graph = now + GRAPH_S
            self._graphs.draw(visit.machines)
        self._server.flush()

    def rules(self) -> Mapping[str, GuiRule]:
        """What a browser may write into each control, by the control's uuid."""
        return self._controls.rules()

    def close(self) -> None:
        """Stop viser."""
        private.close_server(self._server)

    def _build(self) -> None:
        """Everything hangs under ``/world`` in *n*; no lights, for the light is in the colours."""
        scene = self._server.scene
        scene.configure_default_lights(False, cast_shadow=False)
        scene.configure_environment_map(None)
        scene.configure_fog(*town.FOG_M, color=town.haze())
        self._world = scene.add_frame("/world", show_axes=False)
        files = {"town": town.town_file(), "sky": town.sky_file(), "goal": beacon(_TARGET_RADIUS_M)}
        made = {
            name: scene.add_glb(f"/world/{name}", file, cast_shadow=False, receive_shadow=False)
            for name, file in files.items()
        }
        self._light = made["goal"]
        self._light.visible = False
        camera = self._server.initial_camera
        camera.position, camera.look_at, camera.up = (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
        camera.fov, camera.near, camera.far = math.radians(FOV_DEG), NEAR_M, FAR_M

    def _show_goal(self, goal: Goal | None) -> None:
        place = None if goal is None else (goal.north, goal.east)
        if place != self._goal:
            self._goal = place
            if place is not None:
                self._light.position = (*place, 0.0)
            self._light.visible = place is not None


def head(panel: MoverPanel, plan: Town, wall: tuple[int, int], kiosk: bool) -> str:
    """HTML for the page's ``<head>``; only our own files, numbers and viser's uuids go into it."""
    told = {
        "presses": {key: private.press(*press) for key, press in panel.presses().items()},
        "keys": panel.keys.id, "plan": hud.plan(plan), "wall": wall, "kiosk": kiosk, "fov": FOV_DEG,
    }  # fmt: skip
    style = "".join((HERE / name).read_text(encoding="utf-8") for name in ("page.css", "mover.css"))
    names = ("mover_camera.js", "mover_loading.js", "mover_hud.js", "present.js", "watching.js")
    script = "".join((HERE / name).read_text(encoding="utf-8") for name in names)
    script = script.replace("MOVER_TOLD", json.dumps(told, separators=(",", ":")), 1) + marks([])
    return f"<title>Stridescope</title><style>{style}</style><script>{script}</script>"
