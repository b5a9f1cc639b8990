"""Heart: two feet linked while they walk: their strides in the order of time into ``Together``, turns out.

What comes of it depends on the strides alone and on which came first by the clock that both sensors share,
never on when a sample arrived: live, in one go and in a replay it is the same to the bit.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from app.estimator.feet import Worn
from app.estimator.strides import Step
from app.estimator.together import Together
from app.estimator.tracker import Tracker
from app.estimator.turns import Turns
from app.motion.basics import Role
from app.settings import Settings

#: A contact is told at most so long after it, s.
TOLD_S = 0.15
#: A stride that waits for the other foot's samples for so many rows of its own is drawn as it is.
MOST_WAITING = 1024
Steps = Mapping[str, Sequence[Step]]
ALONE = Turns()


class Linking:
    """The link of a track's two feet; one with other sensors than a left and a right foot does nothing."""

    def __init__(self, settings: Settings, earlier: Steps | None = None) -> None:
        """``earlier``: strides by sensor before the first that its tracker tells."""
        self.on = settings.estimator == "kalman" and settings.feet_apart_m > 0.0
        self._settings = settings
        self._earlier = earlier or {}
        self._together = Together(settings.feet_apart_m, settings.start_heading_rad)
        self._names: tuple[str, ...] = ()  # left, right
        self._taken = [0, 0]  # strides
        self._seen = -1  # strides of both at the last look
        self._late: Tracker | None = None  # the foot whose samples a stride of the other waits for …
        self._late_ns = 0.0  # … up to this, from its first

    @property
    def linked(self) -> bool:
        """Whether two feet are held together now."""
        return self._together.linked

    @property
    def anew(self) -> int:
        """Times the whole walk was turned anew."""
        return self._together.anew

    @property
    def taken(self) -> int:
        """Strides looked at."""
        return sum(self._taken)

    def turns(self, sensor: str) -> Turns:
        """How a sensor's walk is turned."""
        return self._together.turns[self._names.index(sensor)] if sensor in self._names else ALONE

    def is_due(self, one: Tracker, other: Tracker) -> bool:
        """Whether there is anything to look at (cheap: it is asked for every sample)."""
        if len(one.steps) + len(other.steps) != self._seen:
            return self.on
        late = self._late
        return late is not None and float(late.state["elapsed_ns"][0]) > self._late_ns

    def look(self, trackers: Mapping[str, Tracker], worn: Mapping[str, Worn]) -> None:
        """Take the strides that are surely the next ones."""
        self._seen, self._late = sum(len(tracker.steps) for tracker in trackers.values()), None
        sides = {worn[name].role: name for name in trackers if name in worn}
        if set(sides) != {Role.LEFT, Role.RIGHT}:
            return
        self._names = (sides[Role.LEFT], sides[Role.RIGHT])
        feet = [(trackers[name], worn[name], self._earlier.get(name, ())) for name in self._names]
        if any(len(earlier) != tracker.strides_before for tracker, _, earlier in feet):
            return  # a walk that goes on from a saved state: its strides are not known
        while True:
            coming = []
            for side, (tracker, where, _) in enumerate(feet):
                step = self._next(side, tracker)
                now_s = float(tracker.state["elapsed_ns"][0]) * 1e-9 - TOLD_S if step is None else step.end_s
                coming.append((where.offset_s + where.pace * now_s, side, step))
            (_, side, step), (later_s, _, waiting) = sorted(coming, key=lambda one: one[0])
            if step is None:
                if waiting is not None:
                    tracker, where, _ = feet[side]
                    self._late = tracker
                    self._late_ns = ((later_s - where.offset_s) / where.pace + TOLD_S) * 1e9
                return
            self._together.take(side, step)
            self._taken[side] += 1

    def drawn_end(self, sensor: str, tracker: Tracker) -> int:
        """Rows of a sensor before this one are where they will be drawn."""
        end = tracker.settled_end
        waiting = self._next(self._names.index(sensor), tracker) if sensor in self._names else None
        if waiting is None or end - waiting.lift_row > MOST_WAITING:
            return end
        return min(end, waiting.lift_row + 1)

    def after_hindsight(self, trackers: Mapping[str, Tracker], linked: bool) -> Linking:
        """The link of what follows: the walk was made anew, and if ``linked`` its feet put together."""
        new = Linking(self._settings, self._earlier)
        if linked and self._names:
            left, right = (_newest(trackers[name]) for name in self._names)
            new._together = Together(
                self._settings.feet_apart_m, self._settings.start_heading_rad, (left, right)
            )
            new._names = self._names
            new._taken = [
                len(self._earlier.get(name, ())) + len(trackers[name].steps) for name in self._names
            ]
        return new

    def first_steps(self, sensor: str, tracker: Tracker, count: int, turn_rad: float) -> tuple[Step, ...]:
        """A sensor's first strides, in a walk that is turned clockwise about its start."""
        c, s = math.cos(turn_rad), math.sin(turn_rad)
        places = ((step, *step.place_n) for step in (*self._earlier.get(sensor, ()), *tracker.steps)[:count])
        return tuple(
            step._replace(place_n=(c * north - s * east, s * north + c * east))
            for step, north, east in places
        )

    def _next(self, side: int, tracker: Tracker) -> Step | None:
        place = self._taken[side]
        earlier = self._earlier.get(self._names[side], ())
        if place < len(earlier):
            return earlier[place]
        place -= len(earlier)
        return tracker.steps[place] if place < len(tracker.steps) else None


def _newest(tracker: Tracker) -> Step:
    """The last stride, where its footprint is now."""
    north, east, _ = tracker.strides[-1].end_n
    return tracker.steps[-1]._replace(place_n=(north, east))


def link_walked(trackers: Mapping[str, Tracker], worn: Mapping[str, Worn], settings: Settings) -> bool:
    """Two feet whose whole walks are there: as they were linked live, their rows and strides in place.

    Says whether they are linked.
    """
    linking = Linking(settings)
    if linking.on and len(trackers) == 2:
        linking.look(trackers, worn)
    for sensor, tracker in trackers.items():
        turns = linking.turns(sensor)
        for rows, number in tracker.rows.pieces(tracker.rows.start, tracker.rows.end):
            rows[:] = turns.from_row(number, rows)
        both = zip(tracker.strides, tracker.steps, strict=True)
        tracker.strides = [turns.of_stride(stride, step.contact_row) for stride, step in both]
    return linking.linked
