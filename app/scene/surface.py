"""Edge, scene: the surface "find gains" found, as a picture with axes: SVG around a small PNG."""

from __future__ import annotations

import base64
import struct
import zlib

import numpy as np
from numpy.typing import NDArray

from app.motion.estimate import Sweep
from app.scene import words
from app.scene.colours import viridis

WIDTH, HEIGHT, LEFT, BELOW, RIGHT, TOP = 250, 150, 44, 34, 58, 16


def png(rgb: NDArray[np.uint8]) -> bytes:
    """An image [h, w, 3] as PNG."""
    height, width = rgb.shape[:2]
    rows = np.concatenate([np.zeros((height, 1), np.uint8), rgb.reshape(height, -1)], axis=1)
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + b"".join([
        _chunk(b"IHDR", head), _chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)), _chunk(b"IEND", b""),
    ])  # fmt: skip


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def brightness(closure_m: NDArray[np.float64]) -> NDArray[np.float64]:
    """0 (worst) to 1 (best), by rank: a few bad corners must not wash out the valley."""
    flat = closure_m.ravel()
    place = np.empty(flat.size)
    place[np.argsort(flat, kind="stable")] = np.linspace(1.0, 0.0, flat.size)
    place[~np.isfinite(flat)] = np.nan
    return place.reshape(closure_m.shape)


def picture(sweep: Sweep) -> str:
    """The heat map k_s × k_d, axes, colour key and the minimum's mark, as HTML."""
    rgb = viridis(brightness(sweep.closure_m)).swapaxes(0, 1)[::-1]  # k_s to the right, k_d upward
    data = base64.b64encode(png(np.ascontiguousarray(rgb))).decode()
    box = f"0 0 {LEFT + WIDTH + RIGHT} {TOP + HEIGHT + BELOW}"
    return (
        f'<div class="ss-surface"><svg viewBox="{box}" role="img" aria-label="Distance to start over gains">'
        f'<image x="{LEFT}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" preserveAspectRatio="none"'
        f' style="image-rendering:pixelated" href="data:image/png;base64,{data}"/>'
        f"{_axes(sweep)}{_key(sweep)}{_mark(sweep)}</svg>{sentence(sweep)}</div>"
    )


def _mark(sweep: Sweep) -> str:
    """A ring round the best pair."""
    x = LEFT + _place(sweep.gains_stance, sweep.best[0], WIDTH)
    y = TOP + HEIGHT - _place(sweep.gains_swing, sweep.best[1], HEIGHT)
    ring = f'<circle cx="{x:.1f}" cy="{y:.1f}" r="6" fill="none"'
    return f'{ring} stroke="#000" stroke-width="4"/>{ring} stroke="#fff" stroke-width="2"/>'


def sentence(sweep: Sweep) -> str:
    """The best gains in words."""
    closure = words.number(_finite_min(sweep.closure_m), 3)
    return (
        f'<div class="ss-best">Best: <b>k_s {words.number(sweep.best[0], 2)} 1/s</b>,'
        f" <b>k_d {words.number(sweep.best[1], 2)} 1/s</b>, ending {closure} m from the start.</div>"
    )


def _finite_min(values: NDArray[np.float64]) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.min()) if finite.size else float("nan")


def _place(axis: NDArray[np.float64], value: float, pixels: int) -> float:
    """The middle of the value's cell."""
    part = float(np.interp(value, axis, np.arange(len(axis))))
    return (part + 0.5) / len(axis) * pixels


def _axes(sweep: Sweep) -> str:
    texts = []
    for value in _ticks(sweep.gains_stance):
        x = LEFT + _place(sweep.gains_stance, value, WIDTH)
        texts.append(f'<text x="{x:.1f}" y="{TOP + HEIGHT + 13}" text-anchor="middle">{value:.3g}</text>')
    for value in _ticks(sweep.gains_swing):
        y = TOP + HEIGHT - _place(sweep.gains_swing, value, HEIGHT)
        texts.append(f'<text x="{LEFT - 5}" y="{y + 3.5:.1f}" text-anchor="end">{value:.3g}</text>')
    below = f'x="{LEFT + WIDTH / 2}" y="{TOP + HEIGHT + 29}"'
    beside = f'transform="translate(11 {TOP + HEIGHT / 2}) rotate(-90)"'
    for place, label in ((below, "stance gain k_s, 1/s"), (beside, "swing gain k_d, 1/s")):
        texts.append(f'<text {place} text-anchor="middle">{label}</text>')
    return "".join(texts)


def _ticks(axis: NDArray[np.float64]) -> list[float]:
    return [float(axis[i]) for i in np.unique(np.linspace(0, len(axis) - 1, 5).round().astype(int))]


def _key(sweep: Sweep) -> str:
    """Colours against metres: best on top."""
    column = viridis(np.linspace(1, 0, 32))[:, None]
    data = base64.b64encode(png(column)).decode()
    finite = np.sort(sweep.closure_m[np.isfinite(sweep.closure_m)].ravel())
    x = LEFT + WIDTH + 8
    bar = (
        f'<image x="{x}" y="{TOP}" width="9" height="{HEIGHT}" preserveAspectRatio="none"'
        f' href="data:image/png;base64,{data}"/>'
    )
    if not finite.size:
        return bar
    marks = ((0.0, finite[0]), (0.5, finite[len(finite) // 2]), (1.0, finite[-1]))
    return (
        bar
        + f'<text x="{x}" y="{TOP - 6}">to start</text>'
        + "".join(
            f'<text x="{x + 13}" y="{TOP + part * (HEIGHT - 8) + 8:.1f}">{value:.2g} m</text>'
            for part, value in marks
        )
    )
