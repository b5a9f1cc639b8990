"""Tool, town: the ground: roadways, kerbs, pavements, crossings, the square, meadows beyond the edge."""

from __future__ import annotations

import itertools

import numpy as np
import trimesh

from app.world import STREET_M, Street, Town
from tools.town.batch import Batch, Rgb, linear, mix, times

ASPHALT, LINE, KERB = linear("#63666c"), linear("#e9e7df"), linear("#c9c4ba")
PAVING, PAVING_TWO, YARD = linear("#b9b1a4"), linear("#aaa296"), linear("#a09684")
SQUARE = [linear(c) for c in ("#cdbfa6", "#b59f80")]
GRASS, FIELD = linear("#86a35c"), linear("#9db070")
PAVEMENT_UP_M = 0.12
REACH_M = 520.0  # meadows reach so far


def flat(batch: Batch, south: float, west: float, north: float, east: float, up: float, colour: Rgb) -> None:
    """A rectangle on the ground."""
    batch.quad([(west, south, up), (east, south, up), (east, north, up), (west, north, up)], colour)


def ground(batch: Batch, town: Town) -> None:
    """All that one walks on. Its light comes from the light map, not from the vertices."""
    half = town.half_m
    flat(batch, -half, -half, half, half, 0.0, ASPHALT)
    for street in town.streets:
        markings(batch, town, street)
    for block in town.blocks:
        s, w, n, e = block[:4]
        kerb(batch, s, w, n, e)
        if s < 0 < n and w < 0 < e:
            square(batch, s, w, n, e)
        else:
            paving(batch, s, w, n, e)


def markings(batch: Batch, town: Town, street: Street) -> None:
    """A street's broken middle line, and the crossings and stop lines where others meet it."""
    box, north, half = street.box, street.along_north, town.half_m
    middle = 0.5 * ((box.west + box.east) if north else (box.south + box.north))
    others = [s.box for s in town.streets if s.along_north != north]
    meets = [0.5 * ((c.south + c.north) if north else (c.west + c.east)) for c in others]

    def put(low: float, left: float, high: float, right: float) -> None:
        """Along and across the street."""
        edges = (low, left, high, right) if north else (left, low, right, high)
        flat(batch, *edges, 0.012, LINE)

    for at in np.arange(-half + 2.0, half - 3.0, 6.0).tolist():
        if all(abs(at + 1.5 - c) > 13.0 for c in meets):
            put(at, middle - 0.07, at + 3.0, middle + 0.07)
    for c in meets:
        for sign in (-1.0, 1.0):
            near, far = sorted((c + sign * (0.5 * STREET_M + 1.0), c + sign * (0.5 * STREET_M + 4.2)))
            for k in range(10):
                left = middle - 0.5 * STREET_M + 0.35 + 1.2 * k
                put(near, left, far, left + 0.6)
            low, high = sorted(c + sign * (0.5 * STREET_M + d) for d in (5.2, 5.5))
            left = middle - 0.5 * STREET_M if sign * (1 if north else -1) > 0 else middle + 0.1
            put(low, left, high, left + 0.5 * STREET_M - 0.1)


def kerb(batch: Batch, s: float, w: float, n: float, e: float) -> None:
    """Kerb stones round a block: the front and a strip on top."""
    up, wide = PAVEMENT_UP_M, 0.28
    front = times(KERB, 0.8)
    batch.quad([(w, s, 0.0), (e, s, 0.0), (e, s, up), (w, s, up)], front)
    batch.quad([(e, n, 0.0), (w, n, 0.0), (w, n, up), (e, n, up)], front)
    batch.quad([(e, s, 0.0), (e, n, 0.0), (e, n, up), (e, s, up)], front)
    batch.quad([(w, n, 0.0), (w, s, 0.0), (w, s, up), (w, n, up)], front)
    flat(batch, s, w, s + wide, e, up, KERB)
    flat(batch, n - wide, w, n, e, up, KERB)
    flat(batch, s + wide, w, n - wide, w + wide, up, KERB)
    flat(batch, s + wide, e - wide, n - wide, e, up, KERB)


def paving(batch: Batch, s: float, w: float, n: float, e: float) -> None:
    """Slabs in two shades along the pavement, plain ground between the houses."""
    up, k, slab = PAVEMENT_UP_M, 0.28, 1.2
    s, w, n, e = s + k, w + k, n - k, e - k
    deep = 2 * slab
    flat(batch, s + deep, w + deep, n - deep, e - deep, up, YARD)
    flat(batch, s, w, s + deep, e, up, PAVING)
    flat(batch, n - deep, w, n, e, up, PAVING)
    flat(batch, s + deep, w, n - deep, w + deep, up, PAVING)
    flat(batch, s + deep, e - deep, n - deep, e, up, PAVING)
    joint, top = times(PAVING, 0.8), up + 0.006
    for at in np.arange(w, e, slab).tolist():
        flat(batch, s, at - 0.015, s + deep, at + 0.015, top, joint)
        flat(batch, n - deep, at - 0.015, n, at + 0.015, top, joint)
    for at in np.arange(s + deep, n - deep + 0.1, slab).tolist():
        flat(batch, at - 0.015, w, at + 0.015, w + deep, top, joint)
        flat(batch, at - 0.015, e - deep, at + 0.015, e, top, joint)
    for a in (s + slab, n - slab):
        flat(batch, a - 0.015, w, a + 0.015, e, top, joint)
    for a in (w + slab, e - slab):
        flat(batch, s + deep, a - 0.015, n - deep, a + 0.015, top, joint)


def square(batch: Batch, s: float, w: float, n: float, e: float) -> None:
    """Rings of stone round the landmark, rays between them."""
    up = PAVEMENT_UP_M
    flat(batch, s + 0.28, w + 0.28, n - 0.28, e - 0.28, up, SQUARE[0])
    radii = [3.9, 6.2, 9.4, 11.0, 15.2, 18.4]
    count = 96
    for i, (inner, outer) in enumerate(itertools.pairwise(radii)):
        for k in range(count):
            a, b = 2 * np.pi * k / count, 2 * np.pi * (k + 1) / count
            ink = SQUARE[(k // 4) % 2] if i % 2 == 0 else SQUARE[1]
            ring = [(r * float(np.cos(t)), r * float(np.sin(t)), up + 0.008) for r, t in
                    ((inner, a), (outer, a), (outer, b), (inner, b))]  # fmt: skip
            batch.quad(ring, ink)


def outskirts(batch: Batch, town: Town, rng: np.random.Generator) -> None:
    """What lies beyond the edge: a wall with a coping, a verge, meadows in strips, hills."""
    half = town.half_m
    stone = linear("#c4b8a2")
    for sign in (-1.0, 1.0):
        near, far = sorted((sign * half, sign * (half + 0.5)))
        batch.box((-half - 0.5, near, 0.0), (half + 0.5, far, 1.0), stone)
        batch.box((near, -half - 0.5, 0.0), (far, half + 0.5, 1.0), stone)
        batch.box((-half - 0.6, near - 0.08, 1.0), (half + 0.6, far + 0.08, 1.14), times(stone, 1.12))
        batch.box((near - 0.08, -half - 0.6, 1.0), (far + 0.08, half + 0.6, 1.14), times(stone, 1.12))
    for i in range(24):  # a ring of strips, each its own green
        inner = half + (REACH_M - half) * (i / 24.0) ** 1.6
        outer = half + (REACH_M - half) * ((i + 1) / 24.0) ** 1.6
        for turn in range(4):
            parts = 14
            for k in range(parts):
                a, b = -1.0 + 2.0 * k / parts, -1.0 + 2.0 * (k + 1) / parts
                ring = [(a * inner, -inner), (a * outer, -outer), (b * outer, -outer), (b * inner, -inner)]
                c, s = [(1, 0), (0, 1), (-1, 0), (0, -1)][turn]
                corners = [(c * x - s * y, s * x + c * y, -0.02) for x, y in ring]
                ink = times(mix(GRASS, FIELD, float(rng.random())), float(rng.uniform(0.92, 1.08)))
                batch.quad(corners, ink)
    hills(batch, rng)


def hills(batch: Batch, rng: np.random.Generator) -> None:
    """Two soft rows of hills all round."""
    for radius, high, ink in ((330.0, 26.0, linear("#7f9c5d")), (470.0, 58.0, linear("#7a9678"))):
        count = 72
        angle = np.linspace(0.0, 2 * np.pi, count + 1)
        phase = rng.uniform(0, 2 * np.pi, 4)
        rise = sum(np.sin(f * angle + p) / f**0.6 for f, p in zip((3, 5, 8, 13), phase, strict=True))
        rise = high * (0.55 + 0.22 * np.asarray(rise))
        shape = []
        for k, a in enumerate(angle.tolist()):
            for r, z in ((radius - 60.0, -1.0), (radius - 25.0, 0.55 * rise[k]), (radius, rise[k])):
                shape.append((r * np.cos(a), r * np.sin(a), z))
        faces = []
        for k in range(count):
            for j in range(2):
                p, q = 3 * k + j, 3 * (k + 1) + j
                faces += [[p, q + 1, q], [p, p + 1, q + 1]]
        batch.mesh(trimesh.Trimesh(np.array(shape), np.array(faces), process=False), ink)
