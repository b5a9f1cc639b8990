"""Shell: the walk viewer: opens source, scene and door, and joins them on one loop.

Acquisition, session and drawing share this loop; viser and the door have their own threads; long work
(compiling, re-estimation, the search for gains) runs in worker threads and never holds up a sample.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import math
import time
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, replace
from pathlib import Path

from app import preflight
from app.damage import Damage
from app.door.access import Access
from app.door.files import Files
from app.door.front import Door
from app.door.hand_in import HandIn
from app.health import report
from app.home import profiles
from app.home.key import key
from app.measures import measures
from app.motion.basics import InputError
from app.motion.commands import (
    ApplyCandidate,
    Calibrate,
    CheckFirst,
    Command,
    FindGains,
    LoadProfile,
    Loop,
    Mark,
    OpenTown,
    Order,
    Pause,
    Play,
    Record,
    Rename,
    ReplaceCandidate,
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
from app.motion.snapshot import Snapshot
from app.motion.status import Reference, Status
from app.scene.page import Scene
from app.session import DEFAULT_BUDGET
from app.settings import Settings
from app.shell.annexe import Annexe
from app.shell.aside import aside
from app.shell.hand_in import Seen, hand_in
from app.shell.librarian import Librarian
from app.shell.serving import Desk, open_door
from app.shell.taping import Taping
from app.shell.walk import Walk
from app.shell.work import Work
from app.simulate import lab as lessons
from app.sources.glanced import Glanced, glanced
from app.sources.opening import open_source
from app.sources.phone import PhoneSource
from app.sources.source import Source
from app.warm import warm_up

log = logging.getLogger(__name__)

FRAME_S = 1 / 60
#: A sample that comes this long before or after a frame is due is drawn at once.
EARLY_S = 0.006
#: Between looks at the folder of profiles.
PROFILES_S = 2.0
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
        self._taping = Taping(
            options.record or options.recordings, options.profile, lambda: self.walk.session
        )
        self.walk = self._walk_of(source, options.settings, 0)
        self._coming: asyncio.Queue[tuple[str, Source]] = asyncio.Queue()
        self._librarian = Librarian(
            options.record or options.recordings,
            lambda line: self._say(line),
            lambda spec, opened: self._coming.put_nowait((spec, opened)),
            options.reference,
            options.declination_deg,
        )
        self._annexe = Annexe(options.access, lambda line: self._say(line))
        self._desk = Desk()
        self._fresh = asyncio.Event()  # there is something that no frame has shown
        self._work = Work(lambda: self.walk.session, self._take_order, self._fresh.set)
        self._damage = Damage()
        self._seen: Snapshot | None = None  # the newest that was drawn
        self._shown: Status | None = None  # with it
        self._frames = 0
        self._status = Status(source.info, source.link, profiles=profiles.names())
        self._message_until = 0.0

    async def serve(self, tell: Callable[[str], None]) -> None:
        """Open the page, then everything else."""
        self._desk.open()
        with contextlib.ExitStack() as closing:
            closing.callback(self._taping.stop)
            closing.callback(lambda: self.walk.close())
            if self._options.record is not None:
                self._record(True)
            scene = Scene(self._desk.submit)
            closing.callback(scene.close)
            door = Door(
                self._options.access,
                viser_port=scene.port,
                rules=scene.rules,
                health=self._health,
                measures=lambda: measures(self._seen, self._shown, self._frames),
                extra_head=scene.head,
                files=Files(self._librarian.shelf.folder, self._librarian.shelf.receive),
                taker=self.walk.source if isinstance(self.walk.source, PhoneSource) else None,
                hand_in=HandIn(hand_in(lambda: self._see(scene))),
            )
            closing.callback(door.stop)
            open_door(door, tell, self._options.open_browser)
            try:
                await self._desk.until_stopped(self._parts(scene))
            finally:
                self._work.close()
                await self._annexe.close()

    def _parts(self, scene: Scene) -> list[Coroutine[None, None, None]]:
        """All that goes on at once."""
        return [
            self._draw(scene),
            self._obey(),
            self._acquire(),
            self._watch_profiles(),
            self._librarian.look(),
            self._work.reestimate(),
            self._work.look_back(lambda: self.walk.source),
        ]

    # --- in ----------------------------------------------------------------------------------------

    async def _acquire(self) -> None:
        """Read the source; where another one comes, leave it for that one."""
        if isinstance(self.walk.source, Glanced):
            self._librarian.open(self._options.source, changes=not self._options.told)
        prepared = asyncio.create_task(self._prepare(), name="prepare")
        while True:
            reading = asyncio.create_task(
                self.walk.read(self._take_order, self._fresh.set, self._work.fill, prepared), name="read"
            )
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
        before = self.walk
        before.close()
        self._taping.stop()
        self._options = replace(self._options, source=spec)
        self.walk = self._walk_of(source, before.session.main.settings, before.session.epoch + 1)
        self._work.forget()
        self._status = replace(self._status, lesson="")

    def _walk_of(self, source: Source, settings: Settings, epoch: int) -> Walk:
        return Walk(source, settings, self._options.budget_bytes, epoch, self._taping)

    async def _prepare(self) -> None:
        """Compile in a thread that does not hold up Ctrl-C, and say what is being compiled."""
        loop = asyncio.get_running_loop()

        def tell(what: str) -> None:
            with contextlib.suppress(RuntimeError):  # the program has ended meanwhile
                loop.call_soon_threadsafe(self._say, f"Preparing {what} (slow only the first time)", math.inf)

        await aside(lambda: warm_up(self._options.settings.estimator, tell), "prepare")
        self._say("")

    async def _obey(self) -> None:
        while True:
            self._take_order(await self._desk.orders.get())

    def _take_order(self, order: Order) -> None:
        try:
            match order.command:
                case FindGains():
                    self._work.find_gains(order)
                case LoadProfile(name):
                    wanted = ReplaceCandidate(profiles.load_named(name), f"profile {name}")
                    self.walk.apply(replace_command(order, wanted))
                case SaveProfile(name):
                    profiles.save(name, self.walk.session.main.settings)
                    self._status = replace(self._status, profiles=profiles.names())
                    self._say(f"profile {name} saved")
                case Pause() | Step() | Speed() | Seek() | Loop() | SetErrors() as command:
                    self.walk.source.control(command)
                case Record(on):
                    self._record(on)
                case Play() | Rename() | Share() | SetDeclination() as command:
                    self._librarian.take(command, self.walk.session.main.settings)
                case Mark(text):
                    self._taping.mark(order.who, text)
                case Calibrate() as command:
                    self._say(self.walk.before.calibrate(command))
                case CheckFirst() as command:
                    self.walk.before.check(
                        command, {s: store.role for s, store in self.walk.session.stores.items()}
                    )
                case OpenTown():
                    self._annexe.open()
                case TakeLesson(name):
                    errors, settings = lessons.lesson(name)
                    self.walk.source.control(errors)
                    self.walk.apply(replace_command(order, ReplaceCandidate(settings, f"lesson {name}")))
                    self.walk.apply(replace_command(order, ApplyCandidate()))
                    self._status = replace(self._status, lesson=name)
                case Swing(angle_deg):
                    spec = lessons.pendulum(angle_deg)
                    self._coming.put_nowait((spec, open_source(spec, stretches=True)))
                case _:
                    self.walk.apply(order)
        except InputError as error:
            self._say(str(error))
        self._work.wake()

    def _record(self, on: bool) -> None:
        if on:
            self.walk.record(self._options.source)
        else:
            self._taping.stop()

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
                snapshot, counters = self.walk.session.snapshot(), self.walk.source.counters
                snapshot = self._seen = self._damage.seen(snapshot, counters, time.monotonic())
                self._taping.walk(self.walk.info, None if self.walk.behind else snapshot.main.feet)
                self._shown = self.walk.before.look(snapshot, self._status_now())
                self.walk.session.name_feet(self.walk.before.names)
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
        return replace(
            self.walk.told(self._status),
            sweep=self._work.sweep,
            sweep_progress=self._work.progress,
            recording=self._taping.state,
            shelf=self._librarian.files,
            reference=self._librarian.reference,
            town=self._annexe.address,
        )

    def _see(self, scene: Scene) -> Seen:
        session, made_by = self.walk.session, self.walk.source.made_by
        return Seen(session.snapshot(), self._status_now(), session.errors_so_far(), made_by, scene.dark)

    def _say(self, message: str, seconds: float = MESSAGE_S) -> None:
        self._status = replace(self._status, message=message)
        self._message_until = time.monotonic() + seconds if message else 0.0

    def _health(self) -> dict[str, object]:
        """For /healthz; read on the door's thread, so only what is one read."""
        told = self.walk.health()
        checked = self._shown.preflight if self._shown else None
        told["preflight"] = preflight.told(checked) if checked else None
        return told | {"sensors": report(self._seen.health) if self._seen else {}}


def replace_command(order: Order, command: Command) -> Order:
    """The same person's order, as another command."""
    return order._replace(command=command)
