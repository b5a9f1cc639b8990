"""Edge, scene: meshes as binary glTF whose colours are shown as they are: light is in them already. Pure.

Written by hand since viser's own meshes are always lit, and the exporters at hand know no unlit material.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

_BYTE, _USHORT, _UINT, _FLOAT = 5120, 5123, 5125, 5126
_VERTICES, _INDICES = 34962, 34963
_LINES = 1
#: Vertices that sixteen bits can name; the last number is reserved.
_SHORT = 65535


@dataclass(frozen=True)
class Part:
    """One mesh: vertices [n, 3] m, faces [m, 3], linear colours [n, 3 or 4] from 0 to 1.

    One colour [1, 3 or 4] is that of all. ``places`` [n, 2] are where on ``picture`` (the bytes of a JPEG
    file) each vertex lies; the picture multiplies the colours. ``clear`` lets what lies behind shine through
    by the fourth colour; it is seen from both sides, as what is ``open`` is. ``lines`` [k, 2] join vertices,
    one pixel wide however far away.
    """

    name: str
    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]
    colours: NDArray[np.float32]
    places: NDArray[np.float32] | None = None
    picture: bytes | None = None
    clear: bool = False
    open: bool = False
    lines: NDArray[np.uint32] | None = None
    sides: NDArray[np.int8] | None = None  # [n, 4]: a ribbon's, for the page's script


def joined(name: str, parts: Sequence[Part]) -> Part:
    """Parts without pictures as one mesh: one draw call. It is clear or open if the first of them is.

    So it is with a colour for all, with lines and with sides.
    """
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    faces = [part.faces + np.uint32(start) for part, start in zip(parts, starts, strict=False)]
    first = parts[0]
    one_colour = len(first.colours) == 1 and len(first.vertices) > 1
    colours = first.colours if one_colour else np.concatenate([part.colours for part in parts])
    lines = [p.lines + np.uint32(at) for p, at in zip(parts, starts, strict=False) if p.lines is not None]
    sides = [part.sides for part in parts if part.sides is not None]
    return Part(
        name, np.concatenate([part.vertices for part in parts]), np.concatenate(faces), colours,
        clear=first.clear, open=first.open, lines=np.concatenate(lines) if lines else None,
        sides=np.concatenate(sides) if sides else None,
    )  # fmt: skip


class _Body:
    """The binary chunk and what describes it."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, data: bytes, target: int | None = None) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.views.append(view if target is None else {**view, "target": target})
        self.data += data
        return len(self.views) - 1

    def accessor(self, array: NDArray[Any], kind: str, component: int, target: int, **more: Any) -> int:
        view = self.view(np.ascontiguousarray(array).tobytes(), target)
        count = array.size if kind == "SCALAR" else len(array)
        self.accessors.append(
            {"bufferView": view, "componentType": component, "count": count, "type": kind, **more}
        )
        return len(self.accessors) - 1


def glb(parts: Sequence[Part]) -> bytes:
    """A file in which each part is a node of its own, so that what is out of view is not drawn."""
    body = _Body()
    pictures = [part.picture for part in parts if part.picture is not None]
    images = [{"bufferView": body.view(p), "mimeType": "image/jpeg"} for p in pictures]
    meshes = [{"primitives": _primitives(body, part, i)} for i, part in enumerate(parts)]
    names = [part.name for part in parts if part.picture is not None]
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(parts)))}],
        "nodes": [{"mesh": i, "name": part.name} for i, part in enumerate(parts)], "meshes": meshes,
        "materials": [_material(part, names) for part in parts], "extensionsUsed": ["KHR_materials_unlit"],
        "accessors": body.accessors, "bufferViews": body.views, "buffers": [{"byteLength": len(body.data)}],
    }  # fmt: skip
    if images:
        document["images"] = images
        document["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}]
        document["textures"] = [{"source": i, "sampler": 0} for i in range(len(images))]
    return _file(json.dumps(document, separators=(",", ":")).encode(), bytes(body.data))


def _primitives(body: _Body, part: Part, material: int) -> list[dict[str, Any]]:
    """The triangles, and the lines between the same vertices."""
    shared = {"attributes": _attributes(body, part), "material": material}
    made = [{**shared, "indices": _indices(body, part.faces, len(part.vertices))}]
    if part.lines is not None:
        indices = _indices(body, part.lines, len(part.vertices))
        made.append({**shared, "indices": indices, "mode": _LINES})
    return made


def _attributes(body: _Body, part: Part) -> dict[str, int]:
    low, high = part.vertices.min(axis=0).tolist(), part.vertices.max(axis=0).tolist()
    place = part.vertices.astype(np.float32)
    attributes = {"POSITION": body.accessor(place, "VEC3", _FLOAT, _VERTICES, min=low, max=high)}
    if len(part.colours) > 1:
        paint = np.rint(65535.0 * _rgba(part)).astype(np.uint16)
        attributes["COLOR_0"] = body.accessor(paint, "VEC4", _USHORT, _VERTICES, normalized=True)
    if part.sides is not None:
        attributes["_SIDE"] = body.accessor(part.sides, "VEC4", _BYTE, _VERTICES, normalized=True)
    if part.places is not None:
        attributes["TEXCOORD_0"] = body.accessor(part.places.astype(np.float32), "VEC2", _FLOAT, _VERTICES)
    return attributes


def _rgba(part: Part) -> NDArray[np.float32]:
    """Its colours [n, 4]."""
    paint = np.ones((len(part.colours), 4), np.float32)
    paint[:, : part.colours.shape[1]] = np.clip(part.colours, 0.0, 1.0)
    return paint


def _indices(body: _Body, indices: NDArray[np.uint32], vertices: int) -> int:
    kind, component = (np.uint16, _USHORT) if vertices <= _SHORT else (np.uint32, _UINT)
    return body.accessor(indices.astype(kind), "SCALAR", component, _INDICES)


def _material(part: Part, with_picture: list[str]) -> dict[str, Any]:
    surface: dict[str, Any] = {"metallicFactor": 0.0, "roughnessFactor": 1.0}
    if len(part.colours) == 1:
        surface["baseColorFactor"] = _rgba(part)[0].tolist()
    if part.picture is not None:
        surface["baseColorTexture"] = {"index": with_picture.index(part.name)}
    material: dict[str, Any] = {
        "name": part.name, "pbrMetallicRoughness": surface, "extensions": {"KHR_materials_unlit": {}},
    }  # fmt: skip
    if part.clear:
        material["alphaMode"] = "BLEND"
    return {**material, "doubleSided": True} if part.clear or part.open else material


def _file(text: bytes, data: bytes) -> bytes:
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    total = 12 + 8 + len(text) + 8 + len(data)
    head = struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON")
    return head + text + struct.pack("<I4s", len(data), b"BIN\0") + data
