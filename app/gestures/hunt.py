"""Heart: targets to find and walk to, one after the other, against the clock."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from app.visit import Goal
from app.world import Place, Town

#: A target reached is celebrated for so long.
CHEER_S = 2.5


@dataclass(frozen=True)
class Hunt:
    """Where a visitor stands in the game. The clock runs from the first step to the last target."""

    order: tuple[Place, ...]
    found: int = 0
    seconds: float = 0.0
    running: bool = False
    reached_s: float = -math.inf  # on the hunt's own clock
    best_s: float | None = None

    @property
    def target(self) -> Place | None:
        """The one to walk to; None when all are found."""
        return self.order[self.found] if self.found < len(self.order) else None

    @property
    def cheering(self) -> bool:
        """Whether a target was reached a moment ago."""
        return self.seconds - self.reached_s < CHEER_S


def begin(town: Town, north: float, east: float, best_s: float | None = None) -> Hunt:
    """From here, always to the nearest target that is left: a round without long ways back."""
    left, order = list(town.targets), []
    while left:
        nearest = min(left, key=lambda p: math.hypot(p.north - north, p.east - east))
        left.remove(nearest)
        order.append(nearest)
        north, east = nearest.north, nearest.east
    return Hunt(tuple(order), best_s=best_s)


def go_on(hunt: Hunt, north: float, east: float, moving: bool, dt_s: float) -> Hunt:
    """The hunt a moment later: the clock starts with the first movement, a target counts once."""
    running = hunt.running or (moving and hunt.found == 0)
    seconds = hunt.seconds + (dt_s if running or hunt.target is None else 0.0)
    target = hunt.target
    if target is None or math.hypot(target.north - north, target.east - east) > target.radius_m:
        return replace(hunt, running=running, seconds=seconds)
    found = hunt.found + 1
    done = found == len(hunt.order)
    best = hunt.best_s if not done else min(seconds, hunt.best_s or math.inf)
    return replace(hunt, found=found, seconds=seconds, running=not done, reached_s=seconds, best_s=best)


def goal(hunt: Hunt, north: float, east: float) -> Goal | None:
    """The target, and how far it is from here."""
    target = hunt.target
    if target is None:
        return None
    away_m = math.hypot(target.north - north, target.east - east)
    return Goal(target.north, target.east, target.radius_m, away_m)
