"""Heart: a sensor's own temperature: which one a sensor can have, and how a modelled one warms up.

It comes beside the samples and slower than they do, so a decoder keeps the newest and no sample carries it.
"""

from __future__ import annotations

import math

#: Colder or hotter (°C) no sensor works: a digit or a bit was damaged where no checksum tells.
COLDEST_C, HOTTEST_C = -50.0, 125.0
#: How often the modelled sensors tell it that send it by itself.
RATE_HZ = 1.0

_ROOM_C, _WARM_C, _TAKES_S = 24.0, 31.0, 300.0


def believed(celsius: float | None, before: float | None = None) -> float | None:
    """A temperature that a sensor can have, °C; the one ``before`` in the place of any other."""
    return celsius if celsius is not None and COLDEST_C <= celsius <= HOTTEST_C else before


def warming(device_ns: int) -> float:
    """°C of a modelled sensor so long after it was switched on: from the room's towards its own."""
    return _WARM_C + (_ROOM_C - _WARM_C) * math.exp(-device_ns * 1e-9 / _TAKES_S)
