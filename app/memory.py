"""Heart: a walk's memory: over its budget the oldest samples and rows go, and their trail stays."""

from __future__ import annotations

from collections.abc import Mapping

from app.blocks import BLOCK
from app.motion.estimate import ROW_WIDTH
from app.motion.recording import Landing
from app.motion.samples import SAMPLE_WIDTH
from app.stores import SensorStore
from app.tracks import Track
from app.trail import TrailBuilder


class Memory:
    """What may be kept, and the trail of samples that are gone."""

    def __init__(self, budget_bytes: int, stores: Mapping[str, SensorStore]) -> None:
        """``stores`` are the session's own, by sensor."""
        self.budget_bytes = budget_bytes
        self._stores = stores
        self._frozen: dict[str, TrailBuilder] = {}

    def begin_anew(self) -> None:
        """Another walk: nothing of it is gone."""
        self._frozen = {}

    def stored_bytes(self, main: Track, candidate: Track | None) -> int:
        """Memory of all samples and rows."""
        stores = sum(s.samples.nbytes + s.clocks.nbytes for s in self._stores.values())
        return stores + main.nbytes + (candidate.nbytes if candidate else 0)

    def keep(self, main: Track, candidate: Track | None, epoch: int) -> None:
        """Let old blocks go; a candidate's place is kept free, so that what goes depends on samples only."""
        while self.stored_bytes(main, candidate) + (0 if candidate else main.nbytes) > self.budget_bytes:
            sensor, store = max(self._stores.items(), key=lambda item: len(item[1].samples))
            if len(store.samples) <= 2 * BLOCK:
                return
            frozen = self._frozen.setdefault(sensor, TrailBuilder(f"frozen{epoch}.{sensor}"))
            foot = main.feet[sensor]
            begin = foot.tracker.rows.start
            frozen.add(foot.table(begin, begin + BLOCK))
            store.samples.drop_oldest()
            store.clocks.drop_oldest()
            for track in (main, candidate):
                if track is not None and sensor in track.feet:
                    track.feet[sensor].drop_oldest()

    def seed(self, track: Track, turn_rad: float, name: str) -> None:
        """Give a new main track the trail of what is gone, turned if its start heading is another."""
        for sensor, frozen in self._frozen.items():
            if turn_rad:
                frozen.turn(f"frozen{name}.{sensor}", turn_rad)
            track.feet[sensor].builder.seed(frozen.finished())

    def has_room_for(self, landing: Landing, main: Track) -> bool:
        """Whether the whole walk stays in memory, and goes on where the landing's samples begin."""
        row_bytes = 8 * (SAMPLE_WIDTH + 2 + 2 * ROW_WIDTH)
        here = {sensor: (store.samples.start, store.samples.end) for sensor, store in self._stores.items()}
        follows = all(here.get(r.samples.sensor, (0, 0)) == (0, r.first) for r in landing.stretch.rows)
        return follows and self.stored_bytes(main, None) + len(landing) * row_bytes < self.budget_bytes // 2
