"""Edge, scene: what our own script draws over the town, as data: pure functions of a visit."""

from __future__ import annotations

import html
import json
import math
from typing import Any

from app.motion.basics import MotionId
from app.scene.words import LONGEST
from app.visit import Goal, Task, Visit
from app.world import Town

MOTIONS = {
    MotionId.NONE: "standing", MotionId.FORWARD: "forward", MotionId.FORWARD_RIGHT: "forward, to the right",
    MotionId.FORWARD_LEFT: "forward, to the left", MotionId.SIDE_RIGHT: "aside, to the right",
    MotionId.SIDE_LEFT: "aside, to the left", MotionId.TURN_CW: "turning right",
    MotionId.TURN_CCW: "turning left", MotionId.BACKWARD: "backward",
}  # fmt: skip


def data(visit: Visit) -> str:
    """An element that shows nothing and holds the state; the script writes it as text, never as markup."""
    text = html.escape(json.dumps(state(visit), separators=(",", ":")), quote=True)
    return f'<div id="mover-data" hidden data-state="{text}"></div>'


def state(visit: Visit) -> dict[str, Any]:
    """All that the script shows."""
    return {
        "feet": [{"state": f.state, "size": _round(f.size)} for f in visit.feet],
        "motion": MOTIONS[visit.motion], "moving": visit.motion is not MotionId.NONE,
        "certain": visit.certain, "reason": visit.reason[:LONGEST], "fault": visit.fault[:LONGEST],
        "message": visit.message[:LONGEST], "halted": visit.halted, "touching": visit.touching,
        "speed": _round(visit.speed_mps), "turn": _round(visit.turn_radps),
        "goal": _goal(visit.goal), "score": visit.score, "targets": visit.targets,
        "seconds": int(visit.hunt_s), "best": None if visit.best_s is None else int(visit.best_s),
        "reached": visit.reached, "task": _task(visit.task), "map": visit.switches.get("map", True),
        "vignette": visit.switches.get("vignette", False), "simulated": visit.simulated,
        "idle": None if visit.idle_s is None else int(visit.idle_s),
    }  # fmt: skip


def plan(town: Town) -> dict[str, Any]:
    """The town for the small map: boxes south, west, north, east."""
    return {
        "half": town.half_m,
        "blocks": [_box(b[:4]) for b in town.blocks],
        "houses": [_box(b.box[:4]) for b in town.buildings],
        "landmark": _box(town.landmark[:4]),
        "trees": [[round(p.north, 1), round(p.east, 1)] for p in town.trees],
    }


def _box(edges: tuple[float, ...]) -> list[float]:
    return [round(c, 1) for c in edges]


def _goal(goal: Goal | None) -> dict[str, float] | None:
    if goal is None:
        return None
    return {"north": goal.north, "east": goal.east, "metres": round(goal.distance_m)}


def _task(task: Task | None) -> dict[str, Any] | None:
    if task is None:
        return None
    return {**task._asdict(), "part": _round(task.part)}


def _round(value: float) -> float:
    return round(value, 2) if math.isfinite(value) else 0.0
