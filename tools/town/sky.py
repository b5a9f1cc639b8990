"""Tool, town: the sky: a half ball with a picture of haze, blue, soft clouds and a glow round the sun."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import zoom

from tools.town.batch import Floats
from tools.town.light import SUN

#: What far things fade to, and the sky at the horizon: sRGB.
HAZE = np.array([214.0, 226.0, 234.0])
_BLUE, _HIGH = np.array([122.0, 174.0, 224.0]), np.array([64.0, 128.0, 204.0])
WIDTH, HEIGHT = 2048, 512
LOWEST_RAD, RADIUS_M = -0.12, 600.0


def picture(rng: np.random.Generator) -> NDArray[np.uint8]:
    """[HEIGHT, WIDTH, 3]: rows from the zenith down to below the horizon, columns by azimuth."""
    turn = np.linspace(0.0, 2 * np.pi, WIDTH, endpoint=False)[None, :]
    high = np.linspace(0.5 * np.pi, LOWEST_RAD, HEIGHT)[:, None]
    up = np.clip(np.sin(high), 0.0, 1.0)
    way = np.stack(
        np.broadcast_arrays(np.cos(high) * np.sin(turn), np.cos(high) * np.cos(turn), np.sin(high)), -1
    )
    part = np.clip(up / 0.45, 0, 1)[..., None] ** 0.62
    deep = np.clip((up - 0.3) / 0.7, 0, 1)[..., None]
    colour = HAZE + (_BLUE - HAZE) * part
    colour = colour + (_HIGH - colour) * deep * 0.8
    toward = np.clip(way @ SUN, 0.0, 1.0)[..., None]
    glow = 0.5 * toward**6 + 0.5 * toward**60
    colour = colour + (np.array([255.0, 240.0, 214.0]) - colour) * np.clip(0.55 * glow, 0, 1)
    colour = colour + (255.0 - colour) * np.clip((toward - 0.9992) / 0.0004, 0, 1)
    return np.asarray(np.clip(clouds(colour, way, up, toward, rng), 0, 255), dtype=np.uint8)


def clouds(colour: Floats, way: Floats, up: Floats, toward: Floats, rng: np.random.Generator) -> Floats:
    """Fair-weather clouds on a plane high above, lit from the sun's side."""
    x, y = (way[..., i] / (up + 0.14) for i in (0, 1))
    field, shift = (
        sum(
            fog(rng_of, x + d * SUN[0], y + d * SUN[1], 0.55 * 2**k) / 1.9**k
            for k, rng_of in enumerate(seeds(rng))
        )
        for d in (0.0, 0.22)
    )
    cover = np.clip((np.asarray(field) - 0.28) / 0.5, 0, 1)
    cover = cover * cover * (3 - 2 * cover) * np.clip((up - 0.035) / 0.12, 0, 1)
    shade = np.clip(0.5 + 1.5 * (np.asarray(field) - np.asarray(shift)), 0, 1)[..., None]
    white = np.array([206.0, 214.0, 226.0]) * (1 - shade) + np.array([255.0, 252.0, 246.0]) * shade
    return np.asarray(colour + (white - colour) * 0.9 * cover[..., None])


_TABLES: list[Floats] = []


def seeds(rng: np.random.Generator) -> list[Floats]:
    """The same five tables of random numbers for every call."""
    if not _TABLES:
        _TABLES.extend(rng.uniform(-1.0, 1.0, (64, 64)) for _ in range(5))
    return _TABLES


def fog(table: Floats, x: Floats, y: Floats, scale: float) -> Floats:
    """Smooth noise: random numbers on a lattice, drawn soft between."""
    u, v = x * scale * 2.0, y * scale * 2.0
    i, j = np.floor(u).astype(int), np.floor(v).astype(int)
    p, q = u - i, v - j
    p, q = p * p * (3 - 2 * p), q * q * (3 - 2 * q)
    a, b = table[i % 64, j % 64], table[(i + 1) % 64, j % 64]
    c, d = table[i % 64, (j + 1) % 64], table[(i + 1) % 64, (j + 1) % 64]
    return np.asarray((a + (b - a) * p) + ((c + (d - c) * p) - (a + (b - a) * p)) * q)


def ball() -> tuple[Floats, Floats, NDArray[np.int64]]:
    """Vertices (x east, y north, z up), picture coordinates [n, 2], faces seen from inside."""
    columns, rows = 48, 14
    vertices, places = [], []
    for r in range(rows + 1):
        part = (r / rows) ** 1.4
        high = LOWEST_RAD + (0.5 * np.pi - LOWEST_RAD) * part
        for c in range(columns + 1):
            turn = 2 * np.pi * c / columns
            vertices.append(RADIUS_M * np.array(
                [np.cos(high) * np.sin(turn), np.cos(high) * np.cos(turn), np.sin(high)]))  # fmt: skip
            places.append((c / columns, (0.5 * np.pi - high) / (0.5 * np.pi - LOWEST_RAD)))
    faces = []
    for r in range(rows):
        for c in range(columns):
            a = r * (columns + 1) + c
            b, d = a + 1, a + columns + 1
            faces += [[a, b, d], [b, d + 1, d]]
    return np.array(vertices), np.array(places), np.array(faces)


def mottle(size: int, rng: np.random.Generator) -> Floats:
    """Fine and coarse spots for the ground [size, size], about 1."""
    total = np.ones((size, size))
    for cells, depth in ((24, 0.05), (96, 0.04), (384, 0.035)):
        total += depth * zoom(rng.uniform(-1, 1, (cells, cells)), size / cells, order=1)[:size, :size]
    return total + rng.uniform(-0.035, 0.035, (size, size))
