"""Edge, scene: a walk as one page that plays offline: the same shoes and trails, the figures over them.

viser puts its own page, the scene and every change of it into one file. What stands in the panel is not in
it, so phase and figures are labels in the scene. The page may ask nothing of any network.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from html import escape

import viser

from app.motion.snapshot import FootView, Snapshot
from app.scene import figures, private, ribbon, swinging, words
from app.scene.follow import NED_WXYZ, Glide, middle
from app.scene.ground import Ground
from app.scene.page import in_view, place_camera
from app.scene.stage import Stage
from app.scene.walkers import node_name

#: Where the labels stand: above a shoe, and above the walker's middle; metres, down is positive.
OVER_SHOE_M, OVER_ALL_M = -0.32, -0.75
#: The view follows so many times as closely as the live one, and from so many times as far away.
CLOSER, BACK = 3.0, 1.35
#: After this long the view stands still.
SETTLED_S = 10.0
#: The words change with every so many frames: faster nobody reads.
WORDS_EVERY = 4
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval' blob: data:; style-src 'unsafe-inline'; "
    "img-src data: blob:; font-src data:; worker-src blob:; connect-src data: blob:"
)


class Film:
    """Takes snapshots of a walk in order and gives the page that plays them."""

    def __init__(self, server: viser.ViserServer, name: str, pace: float, dark: bool = True) -> None:
        """``pace``: seconds of the walk in a second of the film."""
        self._server, self._name, self._pace, self._dark = server, name, pace, dark
        scene = server.scene
        self._root = scene.add_frame("/ned", wxyz=NED_WXYZ, show_axes=False)
        self._ground = Ground(scene, dark=dark)
        self._shown_s = 0.0  # of the film
        self._stage, self._glide = Stage(scene, lambda: self._shown_s), Glide()
        self._labels: dict[str, viser.LabelHandle] = {}
        self._frames, self._written = 0, True
        place_camera(server, BACK)
        self._tape = server.get_scene_serializer()

    def take(self, snapshot: Snapshot, lasts_s: float) -> None:
        """Show this for so many seconds of the film."""
        self.show(snapshot, lasts_s)
        self._tape.insert_sleep(lasts_s)

    def show(self, snapshot: Snapshot, elapsed_s: float = SETTLED_S) -> None:
        """Show this ``elapsed_s`` after what was shown before; alone it is a picture to turn about."""
        self._shown_s += elapsed_s
        places = self._stage.draw(snapshot)
        self._stage.draw_ways(snapshot)
        centre = self._glide.towards(middle(places), CLOSER * elapsed_s)
        self._written = self._frames % WORDS_EVERY == 0
        self._frames += 1
        self._say("title", self.title(snapshot), (*self._glide.centre[:2], OVER_ALL_M))
        roles = [foot.role for foot in snapshot.main.feet]
        for foot, place in zip(snapshot.main.feet, places, strict=False):
            name = node_name(foot.role, foot.sensor, roles)
            line = swinging.told(snapshot.pendulum) if snapshot.pendulum else told(foot)
            self._say(name, line, (place[0], place[1], place[2] + OVER_SHOE_M))
        private.force_pose(self._root, NED_WXYZ, in_view(centre))
        self._ground.reach(centre)

    def title(self, snapshot: Snapshot) -> str:
        """Which walk, when in it, how fast it is played."""
        pace = "" if self._pace == 1.0 else f" · {self._pace:g}×"
        return f"{self._name} · {words.clock(snapshot.t_s)}{pace}"

    def _say(self, name: str, text: str, place: tuple[float, float, float]) -> None:
        label = self._labels.get(name)
        if label is None:
            label = self._labels[name] = self._server.scene.add_label(
                f"/ned/figures/{name}", text, anchor="bottom-center", font_size_mode="screen",
                font_screen_scale=0.9,
            )  # fmt: skip
        if self._written and label.text != text:
            label.text = text
        label.position = place

    def page(self, beside: str = "") -> str:
        """The whole file; ``beside`` is markup of ours that stands beside the scene."""
        head = (
            f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
            f"<title>{escape(self._name)} – Stridescope</title><script>{ribbon.script()}</script>"
        )
        before, end, after = self._tape.as_html(dark_mode=self._dark).rpartition("</body>")
        return before.replace("<head>", f"<head>{head}", 1) + beside + end + after


def told(foot: FootView) -> str:
    """A foot's phase by mark and word, and its figures."""
    mark = "▬ STANCE" if foot.phase == 0 else "▲ SWING"
    if not foot.levelled:
        mark = "STAND STILL…"
    distance = " ".join(words.metres(foot.distance_m))
    speed = f"{words.number(foot.speed_mps)} m/s"
    return f"{figures.FEET[foot.role]} {mark} · {foot.strides} strides · {distance} · {speed}"


@contextlib.contextmanager
def film(name: str, pace: float, dark: bool = True) -> Iterator[Film]:
    """A film of a walk; its server is only there to write down what it would send."""
    server = private.open_server("Stridescope")
    try:
        yield Film(server, name, pace, dark)
    finally:
        private.close_server(server)
