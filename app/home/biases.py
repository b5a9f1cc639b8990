"""Edge: the user's configuration folder: the gyro bias last found of each sensor, as JSON."""

from __future__ import annotations

import json
import logging
import math
from pathlib import Path
from typing import NamedTuple

from app.home import calibrations, small
from app.motion.basics import InputError, Vector
from app.motion.samples import GyroBias

log = logging.getLogger(__name__)

MOST_BYTES = 4096
#: No gyro is so far off, rad/s.
MOST_RADPS = 1.0
#: No sensor is so hot or cold, °C.
MOST_C = 200.0


class Remembered(NamedTuple):
    """A sensor's gyro bias, when it was found (ISO date), and the calibration it was found under."""

    sensor: str
    bias: GyroBias
    made: str
    calibrated: str = ""  # when the calibration was made that the samples were corrected by; empty: none
    temperature_c: float | None = None  # the sensor's then, where it tells it


def path_of(key: str) -> Path:
    """The file for a sensor, in a folder beside the calibrations'."""
    return calibrations.folder().parent / "biases" / calibrations.path_of(key).name


def load(key: str) -> Remembered | None:
    """What is remembered of a sensor; None where nothing is. A damaged file is ``InputError``."""
    path = path_of(key)
    text = small.read(f"gyro bias {path}", path, MOST_BYTES, "one of ours")
    if text is None:
        return None
    found = from_json(text)
    if found is None or found.sensor != key:
        raise InputError(f"gyro bias {path}: expected one of {key!r}, written by this program; delete it")
    return found


def save(found: Remembered) -> None:
    """Keep it, in the place of the one before."""
    small.write("gyro bias", path_of(found.sensor), to_json(found))
    log.info("%s: gyro bias remembered", found.sensor)


def to_json(found: Remembered) -> str:
    """The file's content."""
    content = {
        "sensor": found.sensor,
        "gyro_bias_radps": found.bias.rate_b,
        "doubt_radps": found.bias.doubt_radps,
        "made": found.made,
        "calibrated": found.calibrated,
        "temperature_c": found.temperature_c,
    }
    return json.dumps(content, ensure_ascii=False, indent=1)


def from_json(text: str) -> Remembered | None:
    """The inverse; None for anything else."""
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):
        return None
    if not isinstance(content, dict):
        return None
    words = [content.get(name) for name in ("sensor", "made", "calibrated")]
    rate, doubt = _vector(content.get("gyro_bias_radps")), _vector(content.get("doubt_radps"))
    if rate is None or doubt is None or min(doubt) <= 0.0 or not all(isinstance(word, str) for word in words):
        return None
    sensor, made, calibrated = (str(word) for word in words)
    return Remembered(sensor, GyroBias(rate, doubt), made, calibrated, _degrees(content.get("temperature_c")))


def _degrees(value: object) -> float | None:
    """A temperature; files from before it was kept have none."""
    if type(value) not in (int, float) or not isinstance(value, int | float):
        return None
    return float(value) if abs(value) < MOST_C else None


def _vector(value: object) -> Vector | None:
    if not isinstance(value, list) or len(value) != 3:
        return None
    if any(type(part) not in (int, float) for part in value):
        return None
    if any(not abs(part) < MOST_RADPS or not math.isfinite(part) for part in value):
        return None
    x, y, z = (float(part) for part in value)
    return (x, y, z)
