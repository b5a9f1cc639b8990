"""Heart: what can go wrong between a sensor and its host, told in words and done to bytes, repeatably."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from random import Random

from app.motion.basics import InputError

#: What ``--fault`` takes, with the sentence of its help.
FAULTS = {
    "lost": "lost=SHARE: bytes that vanish (0.01 or 1%%)",
    "flip": "flip=SHARE: bytes of which one bit flips",
    "garbage": "garbage=SHARE: bytes before which a stray one appears",
    "unplug": "unplug=SECONDS@AT: the cable is out; the sensor runs on",
    "brownout": "brownout=SECONDS@AT: without power; then its settings are lost and its clock restarts",
    "drift": "drift=PPM: its clock runs fast (negative: slow)",
    "burst": "burst=MS: what it sends arrives in bursts, as from a USB adapter with a 16 ms timer",
}
_USUAL_AT_S = 10.0


@dataclass(frozen=True)
class Outage:
    """Something is off for ``seconds``, from ``at_s`` on."""

    seconds: float
    at_s: float


@dataclass(frozen=True)
class Faults:
    """Shares are of all bytes, 0 to 1."""

    lost: float = 0.0
    flip: float = 0.0
    garbage: float = 0.0
    drift_ppm: float = 0.0
    burst_s: float = 0.0
    unplugs: tuple[Outage, ...] = ()
    brownouts: tuple[Outage, ...] = ()


def parse_faults(texts: Sequence[str]) -> Faults:
    """Faults as typed; ``InputError`` names what is wrong."""
    faults = Faults()
    for text in texts:
        name, equals, value = text.partition("=")
        if name not in FAULTS or not equals:
            raise InputError(f"--fault {text!r}: expected one of {', '.join(FAULTS)}, each with =VALUE")
        match name:
            case "drift":
                faults = replace(faults, drift_ppm=_number(text, value, -100_000.0, 100_000.0))
            case "burst":
                faults = replace(faults, burst_s=_number(text, value, 0.0, 1000.0) / 1000)
            case "unplug":
                faults = replace(faults, unplugs=(*faults.unplugs, _outage(text, value)))
            case "brownout":
                faults = replace(faults, brownouts=(*faults.brownouts, _outage(text, value)))
            case "lost":
                faults = replace(faults, lost=_share(text, value))
            case "flip":
                faults = replace(faults, flip=_share(text, value))
            case "garbage":
                faults = replace(faults, garbage=_share(text, value))
    return faults


def _outage(text: str, value: str) -> Outage:
    seconds, _, at = value.partition("@")
    at_s = _number(text, at, 0.0, 1e6) if at else _USUAL_AT_S
    return Outage(_number(text, seconds, 0.0, 1e6), at_s)


def _share(text: str, value: str) -> float:
    if value.endswith("%"):
        return _number(text, value[:-1], 0.0, 100.0) / 100
    return _number(text, value, 0.0, 1.0)


def _number(text: str, value: str, least: float, most: float) -> float:
    try:
        number = float(value)
    except ValueError:
        number = math.nan
    if not least <= number <= most:
        raise InputError(f"--fault {text!r}: {value!r}, expected a number from {least:g} to {most:g}")
    return number


class Line:
    """Bytes on their way through a bad line. The same ``seed`` does the same damage."""

    def __init__(self, faults: Faults, seed: int = 0) -> None:
        self.lost = self.flipped = self.strays = 0
        self._faults = faults
        self._random = Random(seed)

    def carry(self, data: bytes) -> bytes:
        """What arrives of ``data``."""
        faults, random = self._faults, self._random
        if not (faults.lost or faults.flip or faults.garbage):
            return data
        arrived = bytearray()
        for byte in data:
            if random.random() < faults.garbage:
                arrived.append(random.randrange(256))
                self.strays += 1
            if random.random() < faults.lost:
                self.lost += 1
                continue
            flips = random.random() < faults.flip
            self.flipped += flips
            arrived.append(byte ^ 1 << random.randrange(8) if flips else byte)
        return bytes(arrived)

    def garbled(self, data: bytes) -> bytes:
        """What a host at another speed reads of it."""
        return self._random.randbytes(len(data))
