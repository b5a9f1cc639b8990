"""Heart: how much of what a link brings is damaged, over ten seconds: the decoders' counters as a light.

Told by bytes: what stands in no packet that held, of all that came. A damaged packet is as long as a sound
one, so that is the share of packets, too; counting what began like a packet would count one many times.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import replace

from app.formats.wire.stream import Counters
from app.health import FEET, light_of
from app.motion.basics import Role
from app.motion.health import Health, Light
from app.motion.snapshot import Snapshot

SPAN_S = 10.0
LOOK_S = 1.0
#: Amber and red from these shares on, and not for a single damaged packet.
DAMAGED = (0.005, 0.05)
LEAST_PACKETS = 3
_WORST = (Light.GREEN, Light.AMBER, Light.RED)


class Damage:
    """Watches the counters of a source's sensors. They may begin anew with another decoder."""

    def __init__(self) -> None:
        self._seen: dict[str, deque[tuple[float, int, int, int]]] = {}
        self._share: dict[str, float] = {}

    def share(self, sensor: str, counters: Counters, now_s: float) -> float:
        """The damaged part of what came in the last ten seconds, 0 to 1; a new one each second."""
        seen = self._seen.setdefault(sensor, deque())
        now = (now_s, counters.bytes_fed, counters.bytes_skipped, counters.bad_checksum)
        if seen and now[1] < seen[-1][1]:
            seen.clear()
        if seen and now_s - seen[-1][0] < LOOK_S:
            return self._share[sensor]
        seen.append(now)
        while len(seen) > 1 and now_s - seen[1][0] >= SPAN_S:
            seen.popleft()
        _, fed, skipped, bad = (b - a for a, b in zip(seen[0], now, strict=True))
        share = min(skipped / fed, 1.0) if bad >= LEAST_PACKETS and fed > 0 else 0.0
        self._share[sensor] = share
        return share

    def told(self, feet: Mapping[Role, Counters], now_s: float) -> str:
        """Which foot's line damages packets now, in words; empty where none does."""
        shares = {role: self.share(role.value, counters, now_s) for role, counters in feet.items()}
        worst = max(shares, key=lambda role: shares[role], default=Role.OTHER)
        share = shares.get(worst, 0.0)
        return _words(worst, share) if light_of(share, DAMAGED) is not None else ""

    def seen(self, snapshot: Snapshot, counters: Mapping[str, Counters], now_s: float) -> Snapshot:
        """With what the line does to each sensor's health, where that is the worse or explains it."""
        if not counters:
            return snapshot
        roles = {foot.sensor: foot.role for foot in snapshot.main.feet}
        health = dict(snapshot.health)
        for sensor in health.keys() & counters.keys():
            share = self.share(sensor, counters[sensor], now_s)
            health[sensor] = _with(health[sensor], roles.get(sensor, Role.OTHER), share)
        return replace(snapshot, health=health)


def _with(told: Health, role: Role, share: float) -> Health:
    if told.recent is None:
        return told
    told = told._replace(recent=told.recent._replace(damaged=share))
    light = light_of(share, DAMAGED)
    if light is None or _WORST.index(light) < _WORST.index(told.light):
        return told
    return told._replace(light=light, reason=_words(role, share))


def _words(role: Role, share: float) -> str:
    percents = max(1, round(100.0 * share))  # whole ones: they change so seldom that they can be read
    words = f"{percents} % of packets damaged in the last 10 s: check cable, plug and baud rate"
    return f"{FEET[role]}: {words}"
