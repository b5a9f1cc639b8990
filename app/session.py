"""Heart: the walk as a fold over one numbered log of samples and orders. No clock, no files, no threads.

``take`` and ``apply`` write the log's effects, ``snapshot`` tells the page. Work that may take long
(re-estimating the walk under other settings) is handed out as a pure job, ``wanted``; whoever runs it,
on whatever thread, brings the result back with ``adopt``. The result does not depend on when.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from app import motion as m
from app.blocks import BLOCK
from app.rotation import from_yaw, rotate, yaw_of
from app.settings import Settings
from app.tracks import Reestimation, SensorStore, Track
from app.trail import TrailBuilder

#: Seconds that the graphs show, and about how many points.
GRAPH_S = 10.0
GRAPH_POINTS = 300
#: Applied changes kept for the page.
CHANGES = 200
#: The truth's trail is drawn from this many points a second.
TRUTH_HZ = 25.0
DEFAULT_BUDGET = 512 * 2**20


class Session:
    """One walk: a sample store for each sensor and the tracks over them."""

    def __init__(
        self,
        settings: Settings,
        roles: Callable[[str], m.Role] = m.role_of,
        truth: m.Truth | None = None,
        budget_bytes: int = DEFAULT_BUDGET,
    ) -> None:
        """``truth`` is a simulator's; over ``budget_bytes`` the oldest samples go."""
        self.number = 0
        self.epoch = 0
        self.wanted: Reestimation | None = None
        self.changes: list[m.Change] = []
        self.log: list[tuple[int, m.Order]] = []  # orders, each with the number it was taken under
        self.stores: dict[str, SensorStore] = {}
        self.main = Track("main", settings)
        self.candidate: Track | None = None
        self._roles = roles
        self._truth = truth
        self._budget = budget_bytes
        self._apply_at_once = False
        self._undo: list[Settings] = []
        self._slots: dict[str, Settings] = {}
        self._slot_now: str | None = None
        self._jobs = 0
        self._frozen: dict[str, TrailBuilder] = {}  # the trail of samples that are gone
        self._truth_trails: dict[str, tuple[Settings, int, TrailBuilder]] = {}

    # --- in ----------------------------------------------------------------------------------------

    def take(self, sample: m.Sample) -> None:
        """One sample: kept, or dropped and counted; every track moves on."""
        self.number += 1
        store = self.stores.get(sample.sensor)
        if store is None:
            store = self.stores[sample.sensor] = SensorStore(sample.sensor, self._roles(sample.sensor))
        if not store.take(sample):
            return
        self.main.advance(sample.sensor, store.samples)
        if self.candidate is not None:
            self.candidate.advance(sample.sensor, store.samples)
        if store.samples.end % BLOCK == 1:
            self._keep_budget()

    def apply(self, order: m.Order) -> None:
        """One order; it takes effect after the samples taken so far. An impossible one is ``InputError``."""
        self.number += 1
        self.log.append((self.number, order))
        try:
            self._apply(order, order.command)
        except ValueError as error:
            raise m.InputError(str(error)) from None

    def _apply(self, order: m.Order, command: m.Command) -> None:
        match command:
            case m.SetCandidate(changes):
                self._want(
                    order, self.candidate_settings.with_changes(dict(changes)), self._apply_at_once, "sliders"
                )
            case m.ReplaceCandidate(settings, reason):
                self._want(order, settings, self._apply_at_once, reason)
            case m.ApplyCandidate():
                if self.wanted is not None:
                    self.wanted = replace(self.wanted, apply=True, who=order.who, host_ns=order.host_ns)
                elif self.candidate is not None:
                    self._make_main(self.candidate, order.who, order.host_ns, "applied")
            case m.DropCandidate():
                self.wanted, self.candidate = None, None
            case m.Undo():
                if self._undo:
                    self._want(order, self._undo.pop(), True, "undo")
            case m.SetApplyAtOnce(on):
                self._apply_at_once = on
                if on and self.candidate_settings != self.main.settings:
                    self._apply(order, m.ApplyCandidate())
            case m.KeepAs(slot) if slot in ("A", "B"):
                self._slots[slot], self._slot_now = self.main.settings, slot
            case m.SwapAB():
                other = "A" if self._slot_now == "B" else "B"
                if other in self._slots:
                    self._slot_now = other
                    self._want(order, self._slots[other], True, f"swapped to {other}")
            case m.ResetHeading():
                self._reset_heading(order)
            case m.RestartHere():
                self._restart(order)
            case _:
                raise m.InputError(f"{type(command).__name__} is not for the session")

    @property
    def candidate_settings(self) -> Settings:
        """What the sliders show: the wanted, else the candidate's, else the main track's settings."""
        if self.wanted is not None:
            return self.wanted.settings
        return (self.candidate or self.main).settings

    def adopt(self, job: Reestimation, track: Track) -> None:
        """Bring back the result of ``wanted``; one that is no longer wanted is let go."""
        if self.wanted is None or job.number != self.wanted.number:
            return
        wanted, self.wanted = self.wanted, None
        for sensor, store in self.stores.items():
            if sensor in track.feet and track.feet[sensor].tracker.rows.end < store.samples.start:
                return  # the store has moved past it
            track.advance(sensor, store.samples, self.main.bases().get(sensor))
        if wanted.apply:
            self._make_main(track, wanted.who, wanted.host_ns, wanted.reason)
        else:
            self.candidate = track

    # --- inside ------------------------------------------------------------------------------------

    def _want(self, order: m.Order, settings: Settings, apply: bool, reason: str) -> None:
        if settings == self.main.settings:
            self.wanted, self.candidate = None, None
            return
        self._jobs += 1
        stores = {sensor: store.samples.share() for sensor, store in self.stores.items()}
        self.wanted = Reestimation(
            self._jobs, settings, stores, self.main.bases(), apply, order.who, reason, order.host_ns
        )

    def _make_main(self, track: Track, who: str, host_ns: int, reason: str) -> None:
        if reason != "undo":
            self._undo.append(self.main.settings)
        what = f"{reason}: {self.main.settings.differences(track.settings)}"
        self._note(who, host_ns, what)
        for sensor, frozen in self._frozen.items():
            track.feet[sensor].builder.seed(frozen.finished())
        if self._slot_now in self._slots and self._slots[self._slot_now] != track.settings:
            self._slot_now = None
        self.main, self.candidate = track, None

    def _note(self, who: str, host_ns: int, what: str) -> None:
        self.changes.append(m.Change(self.number, host_ns, who, what))
        del self.changes[:-CHANGES]

    def _reset_heading(self, order: m.Order) -> None:
        for foot in self.main.feet.values():
            block, place = foot.tracker.rows.block(foot.tracker.rows.end - 1)
            yaw = yaw_of(tuple(block[place, m.ATTITUDE].tolist()))
            heading = math.remainder(self.main.settings.start_heading_rad - yaw, math.tau)
            changed = self.main.settings.with_changes({"start_heading_rad": heading})
            self._want(order, changed, True, "heading reset")
            return

    def _restart(self, order: m.Order) -> None:
        self._note(order.who, order.host_ns, "restarted here")
        self.epoch += 1
        self.stores, self._frozen, self._truth_trails = {}, {}, {}
        self.wanted, self.candidate = None, None
        self.main = Track(f"main{self.epoch}", self.main.settings)

    def _keep_budget(self) -> None:
        while self.stored_bytes > self._budget:
            sensor, store = max(self.stores.items(), key=lambda item: len(item[1].samples))
            if len(store.samples) <= 2 * BLOCK:
                return
            frozen = self._frozen.setdefault(sensor, TrailBuilder(f"frozen{self.epoch}.{sensor}"))
            rows = self.main.feet[sensor].tracker.rows
            frozen.add(rows.table(rows.start, rows.start + BLOCK))
            store.samples.drop_oldest()
            store.clocks.drop_oldest()
            for track in (self.main, self.candidate):
                if track is not None and sensor in track.feet:
                    track.feet[sensor].drop_oldest()

    @property
    def stored_bytes(self) -> int:
        """Memory of all samples and rows."""
        stores = sum(s.samples.nbytes + s.clocks.nbytes for s in self.stores.values())
        return stores + self.main.nbytes + (self.candidate.nbytes if self.candidate else 0)

    # --- out ---------------------------------------------------------------------------------------

    def snapshot(self) -> m.Snapshot:
        """What the page needs, now. Its cost does not grow with the walk."""
        stores = self.stores
        truth_n = {name: self._true_position(name, s.elapsed_s) for name, s in stores.items() if self._truth}
        return m.Snapshot(
            number=self.number,
            t_s=max((s.elapsed_s for s in stores.values()), default=0.0),
            main=self.main.view(stores, truth_n),
            candidate=self.candidate.view(stores, truth_n) if self.candidate else None,
            truth={name: self._truth_trail(name, store) for name, store in stores.items() if self._truth},
            candidate_settings=self.candidate_settings,
            pending=self.wanted is not None,
            apply_at_once=self._apply_at_once,
            undo_depth=len(self._undo),
            slots=dict(self._slots),
            slot_now=self._slot_now,
            changes=tuple(self.changes[-20:]),
            graphs={
                name: self._graph(name, store) for name, store in stores.items() if name in self.main.feet
            },
            health={name: self._health(name, store) for name, store in stores.items()},
            hindsight_from_s=max(
                (s.time_ns(s.samples.start) * 1e-9 for s in stores.values() if s.samples), default=0.0
            ),
            stored_bytes=self.stored_bytes,
            budget_bytes=self._budget,
            epoch=self.epoch,
        )

    def _health(self, sensor: str, store: SensorStore) -> m.Health:
        foot = self.main.feet.get(sensor)
        segments = 1 + len(foot.tracker.segments) if foot else 0
        return m.Health(store.rate_hz(), store.samples.end, dict(store.dropped), store.saturated, segments)

    def _graph(self, sensor: str, store: SensorStore) -> m.Graph:
        rows = self.main.feet[sensor].tracker.rows
        begin = store.row_at(store.elapsed_s - GRAPH_S)
        stride = max(1, math.ceil((rows.end - begin) / GRAPH_POINTS))
        begin += -begin % stride  # the same rows from one graph to the next, or the line would shimmer
        times, values = [], []
        for piece, row in rows.pieces(begin, rows.end):
            offset = (begin - row) % stride
            block, place = store.samples.block(row)
            values.append(piece[offset::stride])
            times.append(block[place + offset : place + len(piece) : stride, 0] * 1e-9)
        table = np.concatenate(values) if values else np.empty((0, m.ROW_WIDTH))
        return m.Graph(
            t_s=np.concatenate(times) if times else np.empty(0),
            statistic=table[:, m.RowColumn.STATISTIC].copy(),
            swing=table[:, m.RowColumn.PHASE].copy(),
            speed_mps=np.linalg.norm(table[:, m.VELOCITY], axis=1),
            height_m=-table[:, m.RowColumn.DOWN],
        )

    def _true_positions(self, sensor: str, elapsed_s: m.Floats) -> m.Floats:
        """The simulator's positions [n, 3], turned to the main track's start heading."""
        assert self._truth is not None
        settings = self.main.settings
        position_n, q_nb = self._truth(sensor, np.append(0.0, elapsed_s))
        start = 0.0 if settings.magnetometer else yaw_of(tuple(q_nb[0].tolist()))
        turn = from_yaw(settings.start_heading_rad - start)
        if turn == (1.0, 0.0, 0.0, 0.0):
            return position_n[1:]
        return np.array([rotate(turn, tuple(p)) for p in position_n[1:].tolist()])

    def _true_position(self, sensor: str, elapsed_s: float) -> m.Floats:
        positions: m.Floats = self._true_positions(sensor, np.array([elapsed_s]))[0]
        return positions

    def _truth_trail(self, sensor: str, store: SensorStore) -> m.Trail:
        settings, done, builder = self._truth_trails.get(sensor, (None, 0, None))
        if builder is None or settings != self.main.settings:
            done, builder = 0, TrailBuilder(f"truth{self.number}.{sensor}")
        end = int(store.elapsed_s * TRUTH_HZ)
        if end > done:
            builder.add(self._true_positions(sensor, np.arange(done, end) / TRUTH_HZ))
        self._truth_trails[sensor] = (self.main.settings, end, builder)
        return builder.trail(np.empty((0, 3)))
