"""Tool, town: houses: walls with windows, doors and shops, roofs, cornices."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.world import Box, Building
from tools.town.batch import Batch, Point, Rgb, linear, mix, times

STOREY_M = 3.2
WALLS = [linear(c) for c in
         ("#f0dfc0", "#e3b78f", "#d99a86", "#c9d3c0", "#e9c777", "#b9cbd9", "#f3ece0",
          "#c47f63")]  # fmt: skip
TRIMS = [
    linear(c)
    for c in ("#fbf6ec", "#f7efe2", "#f6e9df", "#fafaf4", "#fff6dd", "#fdfdfb", "#e5d9c6", "#f1e4d6")
]
SHUTTERS = [linear(c) for c in ("#5d7f6b", "#3f6f86", "#8b4b3e", "#50684f", "#6f7d8c", "#7a5a46")]
DOORS = [linear(c) for c in ("#2f5d50", "#7b3b32", "#2e4a66", "#5a4630", "#8a6a2f", "#3b3f46")]
AWNINGS = [linear(c) for c in ("#c8503f", "#2f7d74", "#d9a441", "#4a6fa5", "#8a5a83")]
TILES = [linear(c) for c in ("#b5603f", "#a9553b", "#c2714a", "#9c5a44")]
SLATE = [linear(c) for c in ("#5b6470", "#6a6f78", "#555c66")]
STONE, GLASS_HIGH, GLASS_LOW = linear("#cfc6b8"), linear("#b8d3e6"), linear("#3f566b")
CREAM = linear("#fff3d6")


class Side(NamedTuple):
    """One wall: its left lower corner seen from outside, the way right, the way out, how long."""

    corner: Point
    right: Point
    out: Point
    length_m: float

    def at(self, along_m: float, up_m: float, out_m: float = 0.0) -> Point:
        """A point on the wall, or in front of it."""
        x, y, z = (
            c + along_m * r + out_m * o for c, r, o in zip(self.corner, self.right, self.out, strict=True)
        )
        return x, y, z + up_m

    def panel(
        self, batch: Batch, left: float, low: float, right: float, high: float, colour: Rgb | list[Rgb],
        out_m: float = 0.0, lit_m: float = 0.05, own_light: bool = False,
    ) -> None:  # fmt: skip
        """A rectangle of the wall, or parallel to it."""
        corners = [self.at(left, low, out_m), self.at(right, low, out_m), self.at(right, high, out_m),
                   self.at(left, high, out_m)]  # fmt: skip
        batch.quad(corners, colour, max(lit_m, 0.05 - out_m), own_light)

    def ledge(
        self, batch: Batch, left: float, low: float, right: float, high: float, out_m: float, colour: Rgb,
        ends: bool = True,
    ) -> None:  # fmt: skip
        """A bar that stands out of the wall: front, top, underside and, unless it is small, both ends."""
        f = self.at
        front = [f(left, low, out_m), f(right, low, out_m), f(right, high, out_m), f(left, high, out_m)]
        batch.quad(front, colour)
        batch.quad(
            [f(left, high, out_m), f(right, high, out_m), f(right, high), f(left, high)], times(colour, 1.06)
        )
        batch.quad(
            [f(left, low), f(right, low), f(right, low, out_m), f(left, low, out_m)], times(colour, 0.7)
        )
        if not ends:
            return
        batch.quad(
            [f(left, low), f(left, low, out_m), f(left, high, out_m), f(left, high)], times(colour, 0.9)
        )
        batch.quad(
            [f(right, low, out_m), f(right, low), f(right, high), f(right, high, out_m)], times(colour, 0.9)
        )

    def hollow(
        self, batch: Batch, left: float, low: float, right: float, high: float, deep_m: float, colour: Rgb
    ) -> None:
        """The four inner sides of an opening, the upper one in its own shade."""
        f = self.at
        into = -deep_m
        light = deep_m + 0.05
        for corners, factor in (
            ([f(left, low), f(right, low), f(right, low, into), f(left, low, into)], 0.95),
            ([f(left, high, into), f(right, high, into), f(right, high), f(left, high)], 0.5),
            ([f(left, low, into), f(left, high, into), f(left, high), f(left, low)], 0.74),
            ([f(right, low), f(right, high), f(right, high, into), f(right, low, into)], 0.74),
        ):
            batch.quad(corners, times(colour, factor), light, normal=self.out)


class Look(NamedTuple):
    """How one house looks."""

    wall: Rgb
    trim: Rgb
    shutter: Rgb | None
    door: Rgb
    awning: Rgb | None
    tall_m: float
    wide_m: float


def sides(box: Box) -> dict[str, Side]:
    """The four walls by the way they face."""
    s, w, n, e = box[:4]
    return {
        "south": Side((w, s, 0.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0), e - w),
        "east": Side((e, s, 0.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), n - s),
        "north": Side((e, n, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), e - w),
        "west": Side((w, n, 0.0), (0.0, -1.0, 0.0), (-1.0, 0.0, 0.0), n - s),
    }


def house(
    batch: Batch, building: Building, fronts: set[str], hidden: set[str], rng: np.random.Generator
) -> None:
    """One house. ``fronts`` face a street; ``hidden`` touch another house."""
    look = Look(
        WALLS[building.colour], TRIMS[building.colour],
        SHUTTERS[int(rng.integers(len(SHUTTERS)))] if rng.random() < 0.55 else None,
        DOORS[int(rng.integers(len(DOORS)))],
        AWNINGS[int(rng.integers(len(AWNINGS)))] if rng.random() < 0.6 else None,
        float(rng.uniform(1.55, 1.9)), float(rng.uniform(1.05, 1.35)),
    )  # fmt: skip
    for name, side in sides(building.box).items():
        if name in hidden:
            continue
        facade(batch, side, building, look, name in fronts, rng)
    roof(batch, building, look, rng)


def facade(
    batch: Batch, side: Side, building: Building, look: Look, front: bool, rng: np.random.Generator
) -> None:
    """One wall from the plinth to the cornice."""
    bays = max(2, round(side.length_m / (3.1 if front else 4.4)))
    width = side.length_m / bays
    door = int(rng.integers(bays)) if front else -1
    shop = front and look.awning is not None and building.storeys > 2
    for storey in range(building.storeys):
        low = storey * STOREY_M
        for bay in range(bays):
            left = bay * width
            if storey == 0 and shop:
                shop_bay(batch, side, left, width, bay == door, look, rng)
            elif storey == 0 and bay == door:
                door_bay(batch, side, left, width, look)
            elif not front and rng.random() < 0.35:
                side.panel(batch, left, low, left + width, low + STOREY_M, look.wall)
            else:
                window_bay(batch, side, left, width, low, look, storey < 2 and front, front, rng)
        if front and storey:
            side.ledge(
                batch, 0.0, low - 0.09, side.length_m, low + 0.05, 0.05, mix(look.wall, look.trim, 0.6)
            )
    top = building.storeys * STOREY_M
    side.panel(batch, 0.0, top, side.length_m, building.box.height_m, look.wall)
    if not building.gabled:
        side.ledge(batch, -0.22, top + 0.25, side.length_m + 0.22, top + 0.62, 0.28, look.trim)
        side.ledge(
            batch, -0.1, top + 0.02, side.length_m + 0.1, top + 0.25, 0.12, mix(look.wall, look.trim, 0.7)
        )
    if front:
        corner = mix(look.wall, look.trim, 0.75)
        for left in (0.0, side.length_m - 0.42):
            side.ledge(batch, left, 0.0, left + 0.42, top + 0.02, 0.035, corner)
    side.ledge(batch, 0.0, 0.0, side.length_m, 0.5, 0.06, mix(look.wall, STONE, 0.75))


def glass(rng: np.random.Generator) -> list[Rgb]:
    """A pane: sky above, the dark room below, now and then a curtain or a lamp."""
    shade = float(rng.uniform(0.75, 1.15))
    low, high = times(GLASS_LOW, shade), times(GLASS_HIGH, shade)
    luck = rng.random()
    if luck < 0.16:
        low, high = mix(low, CREAM, 0.45), mix(high, CREAM, 0.5)
    elif luck < 0.24:
        low, high = mix(low, linear("#f2c377"), 0.5), mix(high, linear("#f7dca6"), 0.35)
    return [low, mix(low, high, 0.15), high, mix(high, low, 0.2)]


def window_bay(
    batch: Batch, side: Side, left: float, width: float, low: float, look: Look, deep: bool, front: bool,
    rng: np.random.Generator,
) -> None:  # fmt: skip
    """A piece of wall with one window."""
    a = left + 0.5 * (width - look.wide_m)
    b, c = a + look.wide_m, low + 0.85
    d, high = c + look.tall_m, low + STOREY_M
    if deep:
        for piece in ((left, low, a, high), (b, low, left + width, high), (a, low, b, c), (a, d, b, high)):
            side.panel(batch, *piece, look.wall)
        side.hollow(batch, a, c, b, d, 0.17, mix(look.wall, look.trim, 0.5))
        back, lit = -0.17, 0.22
    else:
        side.panel(batch, left, low, left + width, high, look.wall)
        back, lit = 0.02, 0.05
    side.panel(batch, a, c, b, d, look.trim, back, lit)
    middle, across = 0.5 * (a + b), c + 0.64 * (d - c)
    upper, lower = glass(rng), glass(rng)
    for x, y in ((a + 0.07, middle - 0.035), (middle + 0.035, b - 0.07)):
        if deep:
            side.panel(batch, x, c + 0.08, y, across - 0.03, lower, back + 0.015, lit)
            side.panel(batch, x, across + 0.03, y, d - 0.07, upper, back + 0.015, lit)
        else:
            side.panel(batch, x, c + 0.08, y, d - 0.07, upper, back + 0.02, lit)
    if deep:
        side.ledge(batch, a - 0.12, c - 0.12, b + 0.12, c, 0.13, look.trim, ends=False)
        side.panel(batch, a - 0.1, d, b + 0.1, d + 0.16, look.trim, 0.04)
    elif front:
        side.panel(batch, a - 0.1, c - 0.12, b + 0.1, c, times(look.trim, 0.93), 0.03)
    if look.shutter is not None and front:
        for x in (a - 0.5, b + 0.06):
            side.panel(batch, x, c - 0.02, x + 0.44, d + 0.02, look.shutter, 0.045)
            if deep:
                for y in (c + 0.1, 0.5 * (c + d) + 0.05):
                    shades = [times(look.shutter, f) for f in (0.9, 0.9, 0.62, 0.62)]
                    side.panel(batch, x + 0.07, y, x + 0.37, y + 0.5 * (d - c) - 0.16, shades, 0.055)


def door_bay(batch: Batch, side: Side, left: float, width: float, look: Look) -> None:
    """A front door with a light above it and a step before it."""
    a, b, d = left + 0.5 * width - 0.6, left + 0.5 * width + 0.6, 2.75
    for piece in ((left, 0.0, a, STOREY_M), (b, 0.0, left + width, STOREY_M), (a, d, b, STOREY_M)):
        side.panel(batch, *piece, look.wall)
    side.hollow(batch, a, 0.0, b, d, 0.2, look.trim)
    side.panel(batch, a, 0.0, b, d, look.trim, -0.2, 0.25)
    side.panel(batch, a + 0.09, 0.14, b - 0.09, 2.2, look.door, -0.18, 0.25)
    for x in (a + 0.2, 0.5 * (a + b) + 0.06):
        for low, high in ((0.35, 1.0), (1.15, 2.05)):
            side.panel(batch, x, low, x + 0.34, high, times(look.door, 1.35), -0.17, 0.25)
    side.panel(
        batch, a + 0.09, 2.28, b - 0.09, d - 0.07, [GLASS_LOW, GLASS_LOW, GLASS_HIGH, GLASS_HIGH], -0.18, 0.25
    )
    side.ledge(batch, a - 0.18, d, b + 0.18, d + 0.22, 0.16, look.trim)
    for x in (a - 0.18, b):
        side.ledge(batch, x, 0.0, x + 0.18, d, 0.07, look.trim)
    side.ledge(batch, a - 0.1, 0.0, b + 0.1, 0.13, 0.13, STONE)


def shop_bay(
    batch: Batch, side: Side, left: float, width: float, door: bool, look: Look, rng: np.random.Generator
) -> None:
    """A shop window or its door, a board above, an awning."""
    assert look.awning is not None
    a, b, d = left + 0.22, left + width - 0.22, 2.45
    low = 0.0 if door else 0.55
    frame = mix(look.door, (0.02, 0.02, 0.02), 0.25)
    for piece in ((left, 0.0, a, STOREY_M), (b, 0.0, left + width, STOREY_M), (a, d, b, STOREY_M)):
        side.panel(batch, *piece, look.trim)
    if not door:
        side.panel(batch, a, 0.0, b, low, frame)
    side.hollow(batch, a, low, b, d, 0.22, frame)
    side.panel(batch, a, low, b, d, frame, -0.22, 0.27)
    warm, cool = linear("#ffdf9e"), linear("#8fb0c2")
    inside = [times(warm, 0.34), times(warm, 0.38), times(cool, 0.9), times(cool, 0.8)]
    panes = 2 if door else 3
    for i in range(panes):
        x, y = a + 0.07 + i * (b - a - 0.07) / panes, a + (i + 1) * (b - a - 0.07) / panes
        side.panel(batch, x, low + 0.1, y, d - 0.08, inside, -0.2, 0.27)
        if not door:
            thing = [linear(c) for c in ("#d8674f", "#e8b04a", "#6f9f7c", "#f0e3cf", "#7f93b8")][
                int(rng.integers(5))
            ]
            side.panel(
                batch, x + 0.12, low + 0.1, y - 0.12, low + float(rng.uniform(0.35, 0.8)), thing, -0.19, 0.27
            )
    side.ledge(
        batch, left + 0.1, d + 0.1, left + width - 0.1, d + 0.58, 0.07, mix(look.door, look.awning, 0.25)
    )
    if not door:
        awning(batch, side, a - 0.1, b + 0.1, d + 0.12, look.awning)


def awning(batch: Batch, side: Side, left: float, right: float, high: float, colour: Rgb) -> None:
    """Striped cloth that slopes out over the pavement, above everybody's head."""
    stripes = 7
    deep, drop = 0.95, 0.5
    for i in range(stripes):
        a, b = (left + (right - left) * k / stripes for k in (i, i + 1))
        ink = colour if i % 2 == 0 else CREAM
        f = side.at
        batch.quad(
            [f(a, high - drop, deep), f(b, high - drop, deep), f(b, high, 0.02), f(a, high, 0.02)], ink
        )
        batch.quad(
            [f(a, high, 0.0), f(b, high, 0.0), f(b, high - drop, deep), f(a, high - drop, deep)],
            times(ink, 0.6),
        )
        skirt = [
            f(a, high - drop - 0.17, deep),
            f(b, high - drop - 0.17, deep),
            f(b, high - drop, deep),
            f(a, high - drop, deep),
        ]
        batch.quad(skirt, times(ink, 0.95))


def roof(batch: Batch, building: Building, look: Look, rng: np.random.Generator) -> None:
    """A gable, a mansard or a flat roof with a parapet; chimneys."""
    s, w, n, e, top = building.box
    if building.gabled:
        gable(batch, building, look, rng)
    elif rng.random() < 0.55:
        mansard(batch, (s, w, n, e), top - 0.2, SLATE[int(rng.integers(len(SLATE)))], look, rng)
    else:
        flat = linear("#a9a49b")
        batch.quad([(w, s, top), (e, s, top), (e, n, top), (w, n, top)], flat)
        batch.box((w + 2.0, s + 2.0, top), (w + 5.0, s + 4.5, top + 2.2), times(look.wall, 0.9))
    for _ in range(2):
        x, y = float(rng.uniform(w + 1.5, e - 2.5)), float(rng.uniform(s + 1.5, n - 2.5))
        batch.box(
            (x, y, top), (x + 0.8, y + 0.6, top + (3.4 if not building.gabled else 4.6)), linear("#a5705a")
        )


def gable(batch: Batch, building: Building, look: Look, rng: np.random.Generator) -> None:
    """Two slopes of tiles, the ridge along the longer side, eaves all round."""
    s, w, n, e, top = building.box
    ink = TILES[int(rng.integers(len(TILES)))]
    o, low = 0.45, top - 0.05
    if e - w >= n - s:
        m, h = 0.5 * (s + n), top + 0.42 * (n - s)
        ends = [[(w, n, top), (w, s, top), (w, m, h)], [(e, s, top), (e, n, top), (e, m, h)]]
        slopes = [
            [(w - o, s - o, low), (e + o, s - o, low), (e + o, m, h), (w - o, m, h)],
            [(e + o, n + o, low), (w - o, n + o, low), (w - o, m, h), (e + o, m, h)],
        ]
    else:
        m, h = 0.5 * (w + e), top + 0.42 * (e - w)
        ends = [[(w, s, top), (e, s, top), (m, s, h)], [(e, n, top), (w, n, top), (m, n, h)]]
        slopes = [
            [(e + o, s - o, low), (e + o, n + o, low), (m, n + o, h), (m, s - o, h)],
            [(w - o, n + o, low), (w - o, s - o, low), (m, s - o, h), (m, n + o, h)],
        ]
    for a, b, c in ends:
        batch.quad([a, b, c, c], look.wall)
    for corners in slopes:
        tiled(batch, corners, ink)
        batch.quad([corners[1], corners[0], corners[3], corners[2]], times(ink, 0.45))


def tiled(batch: Batch, corners: list[Point], ink: Rgb) -> None:
    """A slope in courses of slightly different colour."""
    low_a, low_b, high_b, high_a = (np.array(c) for c in corners)
    courses = 9
    for i in range(courses):
        p, q = i / courses, (i + 1) / courses
        shade = times(ink, 0.9 + 0.12 * (i % 2) + 0.08 * p)
        lift = np.array([0.0, 0.0, 0.05])
        ring = [low_a + (high_a - low_a) * p + lift, low_b + (high_b - low_b) * p + lift,
                low_b + (high_b - low_b) * q, low_a + (high_a - low_a) * q]  # fmt: skip
        batch.quad([_point(c) for c in ring], shade)


def mansard(
    batch: Batch,
    edges: tuple[float, float, float, float],
    top: float,
    ink: Rgb,
    look: Look,
    rng: np.random.Generator,
) -> None:
    """Steep slate sides with dormers and a flat top."""
    s, w, n, e = edges
    rise, inset = 2.6, 1.0
    around = sides(Box(s, w, n, e, top))
    for side in around.values():
        length = side.length_m
        low = [side.at(0.0, top + 0.2), side.at(length, top + 0.2)]
        high = [side.at(length - inset, top + rise, -inset), side.at(inset, top + rise, -inset)]
        batch.quad([*low, *high], [ink, ink, times(ink, 1.12), times(ink, 1.12)])
        for along in np.arange(2.0, length - 2.0, 3.4):
            a, b, base, head = along - 0.55, along + 0.55, top + 0.55, top + 2.0
            f = side.at
            side.panel(batch, a, base, b, head, look.trim, -0.1, 0.2)
            side.panel(batch, a + 0.12, base + 0.12, b - 0.12, head - 0.1, glass(rng), -0.08, 0.2)
            batch.quad(
                [
                    f(a - 0.1, head, 0.0),
                    f(b + 0.1, head, 0.0),
                    f(b + 0.1, head + 0.25, -1.0),
                    f(a - 0.1, head + 0.25, -1.0),
                ],
                times(ink, 0.9),
            )
            batch.quad(
                [f(b, base, -0.1), f(b, base, -0.5), f(b, head, -1.0), f(b, head, -0.1)],
                times(look.trim, 0.85),
            )
            batch.quad(
                [f(a, base, -0.5), f(a, base, -0.1), f(a, head, -0.1), f(a, head, -1.0)],
                times(look.trim, 0.85),
            )
    x, y, z = inset, inset, top + rise
    batch.quad([(w + x, s + y, z), (e - x, s + y, z), (e - x, n - y, z), (w + x, n - y, z)], times(ink, 0.9))


def _point(place: np.ndarray) -> Point:
    x, y, z = place.tolist()
    return x, y, z
