"""Heart: the walk as a fold over one numbered log of samples and orders. No clock, no files, no threads.

``take`` and ``apply`` write the log's effects, ``snapshot`` tells the page.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from app.applying import Applying, Asked
from app.beside import Beside
from app.blocks import BLOCK
from app.clocks import Clock, FixedClock, LiveClock
from app.graphs import graph_of
from app.health import Monitor, judge
from app.memory import Memory
from app.motion.basics import Floats, GaitPhase, InputError, Role, role_of
from app.motion.commands import KnowBias, Order, RestartHere
from app.motion.health import Health
from app.motion.recording import Landing, Stretch
from app.motion.samples import GyroBias, Sample
from app.motion.snapshot import Snapshot
from app.motion.source import Truth
from app.settings import Settings
from app.stores import SensorStore
from app.tracks import Track, landed_track

DEFAULT_BUDGET = 512 * 2**20


class Session:
    """One walk: a sample store for each sensor and the tracks over them."""

    def __init__(
        self,
        settings: Settings,
        roles: Callable[[str], Role] = role_of,
        truth: Truth | None = None,
        budget_bytes: int = DEFAULT_BUDGET,
        clock: Callable[[str], Clock] = lambda _: FixedClock(),
        epoch: int = 0,
        rod_m: float | None = None,
    ) -> None:
        """``truth`` is a simulator's; over ``budget_bytes`` the oldest samples go; ``epoch``: the first.

        ``rod_m``: the sensor hangs on a rod of this length, and does not walk.

        ``clock`` gives each sensor's: times that are shown are on the one they share; the estimate's are not.
        """
        self.number = 0
        self.epoch = epoch
        self.log: list[Asked] = []
        self.stores: dict[str, SensorStore] = {}
        self.biases: dict[str, GyroBias] = {}  # known before the walk, by sensor
        self._remembered: dict[str, str] = {}  # when they were found, in words
        self._memory = Memory(budget_bytes, self.stores)
        self.applying = Applying(settings, self.stores, self.biases, self._memory, epoch)
        self._beside = Beside(truth, rod_m, epoch)
        self._roles = roles
        self._clock = clock
        self._clocks: dict[str, Clock] = {}  # what is known of a clock outlives a walk
        self._monitors: dict[str, Monitor] = {}
        self._origin_ns: int | None = None

    @property
    def main(self) -> Track:
        """The estimate that is applied."""
        return self.applying.main

    # --- in ----------------------------------------------------------------------------------------

    def take(self, sample: Sample) -> None:
        """One sample: kept, or dropped and counted; every track moves on."""
        self.number += 1
        sensor = sample.sensor
        store = self.stores.get(sensor) or self._open(sensor)
        if not store.take(sample):
            self._monitors[sensor].add(sample, False, GaitPhase.STANCE)
            return
        self._advance(store, sample.device_ns)
        foot = self.main.feet[sensor]
        self._monitors[sensor].add(sample, True, foot.phase)
        self._beside.take(sample, foot, self.main)
        if store.samples.end % BLOCK == 1:
            self._keep_budget()

    def take_stretch(self, stretch: Stretch) -> None:
        """Many samples of a recording: the same to the bit as one by one, at a hundredth of the cost."""
        self.number += len(stretch)
        full = False
        for rows in stretch.rows:
            store = self.stores.get(rows.samples.sensor) or self._open(rows.samples.sensor)
            store.take_rows(rows, stretch.host_ns)
            self._advance(store, rows.samples.device_ns + int(rows.samples.matrix[rows.first, 0]))
            self._monitors[store.sensor].skip()
            full |= store.samples.end % BLOCK == 1
        if full:
            self._keep_budget()

    def land(self, landing: Landing) -> bool:
        """Take a landing's samples from the states near its end, and want the walk before them filled in.

        To the bit what ``take_stretch`` makes of them once ``filled``; False, and nothing taken, where the
        states are not of this walk and its settings, or memory is short.
        """
        busy = self.applying.candidate is not None or self.applying.wanted is not None
        if busy or not self._memory.has_room_for(landing, self.main):
            return False
        track = landed_track(f"landed{self.number}", self.main.settings, landing)
        if track is None:
            return False
        self.applying.land(track)
        self.take_stretch(landing.stretch)
        self.applying.fill_in(self.number)
        return True

    def name_feet(self, roles: Mapping[str, Role]) -> None:
        """Which sensor is which foot, as somebody found out meanwhile: shown so, and linked if they are two.

        It is no order: what comes of it does not depend on when it was found out.
        """
        for sensor, role in roles.items():
            if sensor in self.stores:
                self.stores[sensor].role = role

    def apply(self, order: Order) -> None:
        """One order; it takes effect after the samples taken so far. An impossible one is ``InputError``."""
        self.number += 1
        asked = Asked(self.number, order)
        self.log.append(asked)
        try:
            match order.command:
                case RestartHere():
                    self._restart(asked)
                case KnowBias() as known:
                    self._know_bias(asked, known)
                case command if not self.applying.take(asked):
                    raise InputError(f"{type(command).__name__} is not for the session")
        except ValueError as error:
            raise InputError(str(error)) from None

    # --- inside ------------------------------------------------------------------------------------

    def _open(self, sensor: str) -> SensorStore:
        """The store of a sensor not seen before."""
        clock = self._clocks.setdefault(sensor, self._clock(sensor))
        store = self.stores[sensor] = SensorStore(sensor, self._roles(sensor), clock)
        self._monitors[sensor] = Monitor(clock)
        return store

    def _advance(self, store: SensorStore, first_ns: int) -> None:
        """Every track takes a sensor's new samples; the very first says where its walk begins in time."""
        if store.origin_ns is None:
            if self._origin_ns is None:
                self._origin_ns = store.clock.line.host(first_ns)
            store.origin_ns = self._origin_ns
        self.main.advance(store.sensor, store.samples)
        self.main.link(self.applying.worn)
        if self.applying.candidate is not None:
            self.applying.candidate.advance(store.sensor, store.samples)
            self.applying.candidate.link(self.applying.worn)

    def _keep_budget(self) -> None:
        self._memory.keep(self.main, self.applying.candidate, self.epoch)

    def _know_bias(self, asked: Asked, known: KnowBias) -> None:
        """A sensor's gyro bias from before: only a walk that has not begun can begin with it."""
        if known.sensor in self.stores:
            raise InputError(f"gyro bias of {known.sensor}: its walk has begun, expected before")
        self.biases[known.sensor] = GyroBias(known.rate_b, known.doubt_radps)
        self._remembered[known.sensor] = known.source
        self.applying.note(asked, f"{known.sensor}: gyro bias remembered, {known.source}")

    def _restart(self, asked: Asked) -> None:
        self.epoch += 1
        self.stores.clear()
        self._origin_ns = None
        self._memory.begin_anew()
        self._beside.begin(self.epoch)
        self.applying.begin_anew(asked, self.epoch)

    # --- out ---------------------------------------------------------------------------------------

    @property
    def stored_bytes(self) -> int:
        """Memory of all samples and rows."""
        return self._memory.stored_bytes(self.main, self.applying.candidate)

    def snapshot(self) -> Snapshot:
        """What the page needs, now. Its cost does not grow with the walk."""
        stores, main, applying, beside = self.stores, self.main, self.applying, self._beside
        true = beside.look(main, stores)
        now_s = max((s.shared_s(s.elapsed_s) for s in stores.values()), default=0.0)
        return Snapshot(
            number=self.number,
            t_s=now_s,
            main=main.view(stores, true),
            candidate=applying.candidate.view(stores, true) if applying.candidate else None,
            truth=beside.trails(),
            errors=dict(beside.errors),
            candidate_settings=applying.settings,
            pending=applying.wanted is not None,
            apply_at_once=applying.at_once,
            undo_depth=len(applying.undo),
            slots=dict(applying.slots),
            slot_now=applying.slot_now,
            changes=tuple(applying.changes[-20:]),
            graphs={name: graph_of(stores[name], foot) for name, foot in main.feet.items()},
            health={name: self._health(name, store, now_s) for name, store in stores.items()},
            hindsight_from_s=max(
                (s.shared_s(s.time_ns(s.samples.start) * 1e-9) for s in stores.values() if s.samples),
                default=0.0,
            ),
            stored_bytes=self.stored_bytes,
            budget_bytes=self._memory.budget_bytes,
            epoch=self.epoch,
            own=beside.own(main),
            remembered=dict(self._remembered),
            pendulum=beside.pendulum(main, stores),
        )

    def errors_so_far(self) -> dict[str, Floats]:
        """The main track beside the truth over the whole walk that is kept, as ``Snapshot.errors``."""
        return self._beside.errors_so_far(self.main, self.stores)

    def _health(self, sensor: str, store: SensorStore, now_s: float) -> Health:
        foot = self.main.feet.get(sensor)
        segments = 1 + len(foot.tracker.segments) if foot else 0
        behind_s = now_s - store.shared_s(store.elapsed_s)
        recent = self._monitors[sensor].recent(behind_s, live=isinstance(store.clock, LiveClock))
        light, reason = judge(store.role, recent, self.main.settings.magnetometer)
        counts = (store.samples.end, dict(store.dropped), store.saturated, segments)
        return Health(store.rate_hz(), *counts, recent, light, reason)
