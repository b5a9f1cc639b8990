"""Edge, scene: the drawn town from assets/town.npz (tools/make_town.py): its light is baked in.

One mesh for the ground, one for each block, one for what lies beyond the edge, one for the sky: so
much of it as lies in view is drawn, in at most 28 draw calls and without lights or shadow maps.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.scene.glb import Part, glb

ASSET = Path(__file__).resolve().parents[2] / "assets" / "town.npz"
SKY = "sky"
#: Where fog begins and where nothing is seen any more, m.
FOG_M = (35.0, 480.0)


@cache
def parts() -> dict[str, Part]:
    """All meshes by name, in *n*: north, east, down from the middle of the square, m."""
    with np.load(ASSET) as made:
        names = dict.fromkeys(key.partition(".")[0] for key in made)
        return {
            name: _part(name, {key: made[f"{name}.{key}"] for key in _keys(made, name)}) for name in names
        }


def haze() -> tuple[int, int, int]:
    """What far things fade to, sRGB: the sky at the horizon."""
    with np.load(ASSET) as made:
        red, green, blue = made["sky.haze"].tolist()
    return red, green, blue


def town_file() -> bytes:
    """The town without its sky, as binary glTF."""
    return glb([part for name, part in parts().items() if name != SKY])


def sky_file() -> bytes:
    """The sky, as binary glTF."""
    return glb([parts()[SKY]])


def _keys(made: Any, name: str) -> list[str]:
    return [key.partition(".")[2] for key in made if key.partition(".")[0] == name]


def _part(name: str, table: dict[str, NDArray[Any]]) -> Part:
    vertices = (table["vertices"] * float(table["step"]) + table["centre"]).astype(np.float32)
    coded = table.get("colours")
    colours = np.ones_like(vertices) if coded is None else ((coded / 255.0) ** 2).astype(np.float32)
    places = table.get("places")
    if "reach_m" in table:  # the light map lies over the whole town: west to east, north to south
        reach = float(table["reach_m"])
        places = np.stack([vertices[:, 1] + reach, reach - vertices[:, 0]], axis=1) / (2.0 * reach)
    picture = table["picture"].tobytes() if "picture" in table else None
    return Part(name, vertices, table["faces"], colours, places, picture)
