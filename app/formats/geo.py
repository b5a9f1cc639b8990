"""Heart: a walk on the map: GPX, KML and GeoJSON, from an origin and a declination that a person gives."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import NamedTuple
from xml.sax.saxutils import escape

import numpy as np

from app.motion.basics import Floats, InputError

_A, _E2 = 6378137.0, 6.69437999014e-3  # WGS 84


class Origin(NamedTuple):
    """Where the walk starts: degrees north and east, metres above the ellipsoid."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float = 0.0


class Path(NamedTuple):
    """One foot's way: degrees east, degrees north, metres up, [n, 3]: the order that KML and GeoJSON want."""

    name: str
    points: Floats


def parse_origin(text: str) -> Origin:
    """``48.1,11.6`` or ``48.1,11.6,520``; ``InputError`` if it is no place away from the poles."""
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    sane = len(values) in (2, 3) and all(map(math.isfinite, values))
    if not sane or not abs(values[0]) <= 89.0 or not abs(values[1]) <= 180.0:
        raise InputError(f"--origin {text}: expected LATITUDE,LONGITUDE in degrees, such as 48.137,11.575")
    return Origin(*values)


def on_earth(name: str, position_n: Floats, origin: Origin, declination_rad: float) -> Path:
    """A way [n, 3] in magnetic north, east, down on the ellipsoid; good to centimetres over kilometres.

    ``declination_rad`` is how far magnetic north lies east of true north.
    """
    cosine, sine = math.cos(declination_rad), math.sin(declination_rad)
    north = position_n[:, 0] * cosine - position_n[:, 1] * sine
    east = position_n[:, 0] * sine + position_n[:, 1] * cosine
    latitude = math.radians(origin.latitude_deg)
    root = math.sqrt(1.0 - _E2 * math.sin(latitude) ** 2)
    meridian_m = _A * (1.0 - _E2) / root**3 + origin.altitude_m
    parallel_m = (_A / root + origin.altitude_m) * math.cos(latitude)
    longitudes = origin.longitude_deg + np.degrees(east / parallel_m)
    longitudes = (longitudes + 180.0) % 360.0 - 180.0
    latitudes = origin.latitude_deg + np.degrees(north / meridian_m)
    return Path(name, np.column_stack([longitudes, latitudes, origin.altitude_m - position_n[:, 2]]))


def gpx(name: str, paths: Sequence[Path]) -> bytes:
    """GPX 1.1, a track for each foot."""
    tracks = "".join(
        f"<trk><name>{_text(name)} {_text(path.name)}</name><trkseg>"
        + "".join(
            f'<trkpt lat="{lat:.9f}" lon="{lon:.9f}"><ele>{up:.3f}</ele></trkpt>'
            for lon, lat, up in path.points.tolist()
        )
        + "</trkseg></trk>\n"
        for path in paths
    )
    head = '<gpx version="1.1" creator="Stridescope" xmlns="http://www.topografix.com/GPX/1/1">'
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{head}\n{tracks}</gpx>\n'.encode()


def kml(name: str, paths: Sequence[Path]) -> bytes:
    """KML 2.2, a line for each foot."""
    lines = "".join(
        f"<Placemark><name>{_text(path.name)}</name><LineString><altitudeMode>absolute</altitudeMode>"
        "<coordinates>"
        + " ".join(f"{lon:.9f},{lat:.9f},{up:.3f}" for lon, lat, up in path.points.tolist())
        + "</coordinates></LineString></Placemark>\n"
        for path in paths
    )
    head = f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document><name>{_text(name)}</name>'
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{head}\n{lines}</Document></kml>\n'.encode()


def geojson(name: str, paths: Sequence[Path]) -> bytes:
    """GeoJSON (RFC 7946), a line for each foot."""
    features = [
        {
            "type": "Feature",
            "properties": {"recording": name, "foot": path.name},
            "geometry": {
                "type": "LineString",
                "coordinates": [
                    [round(lon, 9), round(lat, 9), round(up, 3)] for lon, lat, up in path.points.tolist()
                ],
            },
        }
        for path in paths
    ]
    return json.dumps({"type": "FeatureCollection", "features": features}).encode() + b"\n"


def _text(text: str) -> str:
    return escape("".join(c if c.isprintable() else "?" for c in text))
