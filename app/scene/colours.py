"""Edge, scene: every colour of the page, safe for the colour-blind (Okabe and Ito's set)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.motion.basics import Role

Rgb = tuple[int, int, int]

BLUE: Rgb = (0, 114, 178)
ORANGE: Rgb = (230, 159, 0)
GREEN: Rgb = (0, 158, 115)
SWING: Rgb = (240, 228, 66)
FOOT: dict[Role, Rgb] = {Role.LEFT: BLUE, Role.RIGHT: ORANGE, Role.FOOT: BLUE, Role.OTHER: (86, 180, 233)}
CANDIDATE: Rgb = (214, 96, 196)
TRUTH: Rgb = (60, 170, 120)
OWN: Rgb = (172, 178, 188)  # what a sensor says of itself


@dataclass(frozen=True)
class Theme:
    """The colours that differ between dark and light."""

    sky: Rgb
    horizon: Rgb
    cell: Rgb
    section: Rgb
    ink: Rgb  # compass and start mark
    accent: Rgb  # north


DARK = Theme(
    sky=(13, 17, 23), horizon=(30, 40, 54), cell=(66, 80, 98), section=(104, 124, 150),
    ink=(150, 164, 182), accent=(240, 110, 90),
)  # fmt: skip
LIGHT = Theme(
    sky=(226, 234, 243), horizon=(248, 250, 252), cell=(214, 220, 228),
    section=(176, 187, 200), ink=(92, 106, 124), accent=(206, 66, 48),
)  # fmt: skip


def theme(dark: bool) -> Theme:
    """Dark or light."""
    return DARK if dark else LIGHT


def shade(colour: Rgb, factor: float) -> Rgb:
    """Darker below 1; above 1, as far towards white as the part over 1."""
    if factor <= 1.0:
        return _rgb(np.array(colour) * factor)
    return blend(colour, (255, 255, 255), factor - 1.0)


def blend(one: Rgb, other: Rgb, part: float) -> Rgb:
    """From ``one`` (part 0) to ``other`` (part 1)."""
    return _rgb(np.array(one) * (1.0 - part) + np.array(other) * part)


def css(colour: Rgb, alpha: float = 1.0) -> str:
    """As a style sheet writes it."""
    return f"rgba({colour[0]},{colour[1]},{colour[2]},{alpha:g})"


def _rgb(values: NDArray[np.float64]) -> Rgb:
    red, green, blue = np.clip(np.rint(values), 0, 255).astype(int).tolist()
    return red, green, blue


# viridis at nine even places (its published table), the rest between them by straight lines.
_VIRIDIS = np.array([
    (68, 1, 84), (71, 44, 122), (59, 81, 139), (44, 113, 142), (33, 144, 141),
    (39, 173, 129), (92, 200, 99), (170, 220, 50), (253, 231, 37),
], dtype=np.float64)  # fmt: skip


def viridis(values: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Values from 0 to 1, any shape → RGB, one axis more; what is not finite is grey."""
    known = np.isfinite(values)
    place = np.clip(np.where(known, values, 0.0), 0.0, 1.0)
    stops = np.linspace(0.0, 1.0, len(_VIRIDIS))
    rgb = np.stack([np.interp(place, stops, _VIRIDIS[:, i]) for i in range(3)], axis=-1)
    rgb[~known] = 128.0
    result: NDArray[np.uint8] = np.rint(rgb).astype(np.uint8)
    return result
