"""Edge, scene: the feet: shoe, trail and prints of the main track, the candidate's ghost, the truth."""

from __future__ import annotations

import math
from collections.abc import Iterable

import viser

from app.motion.basics import Role, Vector
from app.motion.estimate import Toe
from app.motion.snapshot import FootView, OwnView, Snapshot, Trail
from app.rotation import multiply
from app.scene.colours import CANDIDATE, FOOT, OWN, TRUTH, Rgb, blend
from app.scene.doubt import Doubt
from app.scene.footprints import Footprints
from app.scene.guard import drawable, unit
from app.scene.meshes import Clock
from app.scene.shoe import SENSOR_HEIGHT_M, Shadow, Shoe, yaw
from app.scene.trails import NOTHING, Look, TrailNodes

APART_M = 0.2  # between the origins of two feet that nothing links
GREY: Rgb = (150, 156, 166)
EMPTY = Trail((), NOTHING[:0], NOTHING[:0])

TRUTH_LOOK = Look(TRUTH, blend(TRUTH, GREY, 0.3), 1.5, above_m=0.004)
OWN_LOOK = Look(OWN, blend(OWN, GREY, 0.3), 1.5, above_m=0.006)
#: While a slider is dragged, the ghost before is soon gone.
GHOST_LOOK = Look(CANDIDATE, blend(CANDIDATE, GREY, 0.35), 2.0, above_m=0.002, both_s=0.05)


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


def moved(p: Vector, offset: Vector) -> Vector:
    """A place, to its foot's side."""
    return (p[0] + offset[0], p[1] + offset[1], p[2] + offset[2])


class Second:
    """Another shoe and its trail beside the main one; made when first shown."""

    def __init__(
        self, scene: viser.SceneApi, kind: str, name: str, role: Role, look: Look, now: Clock
    ) -> None:
        self._scene, self._kind, self._name = scene, kind, name
        self._role, self._look, self._now = role, look, now
        self._shown: tuple[Shoe, TrailNodes] | None = None

    def draw(self, foot: FootView | OwnView | None, offset: Vector, toe: Toe | None) -> None:
        """Show it, or nothing; its toe points where the main one's does."""
        if foot is None:
            return self.remove()
        if self._shown is None:
            shoe = Shoe(self._scene, f"/ned/{self._kind}/{self._name}", self._role, ghost=self._look.colour)
            trail = TrailNodes(self._scene, f"{self._name}_{self._kind}", self._look, offset, self._now)
            self._shown = shoe, trail
        shoe, trail = self._shown
        trail.draw(foot.trail)
        if drawable(foot):
            shoe.pose(unit(foot.q_nb), moved(foot.position_n, offset))
            shoe.point(toe)

    def remove(self) -> None:
        """Take it off the page."""
        for part in self._shown or ():
            part.remove()
        self._shown = None


class Walker:
    """One foot on the page."""

    def __init__(self, scene: viser.SceneApi, name: str, role: Role, offset: Vector, now: Clock) -> None:
        self._scene, self._name, self._role = scene, name, role
        self._offset, self._now = offset, now
        self.shoe = Shoe(scene, f"/ned/{name}", role)
        self._shadow = Shadow(scene, f"/ned/shadow/{name}", role)
        self._doubt = Doubt(scene, f"/ned/doubt/{name}", role)
        self._trail = TrailNodes(scene, name, look(role), offset, now)
        self._prints = Footprints(scene, name, role, offset, now)
        self._ghost = Second(scene, "ghost", name, role, GHOST_LOOK, now)
        self._own = Second(scene, "own", name, role, OWN_LOOK, now)
        self._truth_trail: TrailNodes | None = None
        self._toe: Toe | None = None

    def draw(self, foot: FootView) -> Vector | None:
        """Show it; returns where it is drawn, or nothing while its pose is no finite number."""
        self._toe = foot.toe
        if not drawable(foot):
            return None
        place, turn = moved(foot.position_n, self._offset), unit(foot.q_nb)
        self.shoe.pose(turn, place)
        self.shoe.point(foot.toe)
        self._shadow.lie(place, yaw(multiply(turn, foot.toe.q_bs) if foot.toe else turn), floor(foot))
        self._doubt.lie(place, floor(foot), foot.trust)
        return place

    def draw_way(self, foot: FootView) -> None:
        """Where it went: its trail and its prints."""
        self._trail.draw(foot.trail)
        self._prints.draw(foot.footprints)

    def draw_beside(self, ghost: FootView | None, own: OwnView | None) -> None:
        """The candidate over the whole walk, and the walk by the sensor's own orientation, or nothing."""
        self._ghost.draw(ghost, self._offset, self._toe)
        self._own.draw(own, self._offset, self._toe)

    def draw_truth(self, trail: Trail | None) -> None:
        """Where a simulator says that the foot really was."""
        if self._truth_trail is None:
            if trail is None:
                return
            self._truth_trail = TrailNodes(
                self._scene, f"{self._name}_truth", TRUTH_LOOK, self._offset, self._now
            )
        self._truth_trail.draw(EMPTY if trail is None else trail)

    def remove(self) -> None:
        """Take the foot and all that is its off the page."""
        for part in (self._ghost, self._own, self.shoe, self._shadow, self._doubt, self._trail, self._prints):
            part.remove()
        if self._truth_trail is not None:
            self._truth_trail.remove()


class Walkers:
    """All feet of a snapshot; made anew when the walk starts again or the feet change."""

    def __init__(self, scene: viser.SceneApi, now: Clock) -> None:
        self._scene, self._now = scene, now
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
        return [place for place in places if place is not None]

    def draw_ways(self, snapshot: Snapshot) -> None:
        """All ways walked, of the feet that were drawn, and what is beside them: it takes longer."""
        for foot in snapshot.main.feet:
            self._walkers[foot.sensor].draw_way(foot)
        ghosts = {f.sensor: f for f in snapshot.candidate.feet} if snapshot.candidate else {}
        for sensor, walker in self._walkers.items():
            walker.draw_truth(snapshot.truth.get(sensor))
            walker.draw_beside(ghosts.get(sensor), snapshot.own.get(sensor) if self._show_own else None)

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
                self._scene,
                node_name(f.role, f.sensor, roles),
                f.role,
                origin(f.role, two, heading_rad),
                self._now,
            )
            for f in feet
        }
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
