"""Our glTF writer against a kept library's reader."""

from __future__ import annotations

import io
import json
import struct
from dataclasses import replace

import numpy as np
import trimesh

from app.scene.glb import Part, glb, joined


def part(name: str, shift: float = 0.0, **more: object) -> Part:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]], np.float32) + np.float32(shift)
    colours = np.array([[0, 0.5, 1], [1, 0, 0], [0, 1, 0], [0.25, 0.25, 0.25]], np.float32)
    return Part(name, vertices, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), colours, **more)  # type: ignore[arg-type]


def test_another_reader_finds_every_mesh_as_it_was() -> None:
    parts = [part("one"), part("two", 5.0)]
    scene = trimesh.load_scene(io.BytesIO(glb(parts)), file_type="glb")
    assert set(scene.graph.nodes_geometry) == {"one", "two"}
    for made in parts:
        matrix, name = scene.graph[made.name]
        mesh = scene.geometry[name]
        np.testing.assert_allclose(np.asarray(matrix), np.eye(4))
        np.testing.assert_allclose(mesh.triangles, made.vertices[made.faces], atol=1e-6)
        seen = mesh.visual.vertex_attributes["color"] if hasattr(mesh.visual, "vertex_attributes") else None
        assert seen is None or len(seen) == len(mesh.vertices)


def document(data: bytes) -> dict:
    magic, version, total = struct.unpack_from("<4sII", data)
    assert (magic, version, total) == (b"glTF", 2, len(data))
    length, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    return json.loads(data[20 : 20 + length])


def test_every_material_is_unlit_and_chunks_are_aligned() -> None:
    data = glb([part("one"), part("clear", clear=True)])
    told = document(data)
    assert all("KHR_materials_unlit" in material["extensions"] for material in told["materials"])
    assert [m.get("alphaMode") for m in told["materials"]] == [None, "BLEND"]
    assert len(data) % 4 == 0
    assert all(view["byteOffset"] % 4 == 0 for view in told["bufferViews"])


def test_a_picture_is_inside_and_its_own_part_points_to_it() -> None:
    places = np.zeros((4, 2), np.float32)
    told = document(glb([part("plain"), part("photo", places=places, picture=b"\xff\xd8JPEG")]))
    assert "baseColorTexture" not in told["materials"][0]["pbrMetallicRoughness"]
    assert told["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"] == {"index": 0}
    assert "TEXCOORD_0" in told["meshes"][1]["primitives"][0]["attributes"]


def test_colours_are_kept_as_linear_light() -> None:
    told = glb([part("one")])
    described = document(told)
    accessor = described["accessors"][described["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]]
    view = described["bufferViews"][accessor["bufferView"]]
    start = len(told) - described["buffers"][0]["byteLength"] + view["byteOffset"]
    paint = np.frombuffer(told, np.uint16, 16, start).reshape(4, 4) / 65535.0
    np.testing.assert_allclose(paint[:, :3], part("one").colours, atol=1e-4)
    np.testing.assert_allclose(paint[:, 3], 1.0)


def test_one_colour_and_lines_cost_no_colour_for_each_vertex() -> None:
    plain = part("one")
    edges = np.array([[0, 1], [1, 3]], np.uint32)
    told = document(glb([replace(plain, colours=plain.colours[:1], lines=edges)]))
    faces, lines = told["meshes"][0]["primitives"]
    assert faces["attributes"] == lines["attributes"] == {"POSITION": 0}
    assert lines["mode"] == 1
    assert told["accessors"][lines["indices"]]["count"] == edges.size
    assert told["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] == [0.0, 0.5, 1.0, 1.0]


def test_joined_parts_are_the_same_triangles_in_the_same_colours() -> None:
    parts = [part("one"), part("two", 5.0), part("three", -2.0)]
    one = joined("all", parts)
    np.testing.assert_array_equal(
        one.vertices[one.faces], np.concatenate([p.vertices[p.faces] for p in parts])
    )
    np.testing.assert_array_equal(one.colours[one.faces], np.concatenate([p.colours[p.faces] for p in parts]))
    assert len(document(glb([one]))["meshes"]) == 1
