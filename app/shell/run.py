"""Shell: the walk viewer: opens source, scene and door, and joins them on one loop.

Acquisition, session and drawing share this loop; viser and the door have their own threads; long work
(compiling, re-estimation, the search for gains) runs in worker threads and never holds up a sample.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import math
import signal
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from app import preflight
from app.clocks import Clock, clock_for
from app.damage import Damage
from app.door.access import Access
from app.door.files import Files
from app.door.front import Door
from app.door.hand_in import HandIn
from app.estimator import sweep as gains
from app.formats.journal import Start
from app.health import report
from app.home import profiles
from app.home.key import key
from app.launch import open_in_browser
from app.measures import measures
from app.motion.basics import Floats, InputError, Role, role_of
from app.motion.commands import (
    ApplyCandidate,
    Calibrate,
    CheckFirst,
    Command,
    FindGains,
    LoadProfile,
    LookBack,
    Loop,
    Mark,
    OpenTown,
    Order,
    Pause,
    Play,
    Record,
    Rename,
    ReplaceCandidate,
    RestartHere,
    SaveProfile,
    Seek,
    SetDeclination,
    SetErrors,
    Share,
    Speed,
    Step,
    Swing,
    TakeLesson,
)
from app.motion.recording import Landing, Stretch
from app.motion.samples import Sample
from app.motion.snapshot import FootView, Snapshot
from app.motion.source import Link
from app.motion.status import Reference, Status
from app.outputs.recorder import Recorder
from app.saving import Saver
from app.scene.page import Scene
from app.session import DEFAULT_BUDGET, Session
from app.settings import Settings
from app.shell.annexe import Annexe
from app.shell.aside import aside
from app.shell.before import Before
from app.shell.hand_in import Seen, hand_in
from app.shell.librarian import Librarian
from app.shell.remembering import Remembering
from app.simulate import lab as lessons
from app.sources.glanced import Glanced, glanced
from app.sources.opening import open_source
from app.sources.phone import PhoneSource
from app.sources.source import Source
from app.tracks import Reestimation, Track
from app.warm import warm_up

log = logging.getLogger(__name__)

FRAME_S = 1 / 60
#: A sample that comes this long before or after a frame is due is drawn at once.
EARLY_S = 0.006
#: Between looks whether the walk halts.
HALT_S = 0.2
#: Between looks at the folder of profiles.
PROFILES_S = 2.0
#: Where a foot is drawn is recorded this often.
POSES_S = 0.04
#: A seek waits while so much waits for the disk.
MOST_WAITING = 50_000
#: A message stays this long.
MESSAGE_S = 8.0


@dataclass(frozen=True)
class Options:
    """What the command line says."""

    source: str
    settings: Settings
    access: Access
    open_browser: bool
    budget_bytes: int = DEFAULT_BUDGET
    told: bool = False  # the settings were given: a recording's own changes are not repeated
    profile: str = "default"
    record: Path | None = None  # record from the beginning
    recordings: Path = Path("recordings")  # for the button
    reference: Reference | None = None
    declination_deg: float = 0.0  # magnetic north east of true north, for GPS tracks


def walk(options: Options, tell: Callable[[str], None]) -> None:
    """Serve the walk until Ctrl-C. ``tell`` prints a line. Bad input is ``InputError``."""
    source: Source | None = glanced(options.source) if options.record is None else None
    source = source or open_source(options.source, changes=not options.told, stretches=True, key=key())
    asyncio.run(Viewer(options, source).serve(tell))


class Viewer:
    """One walk being watched."""

    def __init__(self, options: Options, source: Source) -> None:
        self._options = options
        self._source = source
        self._coming: asyncio.Queue[tuple[str, Source]] = asyncio.Queue()
        self._librarian = Librarian(
            options.record or options.recordings,
            lambda line: self._say(line),
            lambda spec, opened: self._coming.put_nowait((spec, opened)),
            options.reference,
            options.declination_deg,
        )
        self._annexe = Annexe(options.access, lambda line: self._say(line))
        self._session = self._new_session(source.settings or options.settings, 0)
        self._recorder: Recorder | None = None
        self._saver = Saver()
        self._filling: asyncio.Task[None] | None = None
        self._posed_s = 0.0
        self._strides: dict[str, tuple[int, int]] = {}  # epoch and number of the last stride recorded
        self._orders: asyncio.Queue[Order] = asyncio.Queue()
        self._work = asyncio.Event()  # the session wants something re-estimated
        self._stop = asyncio.Event()
        self._fresh = asyncio.Event()  # there is something that no frame has shown
        # two for a search, one so that a slider never waits for it
        self._workers = ThreadPoolExecutor(3, thread_name_prefix="estimate")
        self._prepare_source()
        self._damage = Damage()
        self._seen: Snapshot | None = None  # the newest that was drawn
        self._shown: Status | None = None  # with it
        self._frames = 0
        self._status = Status(source.info, source.link, profiles=profiles.names())
        self._message_until = 0.0
        self._last_sample_s = time.monotonic()
        self._sweeping: asyncio.Task[None] | None = None
        self._give_up = False

    def _prepare_source(self) -> None:
        """What stands between a source and the session."""
        self._before = Before(lambda: self._source.info, self._mark_preflight)
        self._remembering = Remembering(lambda: self._source.info, lambda name: self._before.calibrated(name))

    async def serve(self, tell: Callable[[str], None]) -> None:
        """Open the page, then everything else."""
        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, self._stop.set)

        def submit(order: Order) -> None:
            loop.call_soon_threadsafe(self._orders.put_nowait, order)

        with contextlib.ExitStack() as closing:
            closing.callback(self._workers.shutdown, wait=False, cancel_futures=True)
            closing.callback(lambda: self._remembering.keep(self._session))
            closing.callback(self._record, False)
            closing.callback(lambda: self._source.close())
            if self._options.record is not None:
                self._record(True)
            scene = Scene(submit)
            closing.callback(scene.close)
            door = Door(
                self._options.access,
                viser_port=scene.port,
                rules=scene.rules,
                health=self._health,
                measures=lambda: measures(self._seen, self._shown, self._frames),
                extra_head=scene.head,
                files=Files(self._librarian.shelf.folder, self._librarian.shelf.receive),
                taker=self._source if isinstance(self._source, PhoneSource) else None,
                hand_in=HandIn(hand_in(lambda: self._see(scene))),
            )
            closing.callback(door.stop)
            door.start()
            for line in door.greeting():
                tell(line)
            if self._options.open_browser:
                open_in_browser(door.address)
            try:
                await self._run(scene)
            finally:
                await self._annexe.close()
            self._give_up = True

    async def _run(self, scene: Scene) -> None:
        tasks = [
            asyncio.create_task(self._draw(scene), name="draw"),
            asyncio.create_task(self._obey(), name="orders"),
            asyncio.create_task(self._acquire(), name="acquire"),
            asyncio.create_task(self._reestimate(), name="re-estimate"),
            asyncio.create_task(self._watch_profiles(), name="profiles"),
            asyncio.create_task(self._librarian.look(), name="library"),
            asyncio.create_task(self._look_back(), name="look back"),
        ]
        stop = asyncio.create_task(self._stop.wait(), name="stop")
        done, _ = await asyncio.wait([stop, *tasks], return_when=asyncio.FIRST_COMPLETED)
        for task in [stop, *tasks]:
            task.cancel()
        await asyncio.wait([stop, *tasks], timeout=1.0)
        for task in done - {stop}:
            task.result()  # a fault of ours: let it be seen

    # --- in ----------------------------------------------------------------------------------------

    async def _acquire(self) -> None:
        """Read the source; where another one comes, leave it for that one."""
        if isinstance(self._source, Glanced):
            self._librarian.open(self._options.source, changes=not self._options.told)
        await self._prepare()
        while True:
            reading = asyncio.create_task(self._read(), name="read")
            coming = asyncio.create_task(self._coming.get(), name="coming")
            try:
                await asyncio.wait((reading, coming), return_when=asyncio.FIRST_COMPLETED)
                if not coming.done():
                    return await reading
            finally:
                reading.cancel()
                coming.cancel()
            await asyncio.wait((reading,))
            self._begin(*coming.result())

    def _begin(self, spec: str, source: Source) -> None:
        """Another source is another walk, on the same page."""
        self._record(False)
        self._remembering.keep(self._session)
        self._source.close()
        self._source, before = source, self._session
        self._options = replace(self._options, source=spec)
        self._prepare_source()
        self._session = self._new_session(source.settings or before.main.settings, before.epoch + 1)
        self._status = replace(self._status, sweep=None, sweep_progress=None, lesson="")
        self._last_sample_s = time.monotonic()

    def _new_session(self, settings: Settings, epoch: int) -> Session:
        info, budget = self._source.info, self._options.budget_bytes
        return Session(settings, self._role, info.truth, budget, self._clock, epoch, info.rod_m)

    async def _read(self) -> None:
        async for item in self._source:
            if isinstance(item, RestartHere):
                self._take_order(Order(item, "replay", time.monotonic_ns()))
                if self._recorder is not None:
                    self._start_in(self._recorder)
            elif isinstance(item, Order):
                self._take_order(item)
            elif isinstance(item, Stretch):
                await self._take_stretch(item)
            elif isinstance(item, Landing):
                await self._land(item)
            else:
                self._take_sample(item)

    def _take_sample(self, sample: Sample) -> None:
        sample = self._before.sample(sample)
        if (known := self._remembering.order(sample.sensor)) is not None:
            self._apply(known)
        self._session.take(sample)
        if self._recorder is not None:
            self._recorder.sample(sample)
        self._fresh.set()
        self._last_sample_s = time.monotonic()

    async def _land(self, landing: Landing) -> None:
        """Show a far place at once and fill in the walk before it; a recording of it wants every sample."""
        if self._recorder is None and not self._before.wants_each and self._session.land(landing):
            self._fresh.set()
            self._last_sample_s = time.monotonic()
            self._filling = asyncio.create_task(self._fill(), name="fill in")
            return
        for stretch in landing.steps():
            await self._take_stretch(stretch)
            await asyncio.sleep(0)

    async def _fill(self) -> None:
        session, job = self._session, self._session.applying.filling
        if job is not None:
            track = await asyncio.get_running_loop().run_in_executor(self._workers, reestimated, job)
            session.applying.filled(job, track)
            self._fresh.set()

    async def _take_stretch(self, stretch: Stretch) -> None:
        if self._before.wants_each:
            for sample in stretch.each():
                self._take_sample(sample)
            return
        self._session.take_stretch(stretch)
        self._fresh.set()
        self._last_sample_s = time.monotonic()
        if self._recorder is not None:
            for sample in stretch.each():
                self._recorder.sample(sample)
            while self._recorder.on and self._recorder.waiting > MOST_WAITING:
                await asyncio.sleep(0.01)

    async def _prepare(self) -> None:
        """Compile in a thread that does not hold up Ctrl-C, and say what is being compiled."""
        loop = asyncio.get_running_loop()

        def tell(what: str) -> None:
            with contextlib.suppress(RuntimeError):  # the program has ended meanwhile
                loop.call_soon_threadsafe(self._say, f"Preparing {what} (slow only the first time)", math.inf)

        await aside(lambda: warm_up(self._options.settings.estimator, tell), "prepare")
        self._say("")

    def _role(self, sensor: str) -> Role:
        named = self._before.names.get(sensor)
        return named or self._source.info.sensors.get(sensor) or role_of(sensor)

    def _clock(self, sensor: str) -> Clock:
        return clock_for(self._source.info, sensor)

    async def _obey(self) -> None:
        while True:
            self._take_order(await self._orders.get())

    def _take_order(self, order: Order) -> None:
        try:
            match order.command:
                case FindGains():
                    self._find_gains(order)
                case LoadProfile(name):
                    wanted = ReplaceCandidate(profiles.load_named(name), f"profile {name}")
                    self._apply(replace_command(order, wanted))
                case SaveProfile(name):
                    profiles.save(name, self._session.main.settings)
                    self._status = replace(self._status, profiles=profiles.names())
                    self._say(f"profile {name} saved")
                case Pause() | Step() | Speed() | Seek() | Loop() | SetErrors() as command:
                    self._source.control(command)
                case Record(on):
                    self._record(on)
                case Play() | Rename() | Share() | SetDeclination() as command:
                    self._librarian.take(command, self._session.main.settings)
                case Mark(text):
                    self._mark(order.who, text)
                case Calibrate() as command:
                    self._say(self._before.calibrate(command))
                case CheckFirst() as command:
                    self._before.check(command, {s: store.role for s, store in self._session.stores.items()})
                case OpenTown():
                    self._annexe.open()
                case TakeLesson(name):
                    errors, settings = lessons.lesson(name)
                    self._source.control(errors)
                    self._apply(replace_command(order, ReplaceCandidate(settings, f"lesson {name}")))
                    self._apply(replace_command(order, ApplyCandidate()))
                    self._status = replace(self._status, lesson=name)
                case Swing(angle_deg):
                    spec = lessons.pendulum(angle_deg)
                    self._coming.put_nowait((spec, open_source(spec, stretches=True)))
                case _:
                    self._apply(order)
        except InputError as error:
            self._say(str(error))
        if self._session.applying.wanted is not None:
            self._work.set()

    def _apply(self, order: Order) -> None:
        """Apply it, and record it: one that is refused is refused again in a replay."""
        try:
            self._session.apply(order)
        finally:
            if self._recorder is not None:
                self._recorder.order(self._session.number, order)

    # --- the recording -----------------------------------------------------------------------------

    def _record(self, on: bool) -> None:
        if self._recorder is not None and (not on or not self._recorder.on):
            self._recorder.close()
            self._status = replace(self._status, recording=self._recorder.state)
            self._recorder = None
        if on and self._recorder is None:
            folder = self._options.record or self._options.recordings
            made_by = self._source.made_by
            options = self._options
            self._recorder = Recorder(
                folder, options.profile, options.source, self._source.info, made_by, key=key()
            )
            self._start_in(self._recorder)

    def _start_in(self, recorder: Recorder) -> None:
        """What a walk that is recorded from here begins with."""
        recorder.start(self._start())
        for order in self._remembering.told:
            recorder.order(self._session.number, order)
        self._saver.begin(self._session)

    def _start(self) -> Start:
        """What the session holds now, for a walk that is recorded from here."""
        now = self._session.snapshot()
        return Start(now.main.settings, now.candidate_settings, now.apply_at_once)

    def _mark(self, who: str, text: str) -> None:
        if self._recorder is None:
            raise InputError("no recording to mark: start one first")
        self._recorder.marker(who, text)

    def _mark_preflight(self, told: str) -> None:
        if self._recorder is not None:
            self._recorder.marker("pre-flight", told)

    def _record_walk(self, feet: tuple[FootView, ...]) -> None:
        """Where the feet are drawn, and the strides that ended since the last look."""
        if self._recorder is None or time.monotonic() < self._posed_s + POSES_S:
            return
        self._posed_s = time.monotonic()
        self._recorder.learn(self._source.info)
        epoch = self._session.epoch
        for foot in feet:
            self._recorder.pose(foot.sensor, foot.position_n, foot.q_nb)
            for stride in self._session.main.feet[foot.sensor].tracker.strides[-4:]:
                if (epoch, stride.number) > self._strides.get(foot.sensor, (0, -1)):
                    self._strides[foot.sensor] = (epoch, stride.number)
                    self._recorder.stride(foot.sensor, stride)
        for due in self._saver.due(self._session):
            self._recorder.estimate(*due)

    # --- long work ---------------------------------------------------------------------------------

    async def _reestimate(self) -> None:
        loop = asyncio.get_running_loop()
        while True:
            await self._work.wait()
            self._work.clear()
            job = self._session.applying.wanted
            if job is not None:
                track = await loop.run_in_executor(self._workers, reestimated, job)
                self._session.applying.adopt(job, track)
                self._fresh.set()
                if self._session.applying.wanted is not None:
                    self._work.set()

    async def _look_back(self) -> None:
        """Once at each halt (a pause, the end) have the walk smoothed, if its settings ask for hindsight."""
        seen = -1
        while True:
            await asyncio.sleep(HALT_S)
            halted = self._source.link in (Link.PAUSED, Link.ENDED)
            if halted and self._session.main.settings.hindsight and self._session.number != seen:
                self._take_order(Order(LookBack(), "hindsight", time.monotonic_ns()))
                seen = self._session.number

    def _find_gains(self, order: Order) -> None:
        if self._sweeping is not None and not self._sweeping.done():
            raise InputError("the search for gains is still running")
        if not self._session.main.feet:
            raise InputError("no samples yet: gains can be searched once there is a walk")
        gains.demand_gains(self._session.main.settings)
        self._status = replace(self._status, sweep_progress=0.0, sweep=None)
        self._sweeping = asyncio.create_task(self._sweep(order), name="sweep")

    async def _sweep(self, order: Order) -> None:
        loop = asyncio.get_running_loop()
        settings, epoch = self._session.main.settings, self._session.epoch
        stores = [store.samples.share() for store in self._session.stores.values()]
        bases = [self._session.main.bases().get(sensor) for sensor in self._session.stores]
        halves = np.array_split(gains.GAINS_STANCE, 2)  # two cores; each sees the whole walk
        done = np.zeros((len(stores), len(halves)))

        def closures(i: int, k: int) -> Floats:
            def progress(share: float) -> bool:
                done[i, k] = share
                total = float(done.mean())
                loop.call_soon_threadsafe(self._tell_progress, total)
                return not self._give_up

            return gains.sweep(stores[i], settings, halves[k], progress=progress, base=bases[i])

        jobs = [
            [loop.run_in_executor(self._workers, closures, i, k) for k in range(len(halves))]
            for i in range(len(stores))
        ]
        surfaces = [np.concatenate([await job for job in row]) for row in jobs]
        found = gains.best_of(surfaces)
        self._status = replace(self._status, sweep=found, sweep_progress=None)
        if epoch == self._session.epoch:
            best = settings.with_changes({"gain_stance": found.best[0], "gain_swing": found.best[1]})
            self._take_order(replace_command(order, ReplaceCandidate(best, "best gains")))

    def _tell_progress(self, done: float) -> None:
        if self._status.sweep_progress is not None:
            self._status = replace(self._status, sweep_progress=done)

    async def _watch_profiles(self) -> None:
        while True:
            await asyncio.sleep(PROFILES_S)
            found = await asyncio.to_thread(profiles.names)
            if found != self._status.profiles:
                self._status = replace(self._status, profiles=found)

    # --- out ---------------------------------------------------------------------------------------

    async def _draw(self, scene: Scene) -> None:
        """Show the present sixty times a second, each time as a sample comes, so that it is shown fresh.

        Without one it is drawn all the same. A fault in drawing is logged and never ends the walk.
        """
        due = time.monotonic()
        while True:
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(2 * EARLY_S):
                    await self._fresh.wait()
            try:
                snapshot, counters = self._session.snapshot(), self._source.counters
                snapshot = self._seen = self._damage.seen(snapshot, counters, time.monotonic())
                self._record_walk(snapshot.main.feet)
                self._shown = self._before.look(snapshot, self._status_now())
                self._session.name_feet(self._before.names)
                scene.draw(snapshot, self._shown)
                self._frames += 1
            except Exception:
                log.exception("drawing failed")
                await asyncio.sleep(1.0)
            due = max(due + FRAME_S, time.monotonic())
            await asyncio.sleep(max(0.001, due - EARLY_S - time.monotonic()))
            self._fresh.clear()

    def _status_now(self) -> Status:
        now = time.monotonic()
        if self._message_until and now > self._message_until:
            self._say("")
        link = self._source.link
        return replace(
            self._status,
            source=self._source.info,
            link=link,
            detail=self._source.detail,
            replay=self._source.replay,
            stale_s=now - self._last_sample_s if link in (Link.LIVE, Link.LOST) else 0.0,
            speed=self._source.speed,
            loop=self._source.loop,
            position_s=self._source.position_s,
            errors=self._source.errors,
            recording=self._recorder.state if self._recorder else self._status.recording,
            shelf=self._librarian.files,
            reference=self._librarian.reference,
            town=self._annexe.address,
        )

    def _see(self, scene: Scene) -> Seen:
        session, made_by = self._session, self._source.made_by
        return Seen(session.snapshot(), self._status_now(), session.errors_so_far(), made_by, scene.dark)

    def _say(self, message: str, seconds: float = MESSAGE_S) -> None:
        self._status = replace(self._status, message=message)
        self._message_until = time.monotonic() + seconds if message else 0.0

    def _health(self) -> dict[str, object]:
        """For /healthz; read on the door's thread, so only what is one read."""
        told: dict[str, object] = {"link": self._source.link.value, "taken": self._session.number}
        told["line"] = {sensor: vars(counters) for sensor, counters in self._source.counters.items()}
        checked = self._shown.preflight if self._shown else None
        told["preflight"] = preflight.told(checked) if checked else None
        return told | {"sensors": report(self._seen.health) if self._seen else {}}


def reestimated(job: Reestimation) -> Track:
    """A job's result; an estimator that is new to this run is compiled here, not where samples wait."""
    warm_up(job.settings.estimator)
    return job.run()


def replace_command(order: Order, command: Command) -> Order:
    """The same person's order, as another command."""
    return order._replace(command=command)
