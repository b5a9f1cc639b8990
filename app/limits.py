"""Heart: what a person may set: a record whose fields know their label, unit, limits and sentence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any, Self

Value = float | bool | str
_TOO_LARGE = 1e300  # a whole number can be past every float


@dataclass(frozen=True)
class Limit:
    """What a setting may be, and how a person is told. ``safe`` is the slider's range."""

    label: str
    symbol: str
    unit: str
    sentence: str
    low: float = 0.0
    high: float = 1.0
    safe: tuple[float, float] = (0.0, 1.0)
    step: float = 0.01
    choices: tuple[str, ...] = ()
    only: str = ""  # the estimator that reads it; empty: every one


def setting(default: Value, limit: Limit) -> Any:
    """A field of a ``Limited`` record."""
    return field(default=default, metadata={"limit": limit})


@dataclass(frozen=True)
class Limited:
    """Fields made by ``setting``. Out-of-range, unknown or non-finite values raise ``ValueError``."""

    def __post_init__(self) -> None:
        for f in fields(self):
            value = _checked(f.name, getattr(self, f.name), f.default, f.metadata["limit"])
            object.__setattr__(self, f.name, value)

    def with_changes(self, changes: Mapping[str, Value]) -> Self:
        """The same with some changed; an unknown key or a bad value raises ``ValueError``."""
        known = self.limits()
        for key in changes:
            if key not in known:
                raise ValueError(f"unknown setting {key!r}: expected one of {', '.join(sorted(known))}")
        return replace(self, **changes)

    @classmethod
    def limits(cls) -> dict[str, Limit]:
        """Each field's, in the order shown."""
        return {f.name: f.metadata["limit"] for f in fields(cls)}


def _checked(name: str, value: object, default: object, limit: Limit) -> Value:
    if isinstance(default, bool):
        if not isinstance(value, bool):
            raise ValueError(f"{name} = {value!r}: expected true or false")
        return value
    if isinstance(default, str):
        if value not in limit.choices:
            raise ValueError(f"{name} = {value!r}: expected one of {', '.join(limit.choices)}")
        return str(value)
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < _TOO_LARGE:
        raise ValueError(f"{name} = {value!r}: expected a number")
    if not limit.low <= value <= limit.high:
        span = f"{limit.low:g} to {limit.high:g} {limit.unit}".rstrip()
        raise ValueError(f"{name} = {value:g}: expected {span}")
    return float(value)
