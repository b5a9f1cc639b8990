"""A walk on the map: lengths and directions survive, names never become markup."""

from __future__ import annotations

import json
import math
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats import geo
from app.motion.basics import InputError

WALK = np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [100.0, 50.0, -2.0]])


def test_a_second_of_latitude_is_about_31_m() -> None:
    path = geo.on_earth("left", np.array([[30.9, 0.0, 0.0]]), geo.Origin(45.0, 7.0), 0.0)
    assert path.points[0, 1] - 45.0 == pytest.approx(1 / 3600, rel=2e-3)


@given(st.floats(-80, 80), st.floats(-180, 180), st.floats(-0.5, 0.5))
def test_lengths_and_the_declination_survive(latitude: float, longitude: float, declination: float) -> None:
    points = geo.on_earth("left", WALK, geo.Origin(latitude, longitude, 500.0), declination).points
    north_m = np.radians(points[:, 1] - latitude) * 6_371_000.0
    turned = np.radians((points[:, 0] - longitude + 540.0) % 360.0 - 180.0)
    east_m = turned * 6_371_000.0 * math.cos(math.radians(latitude))
    assert math.hypot(north_m[1], east_m[1]) == pytest.approx(100.0, rel=0.01)
    assert math.atan2(east_m[1], north_m[1]) == pytest.approx(declination, abs=0.01)
    assert points[:, 2].tolist() == [500.0, 500.0, 502.0]


def test_every_map_format_is_well_formed_whatever_the_name() -> None:
    paths = [geo.on_earth("left", WALK, geo.Origin(48.0, 11.0), 0.0)]
    for make in (geo.gpx, geo.kml):
        ElementTree.fromstring(make("<b>&\n]]>", paths))
    lines = json.loads(geo.geojson("<b>", paths))["features"]
    assert lines[0]["geometry"]["coordinates"][0] == [11.0, 48.0, 0.0]
    assert geo.gpx("x", paths).count(b"<trkpt") == 3


@pytest.mark.parametrize("text", ["", "1", "a,b", "90,0", "0,181", "nan,0", "1,2,3,4", "inf,0"])
def test_no_place_is_one_line(text: str) -> None:
    with pytest.raises(InputError, match="--origin"):
        geo.parse_origin(text)
    assert geo.parse_origin("48.1, 11.6,520") == geo.Origin(48.1, 11.6, 520.0)
