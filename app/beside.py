"""Heart: what is seen beside the main track: a simulator's truth, the error, the sensor's own way, a rod."""

from __future__ import annotations

from collections.abc import Mapping

from app.hanging import pendulum_view
from app.motion.basics import Floats
from app.motion.samples import Sample
from app.motion.snapshot import OwnView, PendulumView, Trail
from app.motion.source import Truth
from app.own import OwnWalk
from app.stores import SensorStore
from app.tracks import FootTrack, Track
from app.truth import TruePlace, TrueWalk, attitude, errors, thinned

Stores = Mapping[str, SensorStore]


class Beside:
    """Of one walk, by sensor; drawn for comparison, never part of the estimate."""

    def __init__(self, truth: Truth | None, rod_m: float | None, epoch: int) -> None:
        """``truth`` is a simulator's; ``rod_m``: the sensor hangs on a rod of this length."""
        self._truth, self._rod_m = truth, rod_m
        self.begin(epoch)

    def begin(self, epoch: int) -> None:
        """Another walk begins."""
        self._epoch = epoch
        self._true: dict[str, TrueWalk] = {}
        self._errors_of: dict[str, tuple[str, int]] = {}  # of which track, up to which row
        self._own: dict[str, OwnWalk] = {}  # of sensors that tell their orientation
        #: The main track beside the truth over the last seconds, as ``Snapshot.errors``.
        self.errors: dict[str, Floats] = {}

    def take(self, sample: Sample, foot: FootTrack, main: Track) -> None:
        """Walk by the sensor's own orientation, too, if it tells one."""
        if sample.device_q_nb is None:
            return
        own = self._own.get(sample.sensor)
        if own is None:
            own = self._own[sample.sensor] = OwnWalk(f"own{self._epoch}.{sample.sensor}")
        own.take(sample, foot.phase, foot.tracker.levelled, foot.q_nb, foot.position_n, main.settings)

    def look(self, main: Track, stores: Stores) -> dict[str, TruePlace]:
        """The newest true place of each sensor, and the errors up to it; none of a real sensor."""
        if self._truth is None:
            return {}
        places = {}
        for sensor, foot in main.feet.items():
            store = stores[sensor]
            if sensor not in self._true:
                name = f"truth{self._epoch}.{sensor}"
                self._true[sensor] = TrueWalk(name, self._truth, sensor, store.begin_s)
            known = places[sensor] = self._true[sensor].look(store, main.settings)
            if self._errors_of.get(sensor) != (main.name, known.row):
                self._errors_of[sensor] = (main.name, known.row)
                self.errors[sensor] = errors(self._true[sensor].recent, foot.tracker.rows, foot.turns)
        return places

    def trails(self) -> dict[str, Trail]:
        """The truth, as far as it was looked at."""
        return {sensor: walk.trail() for sensor, walk in self._true.items()}

    def errors_so_far(self, main: Track, stores: Stores) -> dict[str, Floats]:
        """The main track beside the truth over the whole walk that is kept, as ``Snapshot.errors``."""
        found = {}
        for sensor, true in self._true.items():
            rows = main.feet[sensor].tracker.rows
            places = true.at(thinned(rows.start, rows.end), stores[sensor], main.settings)
            found[sensor] = errors(places, rows, main.feet[sensor].turns)
        return found

    def own(self, main: Track) -> dict[str, OwnView]:
        """The walks by the sensors' own orientations."""
        views = {name: own.view(main.feet[name].q_nb, main.settings) for name, own in self._own.items()}
        return {name: view for name, view in views.items() if view is not None}

    def pendulum(self, main: Track, stores: Stores) -> PendulumView | None:
        """The sensor on its rod; None where it walks."""
        if self._rod_m is None:
            return None
        for sensor, true in self._true.items():
            rows = main.feet[sensor].tracker.rows
            now = true.at([rows.end - 1], stores[sensor], main.settings)[0]
            return pendulum_view(self._rod_m, attitude(now, rows), now.q_nb, self.errors[sensor])
        return PendulumView(self._rod_m)
