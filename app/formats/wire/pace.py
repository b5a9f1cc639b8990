"""Heart: how often a modelled device measures, told by the samples' own time."""

from __future__ import annotations


class Pace:
    """Lets pass one sample a period, in the mean exactly; a slower source passes whole."""

    def __init__(self) -> None:
        self._first_ns: int | None = None
        self._slot: int | None = None

    def due(self, device_ns: int, rate_hz: float) -> bool:
        """Whether the device measures now. The first sample is due, and so is one after a new start."""
        if self._first_ns is None:
            self._first_ns = device_ns
        # half a period of leeway: samples at exactly this rate must not fall into one slot by rounding
        slot = int((device_ns - self._first_ns) * rate_hz / 1e9 + 0.5)
        if slot == self._slot:
            return False
        self._slot = slot
        return True
