"""Tool: builds the drawn town from app/world.py with its light baked in: assets/town.npz.

Run ``python tools/make_town.py`` after a change of app/world.py or of tools/town. Same seed, same town.
"""

from __future__ import annotations

import io
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from app.world import Box, Town, make_town
from tools.town import green, houses, sky, streets
from tools.town.batch import Batch, Floats
from tools.town.light import Sun

ASSET = Path(__file__).resolve().parents[1] / "assets" / "town.npz"
LIGHT_MAP = 2048
#: The light map holds light up to this; ground colours are multiplied by it.
BRIGHTEST = 1.25


def main() -> None:
    """Build everything, light it, write it."""
    began, town, rng = time.perf_counter(), make_town(0), np.random.default_rng(7)
    batches, balls = build(town, rng)
    sun = Sun(occluders(town), np.array(balls), town.half_m)
    made: dict[str, NDArray[np.generic]] = {}
    for name, batch in batches.items():
        pack(made, name, batch, None if name == "ground" else sun)
    pack_sky(made, rng)
    made["ground.picture"] = jpeg(light_map(sun, town.half_m, rng), 86)
    made["ground.reach_m"] = np.array(town.half_m)
    np.savez_compressed(ASSET, **made)  # type: ignore[arg-type]
    triangles = sum(len(made[key]) for key in made if key.endswith(".faces"))
    seconds = time.perf_counter() - began
    size = ASSET.stat().st_size / 1e6
    print(f"{ASSET.name}: {triangles} triangles in {len(batches) + 1} meshes, {size:.2f} MB, {seconds:.0f} s")


def build(town: Town, rng: np.random.Generator) -> tuple[dict[str, Batch], list[Floats]]:
    """Every block a batch, the ground and the outskirts one each; and the crowns that throw shadows."""
    batches = {
        "ground": Batch(),
        "outskirts": Batch(),
        **{f"block{i}": Batch() for i in range(len(town.blocks))},
    }
    streets.ground(batches["ground"], town)
    streets.outskirts(batches["outskirts"], town, rng)

    def block_of(north: float, east: float) -> Batch:
        away = [
            max(abs(north - 0.5 * (b.south + b.north)), abs(east - 0.5 * (b.west + b.east)))
            for b in town.blocks
        ]
        return batches[f"block{int(np.argmin(away))}"]

    for building in town.buildings:
        b = building.box
        batch = block_of(0.5 * (b.south + b.north), 0.5 * (b.west + b.east))
        block = next(k for k in town.blocks if k.south < b.south < k.north and k.west < b.west < k.east)
        houses.house(batch, building, fronts(b, block), touching(town, b), rng)
    balls: list[Floats] = []
    for place in town.trees:
        square = np.hypot(place.north, place.east) < 16.0
        balls += green.tree(
            block_of(place.north, place.east),
            place,
            rng,
            0.12,
            0.92 if square else 0.8,
            4 if square else 3,
            2 if square else 1,
        )
    for place in green.around_town(town, rng):
        balls += green.tree(batches["outskirts"], place, rng, 0.0, float(rng.uniform(1.6, 2.6)), 2)
    for place in town.lamps:
        green.lamp(block_of(place.north, place.east), place)
    for box in town.benches:
        green.bench(block_of(box.south, box.west), box)
    for box in town.planters:
        green.planter(block_of(box.south, box.west), box, rng)
    green.tower(block_of(0.0, 0.0), town.landmark)
    return batches, balls


def fronts(box: Box, block: Box) -> set[str]:
    """The sides that face a street: within the houses' set-back of the pavement."""
    away = {"south": box.south - block.south, "west": box.west - block.west,
            "north": block.north - box.north, "east": block.east - box.east}  # fmt: skip
    return {name for name, metres in away.items() if metres < 5.5}


def touching(town: Town, box: Box) -> set[str]:
    """The sides that lie against another house along most of their length."""
    found = set()
    for other in (b.box for b in town.buildings):
        if other == box or other.height_m < box.height_m:
            continue
        across = other.west <= box.west + 2.1 and other.east >= box.east - 2.1
        along = other.south <= box.south + 2.1 and other.north >= box.north - 2.1
        if across and abs(other.north - box.south) < 0.05:
            found.add("south")
        if across and abs(other.south - box.north) < 0.05:
            found.add("north")
        if along and abs(other.east - box.west) < 0.05:
            found.add("west")
        if along and abs(other.west - box.east) < 0.05:
            found.add("east")
    return found


def occluders(town: Town) -> Floats:
    """What throws shadows, as boxes [n, 6]: low x, y, z, then high; gables and the spire as smaller boxes."""
    rows = []
    for building in town.buildings:
        s, w, n, e, top = building.box
        rows.append((w, s, 0.0, e, n, top))
        if building.gabled:
            for share in (0.25, 0.5, 0.75):
                if e - w >= n - s:
                    cut, high = share * 0.5 * (n - s), 0.42 * (n - s)
                    rows.append((w, s + cut, top, e, n - cut, top + share * high))
                else:
                    cut, high = share * 0.5 * (e - w), 0.42 * (e - w)
                    rows.append((w + cut, s, top, e - cut, n, top + share * high))
    s, w, n, e, top = town.landmark
    rows.append((w, s, 0.0, e, n, top))
    for k in range(5):
        rows.append((w + 0.5 * k, s + 0.5 * k, top, e - 0.5 * k, n - 0.5 * k, top + 1.0 + 1.4 * k))
    for box in town.benches:
        rows.append((box.west, box.south, box.height_m - 0.06, box.east, box.north, box.height_m))
    for box in town.planters:
        rows.append((box.west, box.south, 0.1, box.east, box.north, box.height_m))
    for place in (*town.trees, *town.lamps):
        r = 0.5 * place.radius_m
        rows.append((place.east - r, place.north - r, 0.0, place.east + r, place.north + r, 3.7))
    return np.array(rows)


def pack(made: dict[str, NDArray[np.generic]], name: str, batch: Batch, sun: Sun | None) -> None:
    """A batch as small arrays in *n*: places in steps about a centre, colours as roots in bytes."""
    places, paint = np.concatenate(batch.places), np.concatenate(batch.colours)
    if sun is not None:
        own = np.concatenate(batch.shine)[:, None]
        light = sun.colour(np.concatenate(batch.lit_at), np.concatenate(batch.normals))
        paint = shoulder(paint * (1.0 - own + own * light))
    else:
        paint = np.clip(paint * BRIGHTEST / 1.05, 0.0, 1.0)
    put(made, name, places, np.concatenate(batch.faces))
    made[f"{name}.colours"] = np.rint(255.0 * np.sqrt(np.clip(paint, 0.0, 1.0))).astype(np.uint8)


def put(made: dict[str, NDArray[np.generic]], name: str, places: Floats, faces: NDArray[np.int64]) -> None:
    """Vertices and faces; x east, y north, z up becomes north, east, down, which keeps the faces' sense."""
    ned = np.stack([places[:, 1], places[:, 0], -places[:, 2]], axis=1)
    centre = np.round(0.5 * (ned.min(axis=0) + ned.max(axis=0)), 3)
    step = float(np.max(np.abs(ned - centre))) / 32767.0
    made[f"{name}.centre"], made[f"{name}.step"] = centre, np.array(step)
    made[f"{name}.vertices"] = np.rint((ned - centre) / step).astype(np.int16)
    made[f"{name}.faces"] = faces.astype(np.uint32)


def shoulder(light: Floats) -> Floats:
    """Bright light bends towards white and does not cut off."""
    knee = 0.72
    return np.where(light < knee, light, knee + (1 - knee) * (1 - np.exp(-(light - knee) / (1 - knee))))


def pack_sky(made: dict[str, NDArray[np.generic]], rng: np.random.Generator) -> None:
    """The half ball and its picture."""
    places, at, faces = sky.ball()
    put(made, "sky", places, faces)
    made["sky.places"] = at.astype(np.float32)
    made["sky.picture"] = jpeg(sky.picture(rng), 88)
    made["sky.haze"] = sky.HAZE.astype(np.uint8)


def light_map(sun: Sun, half_m: float, rng: np.random.Generator) -> NDArray[np.uint8]:
    """The light on the ground: column from west, row from north."""
    size = LIGHT_MAP
    fine = sun.shares(*up_facing(size, half_m), suns=7, skies=1)[:, 0].reshape(size, size)
    coarse = sun.shares(*up_facing(size // 4, half_m), suns=1, skies=48)[:, 1].reshape(size // 4, size // 4)
    grey = np.kron(coarse, np.ones((4, 4)))
    for axis in (0, 1):
        grey = (np.roll(grey, 2, axis) + grey + np.roll(grey, -2, axis)) / 3.0
    from tools.town.light import SKY_LIGHT, SUN, SUN_LIGHT

    light = fine[..., None] * SUN[2] * SUN_LIGHT + (0.22 + 0.78 * grey)[..., None] * SKY_LIGHT
    light = light * sky.mottle(size, rng)[..., None]
    share = np.clip(light / BRIGHTEST * 1.05, 0.0, 1.0)
    srgb = np.where(share <= 0.0031308, 12.92 * share, 1.055 * share ** (1 / 2.4) - 0.055)
    return np.rint(255.0 * srgb).astype(np.uint8)


def up_facing(size: int, half_m: float) -> tuple[Floats, Floats]:
    """The middle of every texel, just above the pavement, and the way up."""
    at = (np.arange(size) + 0.5) / size * 2.0 * half_m - half_m
    x, y = np.meshgrid(at, -at)
    places = np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.16)], axis=1)
    return places, np.tile([0.0, 0.0, 1.0], (len(places), 1))


def jpeg(pixels: NDArray[np.uint8], quality: int) -> NDArray[np.uint8]:
    """A picture as the bytes of a JPEG file."""
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "JPEG", quality=quality, optimize=True)
    return np.frombuffer(file.getvalue(), np.uint8)


if __name__ == "__main__":
    main()
