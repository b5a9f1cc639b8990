"""Heart: the town as data: streets, blocks, buildings, walls, trees, lamps, targets; all from a seed.

Metres in *n*: x north, y east, heights up. The square with the landmark is at the origin; streets
run north–south and east–west between blocks. Steering collides with it, the scene draws it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from app.motion.basics import Floats

BLOCK_M = 36.0
STREET_M = 12.0  # from kerb to kerb, pavements outside
PAVEMENT_M = 3.0
_PITCH_M = BLOCK_M + STREET_M + 2 * PAVEMENT_M
_SIDE = 5  # blocks along each side; the middle one is the square


class Box(NamedTuple):
    """An upright box on the ground: southern, western, northern, eastern edge, and its height, m."""

    south: float
    west: float
    north: float
    east: float
    height_m: float


class Building(NamedTuple):
    """A house: its walls, which of the colours of the scene, storeys and roof."""

    box: Box
    colour: int
    storeys: int
    gabled: bool


class Street(NamedTuple):
    """The roadway between two kerbs."""

    box: Box
    along_north: bool


class Place(NamedTuple):
    """A tree, a lamp, a target: where, and how large (radius of the trunk, the pole, the circle), m."""

    north: float
    east: float
    radius_m: float


@dataclass(frozen=True)
class Town:
    """All of it. What blocks the way is ``solid``."""

    seed: int
    half_m: float  # the edge of town: |north|, |east| up to here
    blocks: tuple[Box, ...]
    streets: tuple[Street, ...]
    buildings: tuple[Building, ...]
    landmark: Box
    trees: tuple[Place, ...]
    lamps: tuple[Place, ...]
    targets: tuple[Place, ...]
    benches: tuple[Box, ...] = ()
    planters: tuple[Box, ...] = ()

    @cached_property
    def solid(self) -> Floats:
        """Walls that stop a walker: boxes [n, 4] as south, west, north, east."""
        poles = [(p.north - p.radius_m, p.east - p.radius_m, p.north + p.radius_m, p.east + p.radius_m)
                 for p in (*self.trees, *self.lamps)]  # fmt: skip
        houses = (b.box for b in self.buildings)
        walls = [box[:4] for box in (*houses, self.landmark, *self.benches, *self.planters)]
        return np.array([*walls, *poles], dtype=np.float64).reshape(-1, 4)

    def free(self, north: float, east: float, radius_m: float) -> bool:
        """Whether a circle there touches no wall and is inside the town."""
        if max(abs(north), abs(east)) > self.half_m - radius_m:
            return False
        s, w, n, e = self.solid.T
        away_n, away_e = north - np.clip(north, s, n), east - np.clip(east, w, e)
        return bool(np.all(np.hypot(away_n, away_e) >= radius_m))


def make_town(seed: int = 0, targets: int = 8) -> Town:
    """The same seed gives the same town. Every target can be stood on."""
    rng = np.random.default_rng([seed, 0x70])
    centres = np.array([(i - _SIDE // 2) * _PITCH_M for i in range(_SIDE)], dtype=np.float64)
    half = 0.5 * _SIDE * _PITCH_M
    blocks, buildings, trees = [], [], []
    for north in centres.tolist():
        for east in centres.tolist():
            block = _around(north, east, 0.5 * BLOCK_M + PAVEMENT_M, 0.15)
            blocks.append(block)
            if north == 0.0 and east == 0.0:
                trees += _square_trees(rng)
            else:
                buildings += _buildings(rng, north, east)
                trees += _street_trees(rng, north, east)
    town = Town(
        seed, half, tuple(blocks), _streets(centres, half), tuple(buildings), _around(0.0, 0.0, 2.5, 18.0),
        tuple(trees), _lamps(centres), (), _benches(), _planters(),
    )  # fmt: skip
    return _with_targets(town, rng, targets)


def _around(north: float, east: float, half_m: float, height_m: float) -> Box:
    return Box(north - half_m, east - half_m, north + half_m, east + half_m, height_m)


def _streets(centres: Floats, half_m: float) -> tuple[Street, ...]:
    """One street between every two rows of blocks, each way."""
    between = 0.5 * (centres[1:] + centres[:-1])
    streets = []
    for middle in between.tolist():
        low, high = middle - 0.5 * STREET_M, middle + 0.5 * STREET_M
        streets.append(Street(Box(-half_m, low, half_m, high, 0.0), True))
        streets.append(Street(Box(low, -half_m, high, half_m, 0.0), False))
    return tuple(streets)


def _buildings(rng: np.random.Generator, north: float, east: float) -> list[Building]:
    """A block is cut in four by an alley or not, each part a house a little way back from the pavement."""
    houses = []
    half = 0.5 * BLOCK_M
    cut = float(rng.uniform(-4.0, 4.0))
    alley = float(rng.choice([0.0, 3.0]))
    for south_half in (True, False):
        for west_half in (True, False):
            back = rng.uniform(0.0, 2.0, 2)
            s, n = (-half + back[0], cut - alley) if south_half else (cut + alley, half - back[0])
            w, e = (-half + back[1], -alley) if west_half else (alley, half - back[1])
            storeys = int(rng.integers(2, 8))
            box = Box(
                north + float(s), east + float(w), north + float(n), east + float(e), 3.2 * storeys + 0.8
            )
            houses.append(
                Building(box, int(rng.integers(8)), storeys, storeys < 4 and bool(rng.random() < 0.7))
            )
    return houses


def _square_trees(rng: np.random.Generator) -> list[Place]:
    """A ring of trees around the landmark, with a way through from each side of the square."""
    angles = (np.arange(12) + 0.5) * (2.0 * np.pi / 12.0) + rng.uniform(-0.06, 0.06, 12)
    return [Place(float(13.0 * np.cos(a)), float(13.0 * np.sin(a)), 0.25) for a in angles]


def _street_trees(rng: np.random.Generator, north: float, east: float) -> list[Place]:
    """A row of trees near the kerb on some sides of a block."""
    off, along = 0.5 * BLOCK_M + PAVEMENT_M - 0.9, (-12.5, -4.2, 4.2, 12.5)
    sides = [(sign * off, None) for sign in (-1.0, 1.0)] + [(None, sign * off) for sign in (-1.0, 1.0)]
    rows = [side for side in sides if rng.random() < 0.6]
    return [
        Place(north + (place if n is None else n), east + (place if e is None else e), 0.2)
        for n, e in rows
        for place in (np.array(along) + rng.uniform(-0.5, 0.5, 4)).tolist()
    ]


def _benches() -> tuple[Box, ...]:
    """Benches round the landmark, none in the way from a side of the square."""
    places = [(s * 8.0, t * 4.5, 0.3, 0.9) for s in (-1.0, 1.0) for t in (-1.0, 1.0)]
    places += [(t * 4.5, s * 8.0, 0.9, 0.3) for s in (-1.0, 1.0) for t in (-1.0, 1.0)]
    return tuple(Box(n - a, e - b, n + a, e + b, 0.45) for n, e, a, b in places)


def _planters() -> tuple[Box, ...]:
    """Flower beds in the corners of the square."""
    return tuple(
        Box(s * 16.5 - 1.6, t * 16.5 - 1.6, s * 16.5 + 1.6, t * 16.5 + 1.6, 0.5)
        for s in (-1.0, 1.0)
        for t in (-1.0, 1.0)
    )


def _lamps(centres: Floats) -> tuple[Place, ...]:
    """Two lamps on the pavement of each block, at opposite corners."""
    off = 0.5 * BLOCK_M + PAVEMENT_M - 0.6
    return tuple(
        Place(north + sign * off, east + sign * off, 0.12)
        for north in centres.tolist()
        for east in centres.tolist()
        for sign in (-1.0, 1.0)
    )


def _with_targets(town: Town, rng: np.random.Generator, count: int) -> Town:
    """Targets on streets, none close to another or to the start."""
    chosen: list[Place] = []
    while len(chosen) < count:
        street = town.streets[int(rng.integers(len(town.streets)))].box
        north, east = (
            float(rng.uniform(street.south, street.north)),
            float(rng.uniform(street.west, street.east)),
        )
        others = [(0.0, 0.0), *((p.north, p.east) for p in chosen)]
        apart = all(np.hypot(north - a, east - b) > 25.0 for a, b in others)
        if apart and town.free(north, east, 1.5):
            chosen.append(Place(north, east, 1.5))
    return replace(town, targets=tuple(chosen))
