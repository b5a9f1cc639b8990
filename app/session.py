"""Heart: the walk as a fold over one numbered log of samples and orders. No clock, no files, no threads.

``take`` and ``apply`` write the log's effects, ``snapshot`` tells the page. Work that may take long
(re-estimating the walk under other settings) is handed out as a pure job, ``wanted``; whoever runs it,
on whatever thread, brings the result back with ``adopt``. The result does not depend on when.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

from app.blocks import BLOCK
from app.clocks import Clock, KnownClock, LiveClock
from app.graphs import graph_of
from app.hanging import pendulum_view
from app.health import Monitor, judge
from app.motion.basics import Floats, GaitPhase, InputError, Role, role_of
from app.motion.commands import (
    ApplyCandidate,
    Command,
    DropCandidate,
    KeepAs,
    KnowBias,
    LookBack,
    Order,
    ReplaceCandidate,
    ResetHeading,
    RestartHere,
    SetApplyAtOnce,
    SetCandidate,
    SwapAB,
    Undo,
)
from app.motion.estimate import ATTITUDE, ROW_WIDTH
from app.motion.health import Health
from app.motion.recording import Landing, Stretch
from app.motion.samples import SAMPLE_WIDTH, GyroBias, Sample
from app.motion.snapshot import Change, OwnView, PendulumView, Snapshot
from app.motion.source import Truth
from app.own import OwnWalk
from app.rotation import yaw_of
from app.settings import Settings
from app.tracks import Reestimation, SensorStore, Track, landed_track
from app.trail import TrailBuilder
from app.truth import TruePlace, TrueWalk, attitude, errors, thinned

#: Applied changes kept for the page.
CHANGES = 200
#: A slider moved again by the same person within this time is the same drag.
DRAG_NS = 2_000_000_000
SLIDER = "moved"
LOOKED_BACK = "smoothed in hindsight"
DEFAULT_BUDGET = 512 * 2**20


class Session:
    """One walk: a sample store for each sensor and the tracks over them."""

    def __init__(
        self,
        settings: Settings,
        roles: Callable[[str], Role] = role_of,
        truth: Truth | None = None,
        budget_bytes: int = DEFAULT_BUDGET,
        clock: Callable[[str], Clock] = lambda _: KnownClock(),
        epoch: int = 0,
        rod_m: float | None = None,
    ) -> None:
        """``truth`` is a simulator's; over ``budget_bytes`` the oldest samples go; ``epoch``: the first.

        ``rod_m``: the sensor hangs on a rod of this length, and does not walk.

        ``clock`` gives each sensor's: times that are shown are on the one they share; the estimate's are not.
        """
        self.number = 0
        self.epoch = epoch
        self.wanted: Reestimation | None = None
        self.filling: Reestimation | None = None  # after a landing
        self._landed: Track | None = None
        self._next: Reestimation | None = None  # a candidate moved while an apply was under way
        self.changes: list[Change] = []
        self.log: list[tuple[int, Order]] = []  # orders, each with the number it was taken under
        self.stores: dict[str, SensorStore] = {}
        self.biases: dict[str, GyroBias] = {}  # known before the walk, by sensor
        self.main = Track(f"main{epoch}", settings, self.biases)
        self.candidate: Track | None = None
        self._roles = roles
        self._truth, self._rod_m = truth, rod_m
        self._clock = clock
        self._clocks: dict[str, Clock] = {}  # what is known of a clock outlives a walk
        self._monitors: dict[str, Monitor] = {}
        self._origin_ns: int | None = None
        self._budget = budget_bytes
        self._apply_at_once = False
        self._undo: list[Settings] = []
        self._slots: dict[str, Settings] = {}
        self._slot_now: str | None = None
        self._last_apply = ("", "", 0)  # who, why, when
        self._jobs = 0
        self._frozen: dict[str, TrailBuilder] = {}  # the trail of samples that are gone
        self._true: dict[str, TrueWalk] = {}
        self._errors: dict[str, Floats] = {}
        self._errors_at: dict[str, int] = {}  # the row of the newest of them
        self._own: dict[str, OwnWalk] = {}  # of sensors that tell their orientation

    # --- in ----------------------------------------------------------------------------------------

    def take(self, sample: Sample) -> None:
        """One sample: kept, or dropped and counted; every track moves on."""
        self.number += 1
        store = self.stores.get(sample.sensor) or self._open(sample.sensor)
        monitor = self._monitors[sample.sensor]
        if not store.take(sample):
            monitor.add(sample, False, GaitPhase.STANCE)
            return
        self._place(store, sample.device_ns)
        self.main.advance(sample.sensor, store.samples)
        monitor.add(sample, True, self.main.feet[sample.sensor].phase)
        if self.candidate is not None:
            self.candidate.advance(sample.sensor, store.samples)
        if sample.device_q_nb is not None:
            self._take_own(sample)
        if store.samples.end % BLOCK == 1:
            self._keep_budget()

    def _take_own(self, sample: Sample) -> None:
        """Walk by the sensor's own orientation, too."""
        foot, name = self.main.feet[sample.sensor], sample.sensor
        own = self._own.get(name)
        if own is None:
            own = self._own[name] = OwnWalk(f"own{self.epoch}.{name}")
        own.take(sample, foot.phase, foot.tracker.levelled, foot.q_nb, foot.position_n, self.main.settings)

    def take_stretch(self, stretch: Stretch) -> None:
        """Many samples of a recording: the same to the bit as one by one, at a hundredth of the cost."""
        self.number += len(stretch)
        full = False
        for rows in stretch.rows:
            store = self.stores.get(rows.samples.sensor) or self._open(rows.samples.sensor)
            store.take_rows(rows, stretch.host_ns)
            self._place(store, rows.samples.device_ns + int(rows.samples.matrix[rows.first, 0]))
            self.main.advance(store.sensor, store.samples)
            self._monitors[store.sensor].skip()
            if self.candidate is not None:
                self.candidate.advance(store.sensor, store.samples)
            full |= store.samples.end % BLOCK == 1
        if full:
            self._keep_budget()

    def land(self, landing: Landing) -> bool:
        """Take a landing's samples from the states near its end, and want the walk before them filled in.

        To the bit what ``take_stretch`` makes of them once ``filled``; False, and nothing taken, where the
        states are not of this walk and its settings, or memory is short.
        """
        if self.candidate is not None or self.wanted is not None or not self._has_room_for(landing):
            return False
        track = landed_track(f"landed{self.number}", self.main.settings, landing)
        if track is None:
            return False
        self.main, track.biases = track, self.biases
        self._landed = track
        self.take_stretch(landing.stretch)
        fill = Reestimation(0, track.settings, {}, {}, True, "", "", 0, self.number, track.settings)
        self.filling = self._fresh(fill)
        return True

    def _has_room_for(self, landing: Landing) -> bool:
        """Whether the whole walk stays in memory, and goes on where the landing's samples begin."""
        row_bytes = 8 * (SAMPLE_WIDTH + 2 + 2 * ROW_WIDTH)
        here = {sensor: (store.samples.start, store.samples.end) for sensor, store in self.stores.items()}
        follows = all(here.get(r.samples.sensor, (0, 0)) == (0, r.first) for r in landing.stretch.rows)
        return follows and self.stored_bytes + len(landing) * row_bytes < self._budget // 2

    def filled(self, job: Reestimation, track: Track) -> None:
        """The whole walk up to where the session has landed, unless its estimate is another by now."""
        if self.filling is None or job.number != self.filling.number:
            return
        self.filling = None
        if self.main is self._landed and self._catch_up(track):
            self.main = track

    def _place(self, store: SensorStore, device_ns: int) -> None:
        """A sensor's first sample says where its walk begins on the clock that all share."""
        if store.origin_ns is None:
            self._origin_ns = self._origin_ns or store.clock.line.host(device_ns)
            store.origin_ns = self._origin_ns

    def _open(self, sensor: str) -> SensorStore:
        """The store of a sensor not seen before."""
        clock = self._clocks.setdefault(sensor, self._clock(sensor))
        store = self.stores[sensor] = SensorStore(sensor, self._roles(sensor), clock)
        self._monitors[sensor] = Monitor(clock)
        return store

    def name_feet(self, roles: Mapping[str, Role]) -> None:
        """Which sensor is which foot, as somebody found out meanwhile: for display only."""
        for sensor, role in roles.items():
            if sensor in self.stores:
                self.stores[sensor].role = role

    def apply(self, order: Order) -> None:
        """One order; it takes effect after the samples taken so far. An impossible one is ``InputError``."""
        self.number += 1
        self.log.append((self.number, order))
        try:
            self._apply(order, order.command)
        except ValueError as error:
            raise InputError(str(error)) from None

    def _apply(self, order: Order, command: Command) -> None:
        match command:
            case SetCandidate(changes):
                settings = self.candidate_settings.with_changes(dict(changes))
                moved = " ".join([SLIDER, *sorted(key for key, _ in changes)])
                self._want(order, settings, self._apply_at_once, moved)
            case ReplaceCandidate(settings, reason):
                self._want(order, settings, self._apply_at_once, reason)
            case ApplyCandidate():
                self._apply_candidate(order)
            case DropCandidate():
                self.wanted, self._next, self.candidate = self._coming, None, None
            case Undo():
                self._undo_last(order)
            case SetApplyAtOnce(on):
                self._apply_at_once = on
                if on and self.candidate_settings != self.main.settings:
                    self._apply(order, ApplyCandidate())
            case KeepAs(slot):
                if slot not in ("A", "B"):
                    raise InputError(f"keep as {slot!r}: expected A or B")
                self._slots[slot], self._slot_now = (self._coming or self.main).settings, slot
            case SwapAB():
                other = "A" if self._slot_now == "B" else "B"
                if other in self._slots:
                    self._slot_now = other
                    self._want(order, self._slots[other], True, f"swapped to {other}")
            case ResetHeading():
                self._reset_heading(order)
            case RestartHere():
                self._restart(order)
            case KnowBias():
                self._know_bias(order, command)
            case LookBack():
                self._look_back(order)
            case _:
                raise InputError(f"{type(command).__name__} is not for the session")

    @property
    def candidate_settings(self) -> Settings:
        """What the sliders show: the wanted, else the candidate's, else the main track's settings."""
        wanted = None if self.wanted is not None and self.wanted.look_back else self.wanted
        return (self._next or wanted or self.candidate or self.main).settings

    @property
    def _coming(self) -> Reestimation | None:
        """An apply whose track is not there yet: in the order of the log it has happened already."""
        return self.wanted if self.wanted is not None and self.wanted.apply else None

    def adopt(self, job: Reestimation, track: Track) -> None:
        """Bring back the result of a job.

        One that is no longer wanted is let go, but while something newer is awaited it is shown
        meanwhile, so that the ghost follows a slider that is being dragged.
        """
        wanted = self.wanted
        if wanted is None or job.epoch != self.epoch:
            return
        newest = job.number == wanted.number
        caught_up = self._catch_up(track)
        if not newest:
            self.candidate = track if caught_up else self.candidate
            return
        if not caught_up:
            self.wanted = self._fresh(wanted)
            return
        self.wanted = None
        if wanted.apply:
            self._make_main(track, wanted)
        else:
            self.candidate = track
        if self._next is not None:
            self.wanted, self._next = self._fresh(self._next), None

    def _catch_up(self, track: Track) -> bool:
        """Take the samples that came meanwhile; False where the store has moved past the track."""
        if any(
            foot.tracker.rows.end < self.stores[sensor].samples.start for sensor, foot in track.feet.items()
        ):
            return False
        bases, track.biases = self.main.bases(), self.biases
        for sensor, store in self.stores.items():
            if store.samples:
                track.drop_before(sensor, store.samples.start)
                track.advance(sensor, store.samples, bases.get(sensor))
        return True

    # --- inside ------------------------------------------------------------------------------------

    def _want(self, order: Order, settings: Settings, apply: bool, reason: str) -> None:
        coming = self._coming
        if settings == self.main.settings and (apply or coming is None):
            self.wanted, self._next, self.candidate = None, None, None
            return
        job = self._job(order, settings, apply, reason)
        if coming is None or apply:
            self._pass_over()
            self.wanted, self._next = self._fresh(job), None
        else:
            self._next = job if settings != coming.settings else None

    def _job(self, order: Order, settings: Settings, apply: bool, reason: str) -> Reestimation:
        before = (self._coming or self.main).settings
        return Reestimation(0, settings, {}, {}, apply, order.who, reason, order.host_ns, self.number, before)

    def _pass_over(self) -> None:
        """An apply that the next one overtakes has happened all the same: an undo goes back to it."""
        coming = self._coming
        if coming is not None and coming.reason != "undo" and not coming.look_back:
            self._undo.append(coming.before)

    def _fresh(self, job: Reestimation) -> Reestimation:
        """The same job, for the samples that are here now."""
        self._jobs += 1
        stores = {sensor: store.samples.share() for sensor, store in self.stores.items() if store.samples}
        worn = {sensor: store.worn for sensor, store in self.stores.items()}
        job = replace(job, number=self._jobs, epoch=self.epoch, biases=dict(self.biases), worn=worn)
        return replace(job, stores=stores, bases=self.main.bases())

    def _apply_candidate(self, order: Order) -> None:
        why = self._job(order, self.candidate_settings, True, "applied")
        if self._next is not None:
            self._pass_over()
            self.wanted, self._next = self._fresh(why), None
        elif self.wanted is not None and not self.wanted.apply:
            w = self.wanted
            self.wanted = replace(why, number=w.number, epoch=w.epoch, stores=w.stores, bases=w.bases)
        elif self.wanted is None and self.candidate is not None:
            self._make_main(self.candidate, why)

    def _undo_last(self, order: Order) -> None:
        coming = self._coming
        if coming is not None and coming.reason != "undo" and not coming.look_back:
            self.wanted = replace(
                coming, reason="undo"
            )  # given up: nothing to go back to but what was before
            self._want(order, coming.before, True, "undo")
        elif self._undo:
            self._want(order, self._undo.pop(), True, "undo")

    def _make_main(self, track: Track, why: Reestimation) -> None:
        if not self._same_drag(why) and why.reason != "undo" and not why.look_back:
            self._undo.append(why.before)
        reason = "slider" if why.reason.startswith(SLIDER) else why.reason
        what = f"{reason}: {why.before.differences(track.settings)}".removesuffix(": ")
        self._note(Change(why.taken, why.host_ns, why.who, what))
        turn_rad = track.settings.start_heading_rad - self.main.settings.start_heading_rad
        for sensor, frozen in self._frozen.items():
            if turn_rad:
                frozen.turn(f"frozen{self.epoch}t{self._jobs}.{sensor}", turn_rad)
            track.feet[sensor].builder.seed(frozen.finished())
        if self._slot_now in self._slots and self._slots[self._slot_now] != track.settings:
            self._slot_now = None
        self.main, self.candidate = track, self.candidate if why.look_back else None

    def _same_drag(self, why: Reestimation) -> bool:
        """Whether this goes on with the slider that the last apply moved: one drag is one step to undo."""
        last, self._last_apply = self._last_apply, (why.who, why.reason, why.host_ns)
        who, reason, host_ns = last
        return (
            why.reason.startswith(SLIDER)
            and (who, reason) == (why.who, why.reason)
            and 0 <= why.host_ns - host_ns < DRAG_NS
        )

    def _note(self, change: Change) -> None:
        self.changes.append(change)
        del self.changes[:-CHANGES]

    def _look_back(self, order: Order) -> None:
        """Smooth the main track, unless it is about to change anyway or has been smoothed up to now."""
        settings, now_s = self.main.settings, max((s.elapsed_s for s in self.stores.values()), default=0.0)
        done = self.main.smoothed_s is not None and self.main.smoothed_s >= now_s
        if settings.hindsight and settings.estimator == "kalman" and self._coming is None and not done:
            self._next = self._next or self.wanted
            job = self._job(order, settings, True, LOOKED_BACK)
            self.wanted = self._fresh(replace(job, look_back=True))

    def _know_bias(self, order: Order, known: KnowBias) -> None:
        """A sensor's gyro bias from before: only a walk that has not begun can begin with it."""
        if known.sensor in self.stores:
            raise InputError(f"gyro bias of {known.sensor}: its walk has begun, expected before")
        self.biases[known.sensor] = GyroBias(known.rate_b, known.doubt_radps)
        what = f"{known.sensor}: gyro bias remembered, {known.source}"
        self._note(Change(self.number, order.host_ns, order.who, what))

    def _reset_heading(self, order: Order) -> None:
        if (
            self._coming is not None
        ):  # the heading is that of the walk as applied: it cannot wait for a worker
            self.adopt(self._coming, self._coming.run())
        settings = self.main.settings
        for foot in self.main.feet.values():
            block, place = foot.tracker.rows.block(foot.tracker.rows.end - 1)
            yaw = yaw_of(tuple(block[place, ATTITUDE].tolist()))
            heading = math.remainder(self.main.settings.start_heading_rad - yaw, math.tau)
            changed = settings.with_changes({"start_heading_rad": heading})
            self._want(order, changed, True, "heading reset")
            return

    def _restart(self, order: Order) -> None:
        coming, shown = self._coming, self.candidate_settings
        self._note(Change(self.number, order.host_ns, order.who, "restarted here"))
        self.epoch += 1
        self.stores, self._frozen, self._true, self._origin_ns = {}, {}, {}, None
        self._errors, self._errors_at = {}, {}
        self._own = {}
        self.wanted, self._next, self.candidate, self.filling = None, None, None, None
        self.main = Track(f"main{self.epoch}", self.main.settings, self.biases)
        if coming is not None:
            self._make_main(Track(f"main{self.epoch}", coming.settings, self.biases), coming)
        if shown != self.main.settings:  # the sliders stay where they are
            self.candidate = Track(f"candidate{self.epoch}", shown, self.biases)

    def _keep_budget(self) -> None:
        """Let old blocks go; a candidate's place is kept free, so that what goes depends on samples only."""
        while self.stored_bytes + (0 if self.candidate else self.main.nbytes) > self._budget:
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

    def snapshot(self) -> Snapshot:
        """What the page needs, now. Its cost does not grow with the walk."""
        stores = self.stores
        true = self._look_at_truth()
        now_s = max((s.shared_s(s.elapsed_s) for s in stores.values()), default=0.0)
        return Snapshot(
            number=self.number,
            t_s=now_s,
            main=self.main.view(stores, true),
            candidate=self.candidate.view(stores, true) if self.candidate else None,
            truth={name: walk.trail() for name, walk in self._true.items()},
            errors=dict(self._errors),
            candidate_settings=self.candidate_settings,
            pending=self.wanted is not None,
            apply_at_once=self._apply_at_once,
            undo_depth=len(self._undo),
            slots=dict(self._slots),
            slot_now=self._slot_now,
            changes=tuple(self.changes[-20:]),
            graphs={name: graph_of(stores[name], foot) for name, foot in self.main.feet.items()},
            health={name: self._health(name, store, now_s) for name, store in stores.items()},
            hindsight_from_s=max(
                (s.time_ns(s.samples.start) * 1e-9 for s in stores.values() if s.samples), default=0.0
            ),
            stored_bytes=self.stored_bytes,
            budget_bytes=self._budget,
            epoch=self.epoch,
            own=self._look_at_own(),
            pendulum=self._look_at_pendulum(),
        )

    def errors_so_far(self) -> dict[str, Floats]:
        """The main track beside the truth over the whole walk that is kept, as ``Snapshot.errors``."""
        found = {}
        for sensor, true in self._true.items():
            rows, store = self.main.feet[sensor].tracker.rows, self.stores[sensor]
            wanted = thinned(rows.start, rows.end)
            found[sensor] = errors(true.at(wanted, store, self.main.settings), rows)
        return found

    def _look_at_own(self) -> dict[str, OwnView]:
        feet, settings = self.main.feet, self.main.settings
        views = {name: own.view(feet[name].q_nb, settings) for name, own in self._own.items()}
        return {name: view for name, view in views.items() if view is not None}

    def _look_at_pendulum(self) -> PendulumView | None:
        if self._rod_m is None:
            return None
        for sensor, true in self._true.items():
            rows, settings = self.main.feet[sensor].tracker.rows, self.main.settings
            now = true.at([rows.end - 1], self.stores[sensor], settings)[0]
            return pendulum_view(self._rod_m, attitude(now, rows), now.q_nb, self._errors[sensor])
        return PendulumView(self._rod_m)

    def _look_at_truth(self) -> dict[str, TruePlace]:
        if self._truth is None:
            return {}
        places = {}
        for sensor in self.main.feet:
            store = self.stores[sensor]
            if sensor not in self._true:
                name = f"truth{self.epoch}.{sensor}"
                self._true[sensor] = TrueWalk(name, self._truth, sensor, store.begin_s)
            known = places[sensor] = self._true[sensor].look(store, self.main.settings)
            if self._errors_at.get(sensor) != known.row:
                self._errors_at[sensor] = known.row
                self._errors[sensor] = errors(self._true[sensor].recent, self.main.feet[sensor].tracker.rows)
        return places

    def _health(self, sensor: str, store: SensorStore, now_s: float) -> Health:
        foot = self.main.feet.get(sensor)
        segments = 1 + len(foot.tracker.segments) if foot else 0
        behind_s = now_s - store.shared_s(store.elapsed_s)
        recent = self._monitors[sensor].recent(behind_s, live=isinstance(store.clock, LiveClock))
        light, reason = judge(store.role, recent, self.main.settings.magnetometer)
        counts = (store.samples.end, dict(store.dropped), store.saturated, segments)
        return Health(store.rate_hz(), *counts, recent, light, reason)
