"""GPX: what we write we read, a declination turns it, and no file explodes or escapes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats import geo, gpx
from app.motion.basics import InputError

ways = st.lists(st.tuples(*[st.floats(-500.0, 500.0)] * 2), min_size=1, max_size=8)


def written(way: list[tuple[float, float]], origin: geo.Origin, declination_rad: float) -> bytes:
    position_n = np.array([(0.0, 0.0, 0.0), *((north, east, 0.0) for north, east in way)])
    return geo.gpx("walk <&>", [geo.on_earth("foot", position_n, origin, declination_rad)])


@given(ways, st.floats(-75.0, 75.0), st.floats(-180.0, 180.0), st.floats(-0.5, 0.5))
def test_a_way_comes_back(way, latitude: float, longitude: float, declination_rad: float) -> None:
    data = written(way, geo.Origin(latitude, longitude), declination_rad)
    track = gpx.read("x.gpx", data, declination_rad)
    (piece,) = track.pieces
    np.testing.assert_allclose(piece, [(0.0, 0.0), *way], atol=1e-3)
    assert track.name == "walk <&> foot"


def test_magnetic_north_east_of_true_north_turns_the_track_to_the_left() -> None:
    data = b'<gpx><trk><trkseg><trkpt lat="48" lon="11"/><trkpt lat="48.001" lon="11"/></trkseg></trk></gpx>'
    straight = gpx.read("x", data).pieces[0][1]
    turned = gpx.read("x", data, math.radians(10.0)).pieces[0][1]
    assert straight == pytest.approx((111.2, 0.0), abs=0.1)
    assert turned == pytest.approx(
        (straight[0] * math.cos(math.radians(10)), -straight[0] * math.sin(math.radians(10)))
    )


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_a_track_turned_afterwards_is_the_track_read_so(first: float, then: float) -> None:
    data = written([(0.0, 0.0), (30.0, 5.0), (-8.0, 60.0)], geo.Origin(48.0, 11.0), 0.0)
    turned = gpx.turned(gpx.turned(gpx.reference_of(gpx.read("x.gpx", data)), first), then)
    np.testing.assert_allclose(
        turned.segments, gpx.reference_of(gpx.read("x.gpx", data, then)).segments, atol=1e-4
    )
    assert turned.declination_rad == then


def test_the_first_tracks_name_is_the_name() -> None:
    point = '<trkseg><trkpt lat="48" lon="11"/></trkseg>'
    tracks = "".join(f"<trk><name>{name}</name>{point}</trk>" for name in ("left", "right"))
    assert gpx.read("x", f"<gpx>{tracks}</gpx>".encode()).name == "left"


def test_pieces_stay_apart_and_lengths_add_up() -> None:
    point = '<trkpt lat="48.{}" lon="11"/>'
    pieces = "".join(f"<trkseg>{point.format('000')}{point.format('001')}</trkseg>" for _ in range(2))
    track = gpx.read("x", f"<gpx><trk>{pieces}</trk></gpx>".encode())
    assert len(track.pieces) == 2
    assert track.length_m == pytest.approx(2 * 111.2, abs=0.2)


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b'<!DOCTYPE gpx [<!ENTITY a "b">]><gpx>&a;</gpx>', "document type"),
        (b"<gpx></gpx>", "no track point"),
        (b"<gpx>", "no GPX"),
        (b'<gpx><trk><trkseg><trkpt lat="x" lon="1"/></trkseg></trk></gpx>', "point 1"),
        (b'<gpx><trk><trkseg><trkpt lat="nan" lon="1"/></trkseg></trk></gpx>', "point 1"),
        (
            b'<gpx><trk><trkseg><trkpt lat="0" lon="1"/><trkpt lat="9" lon="1"/></trkseg></trk></gpx>',
            "100 km",
        ),
    ],
)
def test_what_is_no_walk_is_one_line(data: bytes, why: str) -> None:
    with pytest.raises(InputError, match=why) as error:
        gpx.read("x.gpx", data)
    assert "\n" not in str(error.value)


PARTS = (
    "<gpx>", "</gpx>", "<trk>", "</trk>", "<trkseg>", "</trkseg>", '<trkpt lat="1" lon="2"/>', "<name>",
    "</name>", "<!DOCTYPE a>", "&a;", "\0", "é", '<trkpt lat="1e400"/>', "<?xml version='1.0' encoding='x'?>",
)  # fmt: skip


@given(st.lists(st.sampled_from(PARTS), max_size=12).map("".join).map(str.encode) | st.binary(max_size=100))
def test_any_bytes_are_a_track_or_one_line(data: bytes) -> None:
    try:
        assert gpx.read("x", data).pieces
    except InputError as error:
        assert "\n" not in str(error)
