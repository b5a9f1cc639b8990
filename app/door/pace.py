"""Door: how fast one connection may talk. Pure: time is passed in.

viser's page sends its camera at most 50 times a second and a slider less often, a few hundred bytes
each. Who talks faster is read more slowly, so that nothing said in earnest is lost: what waits stays
on the other side of the network.
"""

from __future__ import annotations

MESSAGES_PER_S = 200.0
BYTES_PER_S = 256.0 * 1024
#: What may come at once after a rest, in seconds of that pace.
BURST_S = 2.0


class Pace:
    """A bucket that leaks at a steady rate, kept as the time at which it will be empty."""

    def __init__(self, messages_per_s: float = MESSAGES_PER_S, bytes_per_s: float = BYTES_PER_S) -> None:
        self._message_s, self._byte_s = 1.0 / messages_per_s, 1.0 / bytes_per_s
        self._empty_s = float("-inf")

    def delay_s(self, size: int, now_s: float) -> float:
        """How long to wait after a message of ``size`` bytes before the next one is read."""
        cost_s = self._message_s + size * self._byte_s
        self._empty_s = max(self._empty_s, now_s) + cost_s
        return max(0.0, self._empty_s - now_s - BURST_S)
