"""A walking foot in closed form, as snapshots: the page without session, source or estimator."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from app.motion.basics import GaitPhase, Role, Vector
from app.motion.estimate import Sweep
from app.motion.health import Health
from app.motion.snapshot import Change, Footprint, FootView, Graph, Snapshot, TrackView, Trail, TrailPiece
from app.motion.source import Link, SourceInfo
from app.motion.status import Status
from app.rotation import from_yaw_pitch_roll
from app.settings import Settings

STRIDE_S, STRIDE_M, SWING = 1.1, 1.35, 0.42


def progress(t_s: float) -> tuple[int, float]:
    """Whole strides done, and the part (0…1) of the running swing; −1 in stance."""
    count, part = divmod(max(t_s, 0.0) / STRIDE_S, 1.0)
    swing = (part - (1 - SWING)) / SWING
    return int(count), swing if swing > 0 else -1.0


def pose(t_s: float, turn_per_m: float = 0.06) -> tuple[Vector, float, float]:
    """position_n, yaw, pitch of a foot that walks a gentle arc."""
    count, swing = progress(t_s)
    s = max(swing, 0.0)
    way = STRIDE_M * (count + s - math.sin(2 * math.pi * s) / (2 * math.pi))
    yaw = turn_per_m * way
    north = math.sin(yaw) / turn_per_m if turn_per_m else way
    east = (1 - math.cos(yaw)) / turn_per_m if turn_per_m else 0.0
    lift = 0.10 * math.sin(math.pi * s) ** 2
    pitch = -0.75 * math.sin(2 * math.pi * s) * math.sin(math.pi * s)
    return (north, east, -lift), yaw, pitch


def path(start_s: float, end_s: float, turn_per_m: float, count: int) -> np.ndarray:
    points = np.array([pose(t, turn_per_m)[0] for t in np.linspace(start_s, end_s, count + 1)], np.float32)
    return np.stack([points[:-1], points[1:]], axis=1)


def trail(t_s: float, turn_per_m: float = 0.06, name: str = "a", per_stride: int = 14) -> Trail:
    count, _ = progress(t_s)
    settled = count // 5 * 5
    pieces = tuple(
        TrailPiece(f"{name}{i}", path(i * STRIDE_S, (i + 5) * STRIDE_S, turn_per_m, 5 * per_stride))
        for i in range(0, settled, 5)
    )
    newest = count * STRIDE_S
    growing = path(settled * STRIDE_S, newest, turn_per_m, max(1, (count - settled) * per_stride))
    provisional = path(newest, t_s, turn_per_m, 40)
    return Trail(pieces, growing, provisional)


def footprint(number: int, turn_per_m: float) -> Footprint:
    place, yaw, _ = pose(number * STRIDE_S, turn_per_m)
    return Footprint(number, place, yaw)


def foot(t_s: float, role: Role = Role.FOOT, turn_per_m: float = 0.06, name: str = "a") -> FootView:
    place, yaw, pitch = pose(t_s, turn_per_m)
    count, swing = progress(t_s)
    return FootView(
        sensor=role.value, role=role, t_s=t_s, position_n=place,
        q_nb=from_yaw_pitch_roll(yaw, pitch, 0.0), phase=GaitPhase.SWING if swing > 0 else GaitPhase.STANCE,
        levelled=True, strides=count, distance_m=count * STRIDE_M, speed_mps=STRIDE_M / STRIDE_S,
        cadence_spm=120 / STRIDE_S, height_m=-place[2], to_start_m=math.hypot(place[0], place[1]),
        trail=trail(t_s, turn_per_m, name),
        footprints=tuple(footprint(i, turn_per_m) for i in range(max(1, count - 20), count + 1)),
        error_m=0.123,
    )  # fmt: skip


def graph(t_s: float, ahead_s: float = 0.0) -> Graph:
    at = np.linspace(max(0.0, t_s - 10), t_s, 200)
    walked = at + ahead_s
    swing = np.array([progress(t)[1] for t in walked])
    active = swing > 0
    rate = np.where(
        active, 6.5 * np.sin(np.pi * np.clip(swing, 0, 1)) ** 0.7, 0.15 + 0.1 * np.sin(9 * at) ** 2
    )
    speed = np.where(active, 4.6 * np.sin(np.pi * np.clip(swing, 0, 1)) ** 2, 0.0)
    height = np.array([-pose(t)[0][2] for t in walked])
    return Graph(at, rate, np.full(len(at), 1.35), active.astype(float), speed, height)


def snapshot(
    t_s: float, two: bool = False, candidate: bool = False, truth: bool = False, **changes: object
) -> Snapshot:
    roles = (Role.LEFT, Role.RIGHT) if two else (Role.FOOT,)
    starts = {role: t_s + (STRIDE_S / 2 if role is Role.RIGHT else 0) for role in roles}
    feet = tuple(foot(starts[role], role, name=role.value) for role in roles)
    settings = Settings()
    tuned = replace(settings, gain_stance=1.6, threshold_radps=1.35)
    ghost = tuple(foot(starts[role], role, 0.085, f"g{role.value}") for role in roles)
    known = {role.value: trail(starts[role], 0.052, f"t{role.value}") for role in roles} if truth else {}
    shot = Snapshot(
        number=int(t_s * 100), t_s=t_s, main=TrackView("main", settings, feet),
        candidate=TrackView("candidate", tuned, ghost) if candidate else None, truth=known,
        candidate_settings=tuned if candidate else settings, pending=False, apply_at_once=False, undo_depth=1,
        slots={"A": settings}, slot_now="A",
        changes=(
            Change(1200, 0, "browser 2", "gain_stance 1.05 → 1.4"), Change(2400, 0, "browser 1", "undo"),
        ),
        graphs={role.value: graph(t_s, starts[role] - t_s) for role in roles},
        health={role.value: Health(100.2, int(t_s * 100), {"time went backward": 2}, 0, 1) for role in roles},
        hindsight_from_s=0.0, stored_bytes=12_400_000, budget_bytes=512_000_000, epoch=0,
    )  # fmt: skip
    return replace(shot, **changes)  # type: ignore[arg-type]


def sweep() -> Sweep:
    stance, swing = np.linspace(0, 3, 41), np.linspace(0, 1, 21)
    closure = 0.2 + 0.5 * (stance[:, None] - 1.2) ** 2 + 3 * (swing[None] - 0.15) ** 2
    return Sweep(stance, swing, closure, (1.2, 0.15))


def status(**changes: object) -> Status:
    source = SourceInfo(
        "short_walk.csv", "x-io NGIMU CSV", {"foot": Role.FOOT}, 100.0,
        ("Mounting from gravity at rest: x,-y,-z.", "Field in µT, as the header says."),
        {"repeated stamp": 3}, 95.0,
    )  # fmt: skip
    plain = Status(
        source, Link.LIVE, replay=True, speed=1.0, position_s=31.4, profiles=("papers", "corridor", "stairs")
    )
    return replace(plain, **changes)  # type: ignore[arg-type]
