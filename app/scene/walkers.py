"""Edge, scene: the feet: shoe, trail and prints of the main track, the candidate's ghost, the truth."""

from __future__ import annotations

import math
from collections.abc import Iterable

import viser

from app.motion.basics import Role, Vector
from app.motion.snapshot import FootView, OwnView, Snapshot, Trail
from app.scene.colours import CANDIDATE, FOOT, OWN, TRUTH, Rgb, blend
from app.scene.doubt import Doubt
from app.scene.footprints import Footprints
from app.scene.guard import drawable, unit
from app.scene.shoe import SENSOR_HEIGHT_M, Shadow, Shoe, yaw
from app.scene.trails import NOTHING, Look, TrailNodes

APART_M = 0.2  # between the origins of two feet that nothing links
GREY: Rgb = (150, 156, 166)
EMPTY = Trail((), NOTHING[:0], NOTHING[:0])

TRUTH_LOOK = Look(TRUTH, blend(TRUTH, GREY, 0.3), 1.5)
OWN_LOOK = Look(OWN, blend(OWN, GREY, 0.3), 1.5)
GHOST_LOOK = Look(CANDIDATE, blend(CANDIDATE, GREY, 0.35), 2.0)


def node_name(role: Role, sensor: str, roles: Iterable[Role]) -> str:
    """The shoe's fixed name: ``left``, ``right`` or ``foot``; a second one of a role gets its own."""
    same = [r for r in roles if r is role]
    if role in (Role.LEFT, Role.RIGHT) or (role is Role.FOOT and len(same) == 1):
        return role.value
    return "sensor_" + "".join(c if c.isalnum() else "_" for c in sensor)


def origin(role: Role, two_feet: bool, start_heading_rad: float) -> Vector:
    """Where a foot's walk starts: to its side of the common start when two are drawn."""
    side = {Role.LEFT: -0.5, Role.RIGHT: 0.5}.get(role, 0.0) * APART_M if two_feet else 0.0
    return (-side * math.sin(start_heading_rad), side * math.cos(start_heading_rad), 0.0)


def look(role: Role) -> Look:
    """The main track's trail: the foot's colour; provisional: the same, paler."""
    return Look(FOOT[role], blend(FOOT[role], (255, 255, 255), 0.45), 3.5)


def floor(foot: FootView) -> float:
    """How far down the floor is: where the last finite print was made, which on stairs is not 0."""
    level = foot.footprints[-1].position_n[2] if foot.footprints else 0.0
    return (level if math.isfinite(level) else 0.0) + SENSOR_HEIGHT_M


class Walker:
    """One foot on the page."""

    def __init__(self, scene: viser.SceneApi, name: str, role: Role, offset: Vector) -> None:
        self._scene, self._name, self._role, self._offset = scene, name, role, offset
        self.shoe = Shoe(scene, f"/ned/{name}", role)
        self._shadow = Shadow(scene, f"/ned/shadow/{name}", role)
        self._doubt = Doubt(scene, f"/ned/doubt/{name}", role)
        self._trail = TrailNodes(scene, name, look(role), offset)
        self._prints = Footprints(scene, name, role, offset)
        self._ghost: Shoe | None = None
        self._ghost_trail: TrailNodes | None = None
        self._truth_trail: TrailNodes | None = None
        self._own: Shoe | None = None
        self._own_trail: TrailNodes | None = None

    def draw(self, foot: FootView) -> Vector | None:
        """Show it; returns where it is drawn, or nothing while its pose is no finite number."""
        self._trail.draw(foot.trail)
        self._prints.draw(foot.footprints)
        if not drawable(foot):
            return None
        place, turn = self._moved(foot.position_n), unit(foot.q_nb)
        self.shoe.pose(turn, place)
        self._shadow.lie(place, yaw(turn), floor(foot))
        self._doubt.lie(place, floor(foot), foot.trust)
        return place

    def draw_ghost(self, foot: FootView | None) -> None:
        """The candidate over the whole walk, or nothing."""
        if foot is None:
            self._drop_ghost()
            return
        if self._ghost is None:
            self._ghost = Shoe(self._scene, f"/ned/ghost/{self._name}", self._role, ghost=CANDIDATE)
            self._ghost_trail = TrailNodes(self._scene, f"{self._name}_ghost", GHOST_LOOK, self._offset)
        if self._ghost_trail is not None:
            self._ghost_trail.draw(foot.trail)
        if drawable(foot):
            self._ghost.pose(unit(foot.q_nb), self._moved(foot.position_n))

    def draw_truth(self, trail: Trail | None) -> None:
        """Where a simulator says that the foot really was."""
        if self._truth_trail is None:
            if trail is None:
                return
            self._truth_trail = TrailNodes(self._scene, f"{self._name}_truth", TRUTH_LOOK, self._offset)
        self._truth_trail.draw(EMPTY if trail is None else trail)

    def draw_own(self, own: OwnView | None) -> None:
        """The walk by the sensor's own orientation, or nothing."""
        if own is None:
            self._drop_own()
            return
        if self._own is None:
            self._own = Shoe(self._scene, f"/ned/own/{self._name}", self._role, ghost=OWN)
            self._own_trail = TrailNodes(self._scene, f"{self._name}_own", OWN_LOOK, self._offset)
        if self._own_trail is not None:
            self._own_trail.draw(own.trail)
        if drawable(own):
            self._own.pose(unit(own.q_nb), self._moved(own.position_n))

    def _drop_own(self) -> None:
        if self._own is not None and self._own_trail is not None:
            self._own.remove()
            self._own_trail.remove()
            self._own = self._own_trail = None

    def _moved(self, p: Vector) -> Vector:
        return (p[0] + self._offset[0], p[1] + self._offset[1], p[2] + self._offset[2])

    def _drop_ghost(self) -> None:
        if self._ghost is not None and self._ghost_trail is not None:
            self._ghost.remove()
            self._ghost_trail.remove()
            self._ghost = self._ghost_trail = None

    def remove(self) -> None:
        """Take the foot and all that is its off the page."""
        self._drop_ghost()
        self._drop_own()
        for part in (self.shoe, self._shadow, self._doubt, self._trail, self._prints, self._truth_trail):
            if part is not None:
                part.remove()


class Walkers:
    """All feet of a snapshot; made anew when the walk starts again or the feet change."""

    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._walkers: dict[str, Walker] = {}
        self._made_for: object = None
        self._note: viser.LabelHandle | None = None
        self._axes = False
        self._show_own = False

    def draw(self, snapshot: Snapshot) -> list[Vector]:
        """Show every foot; returns where the shoes stand."""
        feet = snapshot.main.feet
        heading = round(snapshot.main.settings.start_heading_rad, 6)
        made_for = (snapshot.epoch, heading, tuple((f.sensor, f.role) for f in feet))
        if made_for != self._made_for:
            self._make(feet, heading)
            self._made_for = made_for
        self._show_note(len(feet) > 1 and not snapshot.main.linked)
        places = [self._walkers[f.sensor].draw(f) for f in feet]
        ghosts = {f.sensor: f for f in snapshot.candidate.feet} if snapshot.candidate else {}
        for sensor, walker in self._walkers.items():
            walker.draw_ghost(ghosts.get(sensor))
            walker.draw_truth(snapshot.truth.get(sensor))
            walker.draw_own(snapshot.own.get(sensor) if self._show_own else None)
        return [place for place in places if place is not None]

    def show_own(self, on: bool) -> None:
        """The walk by each sensor's own orientation, where it tells one."""
        self._show_own = on

    def show_axes(self, on: bool) -> None:
        """The sensor's axes on every shoe."""
        self._axes = on
        for walker in self._walkers.values():
            walker.shoe.show_axes(on)

    def _make(self, feet: tuple[FootView, ...], heading_rad: float) -> None:
        for walker in self._walkers.values():
            walker.remove()
        roles = [f.role for f in feet]
        two = len(feet) > 1
        self._walkers = {
            f.sensor: Walker(
                self._scene, node_name(f.role, f.sensor, roles), f.role, origin(f.role, two, heading_rad)
            )
            for f in feet
        }  # fmt: skip
        self.show_axes(self._axes)

    def _show_note(self, on: bool) -> None:
        if self._note is None and not on:
            return
        if self._note is None:
            self._note = self._scene.add_label(
                "/ned/feet_note", "feet not linked", position=(-0.28, 0.0, 0.08), anchor="center-center",
                font_size_mode="screen", font_screen_scale=0.8,
            )  # fmt: skip
        if self._note.visible != on:
            self._note.visible = on
