"""Heart: a PyShoe trial: a MATLAB file with ``imu`` [n, 6] (m/s², rad/s) and ``ts`` [n] in seconds."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import scipy.io

from app.formats.raw import Parsed, RawFoot, whole_ns
from app.motion.basics import Floats, InputError

_MAGIC = (b"MATLAB 5.0", b"MATLAB 7.3")


def recognises(data: bytes) -> bool:
    """Whether the bytes begin as a MATLAB file does."""
    return data.startswith(_MAGIC)


def parse(name: str, data: bytes) -> Parsed:
    """The one foot of a trial; ``InputError`` if the file is damaged or holds something else."""
    if data.startswith(_MAGIC[1]):
        raise InputError(f"{name}: a MATLAB 7.3 file, expected version 5: save it with -v7")
    variables = _load(name, data)
    imu, seconds = _numbers(name, variables, "imu"), _numbers(name, variables, "ts").ravel()
    if imu.ndim != 2 or imu.shape != (len(seconds), 6) or not len(seconds):
        raise InputError(f"{name}: imu is {imu.shape} beside {len(seconds)} times, expected (times, 6)")
    with np.errstate(over="ignore"):
        stamps_ns = whole_ns(seconds * 1e9)
    foot = RawFoot("foot", stamps_ns, imu[:, :3], imu[:, 3:])
    return Parsed("PyShoe MATLAB", (foot,), assumed=("units of a PyShoe trial: m/s² and rad/s",))


def _load(name: str, data: bytes) -> dict[str, Any]:
    try:
        file: Any = io.BytesIO(data)  # the stubs know only paths
        return dict(scipy.io.loadmat(file, variable_names=["imu", "ts"]))
    except Exception as error:  # a damaged file raises almost anything: struct, zlib, Value, Type, Memory …
        what = " ".join(str(error).split())[:80]
        raise InputError(f"{name}: a damaged MATLAB file ({what or type(error).__name__})") from None


def _numbers(name: str, variables: dict[str, Any], key: str) -> Floats:
    value = variables.get(key)
    if not isinstance(value, np.ndarray) or value.dtype.kind not in "fiu":
        raise InputError(f"{name}: no numbers named {key!r}, expected a PyShoe trial with imu and ts")
    return value.astype(np.float64)
