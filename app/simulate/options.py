"""Heart: what `sim:walk` can be asked for: names, units, limits, sentences, and reading them from a SPEC.

A key of a SPEC is a field of ``WalkOptions``; its unit may be left out:
``sim:walk?path=eight&stride_m=1.3&rate=200``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from app.motion.basics import G_MPS2, InputError

MODELS = ("smooth", "papers")
UNITS = (
    "_m",
    "_s",
    "_hz",
    "_spm",
    "_deg",
    "_dps",
    "_g",
    "_gauss",
    "_mps2",
    "_radps",
    "_fraction",
    "_gauss_m3",
)
PATHS = ("straight", "oval", "square", "eight", "stairs")


@dataclass(frozen=True)
class Option:
    """One key of a SPEC: how its text is read, what it may be, and a sentence about it."""

    sentence: str
    kind: str = "number"  # number | integer | switch | choice | vector
    low: float = -math.inf
    high: float = math.inf
    choices: tuple[str, ...] = ()


def _option(default: object, sentence: str, **rest: Any) -> Any:
    return field(default=default, metadata={"option": Option(sentence, **rest)})


@dataclass(frozen=True)
class WalkOptions:
    """A simulated walk, by units in names. ``None`` means: as the model and the path have it.

    The errors are none unless asked for. ``noise`` and ``bias`` scale Table II of the 2012 paper
    for all sensors at once; a sensor's own value overrides them. A bias is a vector in body axes.
    An unknown word, a number out of range or a contradiction raises ``InputError``.
    """

    model: str = _option("smooth", "the foot model", kind="choice", choices=MODELS)
    path: str = _option("straight", "where the walk goes", kind="choice", choices=PATHS)
    size_m: float | None = _option(
        None, "lap of the oval, side of the square, circle of the eight", low=4.0, high=10_000.0
    )
    feet: int = _option(
        1, "1: sensor foot; 2: left and right, half a cycle apart", kind="integer", low=1, high=2
    )
    distance_m: float | None = _option(None, "length of the path walked", low=0.1, high=200_000.0)
    strides: int | None = _option(None, "how many strides", kind="integer", low=1, high=200_000)
    duration_s: float | None = _option(None, "length of the recording", low=1.0, high=172_800.0)
    laps: int | None = _option(None, "rounds of a closed path", kind="integer", low=1, high=1_000)
    stride_m: float | None = _option(None, "same foot to same foot", low=0.1, high=4.0)
    cadence_spm: float = _option(120.0, "steps a minute, two to a stride", low=20.0, high=300.0)
    lift_m: float | None = _option(None, "how high the foot swings", low=0.0, high=1.0)
    rate_hz: float = _option(100.0, "samples a second", low=20.0, high=2_000.0)
    still_s: float = _option(2.0, "standing still at the start", low=0.0, high=3_600.0)
    end_s: float = _option(1.0, "standing still at the end", low=0.0, high=3_600.0)
    heading_deg: float = _option(
        0.0, "heading at the start, clockwise from magnetic north", low=-360.0, high=360.0
    )
    gravity_mps2: float = _option(G_MPS2, "gravity", low=1.0, high=20.0)
    seed: int = _option(0, "seed of the noise and of the lost samples", kind="integer", low=0, high=2**63 - 1)
    noise: float = _option(0.0, "random errors, in multiples of Table II", low=0.0, high=1_000.0)
    bias: float = _option(0.0, "constant errors, in multiples of Table II", low=-1_000.0, high=1_000.0)
    accelerometer_noise_mps2: float | None = _option(None, "standard deviation", low=0.0, high=100.0)
    accelerometer_bias_mps2: tuple[float, float, float] | None = _option(
        None, "x,y,z", kind="vector", low=-100.0, high=100.0
    )
    gyro_noise_radps: float | None = _option(None, "standard deviation", low=0.0, high=100.0)
    gyro_bias_radps: tuple[float, float, float] | None = _option(
        None, "x,y,z", kind="vector", low=-100.0, high=100.0
    )
    magnetometer_noise_gauss: float | None = _option(None, "standard deviation", low=0.0, high=100.0)
    magnetometer_bias_gauss: tuple[float, float, float] | None = _option(
        None, "x,y,z", kind="vector", low=-100.0, high=100.0
    )
    accelerometer_range_g: float | None = _option(None, "readings are clipped here", low=0.1, high=1_000.0)
    gyro_range_dps: float | None = _option(None, "readings are clipped here", low=1.0, high=100_000.0)
    magnetometer_range_gauss: float | None = _option(
        None, "readings are clipped here", low=0.01, high=1_000.0
    )
    decimals: int | None = _option(
        None, "readings are rounded to so many, in m/s², rad/s and gauss", kind="integer", low=0, high=15
    )
    lost_fraction: float = _option(0.0, "share of samples that never arrive", low=0.0, high=0.9)
    magnetometer: bool = _option(True, "on or off: whether there is one", kind="switch")
    iron_gauss_m3: float = _option(
        0.0, "a magnet beside the path: field at 1 m times 1 m³", low=-100.0, high=100.0
    )
    iron_along: float = _option(0.5, "where along the path it lies, 0 start to 1 end", low=0.0, high=1.0)
    iron_beside_m: float = _option(1.0, "how far to the right of the path", low=-100.0, high=100.0)

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            if value is not None:
                _check(f.name, value, f.metadata["option"])
        _check_together(self)

    @property
    def cycle_s(self) -> float:
        """The duration of one stride."""
        return 120.0 / self.cadence_spm


def parse(texts: Mapping[str, str]) -> WalkOptions:
    """The options of a SPEC's query; raises ``InputError`` that says what is known."""
    known = {f.name: f.metadata["option"] for f in fields(WalkOptions)}
    values: dict[str, Any] = {}
    short = {key.removesuffix(unit): key for key in known for unit in UNITS if key.endswith(unit)}
    for said, text in texts.items():
        key = short.get(said, said)
        if key not in known:
            raise InputError(f"sim:walk: unknown option {said!r}: expected one of {', '.join(known)}")
        if key in values:
            raise InputError(f"sim:walk: {key} is given twice")
        values[key] = _read(key, text, known[key])
    return WalkOptions(**values)


def spec_of(options: WalkOptions) -> str:
    """The SPEC that makes this walk again, without what is as usual."""
    changed = [
        f"{f.name}={_text(getattr(options, f.name))}"
        for f in fields(options)
        if getattr(options, f.name) != f.default
    ]
    return "sim:walk" + ("?" + "&".join(changed) if changed else "")


def _read(key: str, text: str, option: Option) -> object:
    if option.kind == "choice":
        return text
    if option.kind == "switch":
        if text.lower() not in ("on", "off"):
            raise InputError(f"sim:walk: {key}={text!r}: expected on or off")
        return text.lower() == "on"
    try:
        if option.kind == "integer":
            return int(text)
        if option.kind == "vector":
            return tuple(float(part) for part in text.split(","))
        return float(text)
    except ValueError:
        raise InputError(f"sim:walk: {key}={text!r}: expected {_expected(option)}") from None


def _check(key: str, value: object, option: Option) -> None:
    if not _fits(value, option):
        raise InputError(f"sim:walk: {key}={_text(value)!r}: expected {_expected(option)}")


def _fits(value: object, option: Option) -> bool:
    if option.kind == "choice":
        return value in option.choices
    if option.kind == "switch":
        return isinstance(value, bool)
    numbers = value if option.kind == "vector" else (value,)
    if not isinstance(numbers, tuple) or len(numbers) != (3 if option.kind == "vector" else 1):
        return False
    kinds = (int,) if option.kind == "integer" else (int, float)
    return all(
        isinstance(x, kinds) and not isinstance(x, bool) and option.low <= x <= option.high for x in numbers
    )


def _expected(option: Option) -> str:
    if option.kind == "choice":
        return f"one of {', '.join(option.choices)} ({option.sentence})"
    if option.kind == "switch":
        return option.sentence
    what = {"number": "a number", "integer": "a whole number", "vector": "three numbers x,y,z"}[option.kind]
    return f"{what} from {option.low:g} to {option.high:g} ({option.sentence})"


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, tuple):
        return ",".join(_text(x) for x in value)
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _check_together(options: WalkOptions) -> None:
    lengths = [k for k in ("distance_m", "strides", "duration_s", "laps") if getattr(options, k) is not None]
    if len(lengths) > 1:
        raise InputError(f"sim:walk: {' and '.join(lengths)} together: expected only one of them")
    if options.laps is not None and options.path in ("straight", "stairs"):
        raise InputError(f"sim:walk: laps with path={options.path}: expected path oval, square or eight")
    if options.size_m is not None and options.path in ("straight", "stairs"):
        raise InputError(f"sim:walk: size_m with path={options.path}: expected path oval, square or eight")
    if options.model == "papers" and options.path != "straight":
        raise InputError(f"sim:walk: model=papers with path={options.path}: expected path=straight")
