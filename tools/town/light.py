"""Tool, town: sun, sky and shadows, worked out once: rays against boxes and the crowns of trees."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.compiled import kernel
from tools.town.batch import Floats

Integers = NDArray[np.int64]
#: From the south-west, a good way up: x east, y north, z up.
SUN = np.array([-0.50, -0.56, 0.66])
SUN /= np.linalg.norm(SUN)
SUN_LIGHT = np.array([1.12, 1.00, 0.80])
SKY_LIGHT = np.array([0.40, 0.50, 0.64])
GROUND_LIGHT = np.array([0.30, 0.26, 0.21])


@kernel
def blocked(
    px: float,
    py: float,
    pz: float,
    dx: float,
    dy: float,
    dz: float,
    boxes: Floats,
    balls: Floats,
    reach: float,
) -> float:
    """How much of a ray gets through: 0 behind a wall, a little through leaves, 1 in the open."""
    for i in range(boxes.shape[0]):
        near, far = 1e-3, reach
        lo, hi = boxes[i, 0], boxes[i, 3]
        if abs(dx) < 1e-9:
            if px < lo or px > hi:
                continue
        else:
            a, b = (lo - px) / dx, (hi - px) / dx
            near, far = max(near, min(a, b)), min(far, max(a, b))
        lo, hi = boxes[i, 1], boxes[i, 4]
        if abs(dy) < 1e-9:
            if py < lo or py > hi:
                continue
        else:
            a, b = (lo - py) / dy, (hi - py) / dy
            near, far = max(near, min(a, b)), min(far, max(a, b))
        lo, hi = boxes[i, 2], boxes[i, 5]
        if abs(dz) < 1e-9:
            if pz < lo or pz > hi:
                continue
        else:
            a, b = (lo - pz) / dz, (hi - pz) / dz
            near, far = max(near, min(a, b)), min(far, max(a, b))
        if near < far:
            return 0.0
    through = 1.0
    for i in range(balls.shape[0]):
        ox, oy, oz = balls[i, 0] - px, balls[i, 1] - py, balls[i, 2] - pz
        along = ox * dx + oy * dy + oz * dz
        if along > 0.0 and along < reach:
            off = ox * ox + oy * oy + oz * oz - along * along
            r = balls[i, 3]
            if off < r * r:
                through *= 1.0 - 0.85 * min(1.0, (1.0 - off / (r * r)) * 2.5)
    return through


@kernel
def light_at(
    places: Floats, normals: Floats, suns: Floats, skies: Floats, boxes: Floats, balls: Floats,
    cell_of: Integers, box_lists: Integers, ball_lists: Integers, out: Floats,
) -> None:  # fmt: skip
    """Per place [n, 3]: the share of the sun and of the sky that reaches it → ``out`` [n, 2]."""
    for i in range(places.shape[0]):
        cell = cell_of[i]
        near_boxes, near_balls = (
            boxes[box_lists[cell, 1 : 1 + box_lists[cell, 0]]],
            balls[ball_lists[cell, 1 : 1 + ball_lists[cell, 0]]],
        )
        px, py, pz = places[i]
        nx, ny, nz = normals[i]
        sun = 0.0
        if nx * suns[0, 0] + ny * suns[0, 1] + nz * suns[0, 2] > -0.25:
            for k in range(suns.shape[0]):
                sun += blocked(px, py, pz, suns[k, 0], suns[k, 1], suns[k, 2], near_boxes, near_balls, 120.0)
        sky = total = 0.0
        for k in range(skies.shape[0]):
            weight = nx * skies[k, 0] + ny * skies[k, 1] + nz * skies[k, 2]
            if weight > 0.0:
                total += weight
                sky += weight * blocked(
                    px, py, pz, skies[k, 0], skies[k, 1], skies[k, 2], near_boxes, near_balls, 22.0
                )
        out[i, 0] = sun / suns.shape[0]
        out[i, 1] = sky / max(total, 1e-9)


class Sun:
    """The light of a town: what stands in its way, sorted into cells so that a ray asks few."""

    def __init__(self, boxes: Floats, balls: Floats, half_m: float) -> None:
        self._boxes, self._balls, self._half = boxes, balls, half_m + 160.0
        self._count = 40
        self._box_lists = self._lists(boxes[:, :2], boxes[:, 3:5], boxes[:, 5])
        low, high = balls[:, :2] - balls[:, 3:], balls[:, :2] + balls[:, 3:]
        self._ball_lists = self._lists(low, high, balls[:, 2] + balls[:, 3])

    def _lists(self, low: Floats, high: Floats, top: Floats) -> Integers:
        """Per cell, what may throw a shadow into it or hide a piece of its sky."""
        size = 2 * self._half / self._count
        rows = []
        for cell in range(self._count**2):
            x, y = -self._half + size * (cell % self._count), -self._half + size * (cell // self._count)
            lo, hi = np.array([x, y]), np.array([x, y]) + size
            reach = np.maximum(1.7 * top, 22.0)[:, None]
            rows.append(np.flatnonzero(np.all((low - reach < hi) & (high + reach > lo), axis=1)))
        longest = max(len(r) for r in rows)
        table = np.zeros((len(rows), longest + 1), np.int64)
        for i, row in enumerate(rows):
            table[i, 0], table[i, 1 : 1 + len(row)] = len(row), row
        return table

    def shares(self, places: Floats, normals: Floats, suns: int, skies: int) -> Floats:
        """[n, 2]: of the sun, of the sky."""
        size = 2 * self._half / self._count
        cell = np.clip((places[:, :2] + self._half) / size, 0, self._count - 1).astype(np.int64)
        out = np.zeros((len(places), 2))
        places, normals = np.ascontiguousarray(places), np.ascontiguousarray(normals)
        cells = cell[:, 1] * self._count + cell[:, 0]
        light_at(places, normals, disc(suns), dome(skies), self._boxes, self._balls, cells, self._box_lists,
                 self._ball_lists, out)  # fmt: skip
        return out

    def colour(self, places: Floats, normals: Floats, suns: int = 6, skies: int = 40) -> Floats:
        """The light [n, 3] that falls on faces turned that way."""
        share = self.shares(places, normals, suns, skies)
        direct = np.clip(normals @ SUN, 0.0, 1.0) * share[:, 0]
        up = 0.5 + 0.5 * normals[:, 2]
        open_sky = 0.25 + 0.75 * share[:, 1]
        return np.asarray(
            direct[:, None] * SUN_LIGHT
            + (open_sky * (0.35 + 0.65 * up))[:, None] * SKY_LIGHT
            + (open_sky * (1.0 - up))[:, None] * GROUND_LIGHT
        )


def disc(count: int) -> Floats:
    """Directions over the sun's disc, made wide for soft edges."""
    if count == 1:
        return SUN[None]
    a = np.cross(SUN, [0.0, 0.0, 1.0])
    a /= np.linalg.norm(a)
    b = np.cross(SUN, a)
    turn = np.arange(count) * 2.399963
    r = 0.014 * np.sqrt((np.arange(count) + 0.5) / count)
    way = SUN + (r * np.cos(turn))[:, None] * a + (r * np.sin(turn))[:, None] * b
    return np.asarray(way / np.linalg.norm(way, axis=1, keepdims=True))


def dome(count: int) -> Floats:
    """Directions over the upper half, evenly."""
    z = (np.arange(count) + 0.5) / count
    turn = np.arange(count) * 2.399963
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)
