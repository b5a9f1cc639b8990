"""Tool, town: trees, lamps, benches, flower beds, and the tower on the square."""

from __future__ import annotations

import itertools

import numpy as np
import trimesh

from app.world import Box, Place, Town
from tools.town.batch import Batch, Floats, Rgb, linear, mix, times
from tools.town.houses import GLASS_HIGH, GLASS_LOW, STONE, sides

LEAVES = [linear(c) for c in ("#6f9a45", "#7fa64b", "#5f8c48", "#8fae52", "#6a9550")]
BARK, IRON, LIGHT, EARTH = (linear(c) for c in ("#6b5140", "#3d4448", "#fff1c9", "#5c4636"))
OVERHEAD_M = 2.1
FLOWERS = [linear(c) for c in ("#d9534f", "#f0c04a", "#e58fb0", "#f4efe6", "#8d6fc0")]


def tree(
    batch: Batch, place: Place, rng: np.random.Generator, ground_m: float, size: float = 1.0, lumps: int = 3,
    fine: int = 1,
) -> list[Floats]:  # fmt: skip
    """A trunk and a crown of a few soft lumps; the spheres (x, y, z, r) that throw its shadow."""
    x, y = place.east, place.north
    tall = size * float(rng.uniform(5.2, 7.0))
    trunk = trimesh.creation.cone(radius=place.radius_m * 0.95, height=tall, sections=7)
    trunk.apply_translation([x, y, ground_m])
    batch.mesh(trunk, BARK)
    ink = mix(LEAVES[int(rng.integers(len(LEAVES)))], LEAVES[0], 0.3)
    balls = []
    for i in range(lumps):
        turn, away = 2.2 * i + float(rng.uniform(0, 1)), (0.0 if i == 0 else size * 1.05)
        r = size * float(rng.uniform(1.45, 1.85)) * (1.0 if i == 0 else 0.78)
        z = ground_m + tall * (0.72 if i == 0 else 0.60) + size * float(rng.uniform(-0.2, 0.3))
        z = max(z, ground_m + OVERHEAD_M + r)  # nobody's face in the leaves
        balls.append(np.array([x + away * np.cos(turn), y + away * np.sin(turn), z, r]))
        crown(batch, balls[-1], ink, rng, fine)
    return balls


def crown(batch: Batch, lump: Floats, ink: Rgb, rng: np.random.Generator, fine: int) -> None:
    """One lump of leaves: light on top, dark below."""
    ball = trimesh.creation.icosphere(subdivisions=fine, radius=1.0)
    rough = 1.0 + rng.uniform(-0.13, 0.13, len(ball.vertices))
    way = np.asarray(ball.vertices) * rough[:, None]
    ball.vertices = way * lump[3] * np.array([1.0, 1.0, 0.86]) + lump[:3]
    shade = 0.78 + 0.3 * way[:, 2] + rng.uniform(-0.07, 0.07, len(way))
    batch.mesh(ball, np.array(ink) * np.clip(shade, 0.45, 1.25)[:, None], out_m=0.5)


def lamp(batch: Batch, place: Place) -> None:
    """A pole with a lantern."""
    x, y = place.east, place.north
    for radius, low, high in ((0.11, 0.12, 0.7), (0.05, 0.7, 3.7)):
        pole = trimesh.creation.cylinder(radius=radius, height=high - low, sections=8)
        pole.apply_translation([x, y, 0.5 * (low + high)])
        batch.mesh(pole, IRON)
    batch.box((x - 0.16, y - 0.16, 3.7), (x + 0.16, y + 0.16, 3.76), IRON, floor=True)
    a, b = -0.13, 0.13
    corners = [(x + a, y + a), (x + b, y + a), (x + b, y + b), (x + a, y + b)]
    for (px, py), (qx, qy) in zip(corners, corners[1:] + corners[:1], strict=True):
        batch.quad([(px, py, 3.76), (qx, qy, 3.76), (qx, qy, 4.16), (px, py, 4.16)], LIGHT, own_light=True)
    hat = trimesh.creation.cone(radius=0.26, height=0.3, sections=8)
    hat.apply_translation([x, y, 4.16])
    batch.mesh(hat, IRON, soft=False)


def bench(batch: Batch, box: Box) -> None:
    """Slats on two feet."""
    s, w, n, e, high = box
    wood = linear("#a8774a")
    low = 0.12
    for i in range(3):
        if e - w > n - s:
            a, b = s + 0.02 + i * (n - s) / 3.0, s + (i + 0.86) * (n - s) / 3.0
            batch.box((w, a, high - 0.06), (e, b, high), times(wood, 1.0 - 0.05 * i), floor=True)
        else:
            a, b = w + 0.02 + i * (e - w) / 3.0, w + (i + 0.86) * (e - w) / 3.0
            batch.box((a, s, high - 0.06), (b, n, high), times(wood, 1.0 - 0.05 * i), floor=True)
    for end in (0.15, 0.85):
        if e - w > n - s:
            x = w + end * (e - w)
            batch.box((x - 0.06, s + 0.05, low), (x + 0.06, n - 0.05, high - 0.06), IRON)
        else:
            y = s + end * (n - s)
            batch.box((w + 0.05, y - 0.06, low), (e - 0.05, y + 0.06, high - 0.06), IRON)


def planter(batch: Batch, box: Box, rng: np.random.Generator) -> None:
    """A stone bed with earth, bushes and flowers."""
    s, w, n, e, high = box
    batch.box((w, s, 0.12), (e, n, high), STONE, top=times(STONE, 1.1))
    batch.quad([(w + 0.25, s + 0.25, high + 0.01), (e - 0.25, s + 0.25, high + 0.01),
                (e - 0.25, n - 0.25, high + 0.01), (w + 0.25, n - 0.25, high + 0.01)], EARTH)  # fmt: skip
    for _ in range(26):
        x, y = float(rng.uniform(w + 0.5, e - 0.5)), float(rng.uniform(s + 0.5, n - 0.5))
        r = float(rng.uniform(0.16, 0.3))
        bush = trimesh.creation.icosphere(subdivisions=0, radius=r)
        bush.apply_translation([x, y, high + 0.12])
        ink = FLOWERS[int(rng.integers(len(FLOWERS)))] if rng.random() < 0.55 else LEAVES[1]
        batch.mesh(bush, ink, out_m=0.3)


def tower(batch: Batch, box: Box) -> None:
    """The clock tower: a stone shaft in three parts, a belfry, a copper spire."""
    s, w, n, e, high = box
    cream, copper = linear("#e9dcc3"), linear("#5fa08c")
    for side in sides(box).values():
        long = side.length_m
        rows = [0.12, 2.6, 5.2, 7.6, 10.2, 12.6, high - 3.4]
        for low, top in itertools.pairwise(rows):
            for k in range(2):
                side.panel(batch, k * long / 2, low, (k + 1) * long / 2, top, cream)
        clock(batch, side.at(long / 2, 12.9, 0.06), side.right, side.out)
        for low in (4.2, 8.2):
            side.panel(batch, long / 2 - 0.5, low - 0.05, long / 2 + 0.5, low + 1.95, times(cream, 1.1), 0.02)
            side.panel(batch, long / 2 - 0.4, low + 0.05, long / 2 + 0.4, low + 1.85,
                       [GLASS_LOW, GLASS_LOW, GLASS_HIGH, GLASS_HIGH], 0.04)  # fmt: skip
        side.ledge(batch, -0.1, 0.0, long + 0.1, 1.1, 0.1, STONE)
        for up in (7.4, 10.9, high - 3.5):
            side.ledge(batch, -0.18, up, long + 0.18, up + 0.3, 0.18, times(cream, 1.08))
        for left in (0.0, long - 0.6):
            side.ledge(batch, left, 1.1, left + 0.6, high - 3.4, 0.06, times(cream, 1.05))
        for left, right in ((0.0, 0.8), (2.1, 2.9), (4.2, long)):
            side.panel(batch, left, high - 3.2, right, high, cream)
        side.panel(batch, 0.0, high - 0.5, long, high, cream)
        side.panel(batch, 0.8, high - 3.2, long - 0.8, high - 0.5, linear("#4a4f57"), -0.5, 0.6)
        side.ledge(batch, -0.3, high, long + 0.3, high + 0.35, 0.3, times(cream, 1.1))
        f = side.at
        eaves, middle = high + 0.35, high + 2.4
        foot = [f(-0.2, eaves, 0.2), f(long + 0.2, eaves, 0.2)]
        waist = [f(long - 1.3, middle, -1.3), f(1.3, middle, -1.3)]
        tip = f(long / 2, high + 7.0, -long / 2)
        batch.quad([*foot, *waist], [times(copper, 0.9)] * 2 + [copper] * 2)
        batch.quad([waist[1], waist[0], tip, tip], copper)
    ball = trimesh.creation.icosphere(subdivisions=1, radius=0.3)
    ball.apply_translation([0.5 * (w + e), 0.5 * (s + n), high + 7.1])
    batch.mesh(ball, linear("#e8c34d"))


def clock(batch: Batch, centre: tuple[float, float, float], right: tuple[float, float, float],
          out: tuple[float, float, float]) -> None:  # fmt: skip
    """A face, twelve marks, ten past ten."""
    c, r, o, up = (np.array(v) for v in (centre, right, out, (0.0, 0.0, 1.0)))

    def fan(radius: float, front: float, ink: Rgb) -> None:
        turn = np.linspace(0.0, 2.0 * np.pi, 33)
        for a, b in itertools.pairwise(turn):
            tri = [c + front * o, c + front * o + radius * (np.cos(a) * r + np.sin(a) * up),
                   c + front * o + radius * (np.cos(b) * r + np.sin(b) * up)]  # fmt: skip
            corners = [tuple(p.tolist()) for p in (*tri, tri[2])]
            batch.quad(corners, ink, normal=tuple(out))  # type: ignore[arg-type]

    def hand(angle: float, inner: float, outer: float, wide: float, front: float) -> None:
        way, across = np.sin(angle) * r + np.cos(angle) * up, np.cos(angle) * r - np.sin(angle) * up
        points = [c + front * o + d * way + w * across for d, w in
                  ((inner, -wide), (inner, wide), (outer, wide), (outer, -wide))]  # fmt: skip
        batch.quad([tuple(p.tolist()) for p in points], IRON, normal=tuple(out))  # type: ignore[arg-type]

    fan(1.35, 0.0, linear("#8a6a3a"))
    fan(1.2, 0.03, linear("#fbf6e6"))
    for k in range(12):
        hand(k * np.pi / 6, 0.95, 1.12, 0.045, 0.05)
    hand(10.17 * np.pi / 6, -0.1, 0.62, 0.06, 0.07)
    hand(10 * np.pi / 30, -0.12, 0.98, 0.045, 0.08)


def around_town(town: Town, rng: np.random.Generator) -> list[Place]:
    """Trees on the meadows beyond the edge, thicker near it."""
    places: list[Place] = []
    while len(places) < 170:
        north, east = rng.uniform(-1.0, 1.0, 2) * (town.half_m + 150.0)
        away = max(abs(north), abs(east)) - town.half_m
        if away > 4.0 and rng.random() < np.exp(-away / 60.0) + 0.08:
            places.append(Place(float(north), float(east), 0.3))
    return places
