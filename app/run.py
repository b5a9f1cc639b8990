"""Shell: the walk viewer: opens source, scene and door, and joins them on one loop.

Acquisition, session and drawing share this loop; viser and the door have their own threads; long work
(compiling, re-estimation, the search for gains) runs in worker threads and never holds up a sample.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import signal
import sys
import threading
import time
import webbrowser
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from app import motion as m
from app import profiles
from app.door.front import Door
from app.estimator import sweep as gains
from app.scene.page import Scene
from app.session import DEFAULT_BUDGET, Session
from app.settings import Settings
from app.sources.opening import open_source
from app.sources.replay import Replay
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
    host: str
    port: int
    token: str | None
    open_browser: bool
    budget_bytes: int = DEFAULT_BUDGET


def walk(options: Options, tell: Callable[[str], None]) -> None:
    """Serve the walk until Ctrl-C. ``tell`` prints a line. Bad input is ``InputError``."""
    source = open_source(options.source)
    asyncio.run(Viewer(options, source).serve(tell))


class Viewer:
    """One walk being watched."""

    def __init__(self, options: Options, source: Replay) -> None:
        self._options = options
        self._source = source
        self._session = Session(options.settings, self._role, source.info.truth, options.budget_bytes)
        self._orders: asyncio.Queue[m.Order] = asyncio.Queue()
        self._work = asyncio.Event()  # the session wants something re-estimated
        self._stop = asyncio.Event()
        self._fresh = asyncio.Event()  # there is something that no frame has shown
        # two for a search, one so that a slider never waits for it
        self._workers = ThreadPoolExecutor(3, thread_name_prefix="estimate")
        self._status = m.Status(source.info, m.Link.WAITING, replay=True, profiles=profiles.names())
        self._message_until = 0.0
        self._last_sample_s = time.monotonic()
        self._sweeping: asyncio.Task[None] | None = None
        self._give_up = False

    async def serve(self, tell: Callable[[str], None]) -> None:
        """Open the page, then everything else."""
        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, self._stop.set)

        def submit(order: m.Order) -> None:
            loop.call_soon_threadsafe(self._orders.put_nowait, order)

        with contextlib.ExitStack() as closing:
            closing.callback(self._workers.shutdown, wait=False, cancel_futures=True)
            scene = Scene(submit)
            closing.callback(scene.close)
            door = Door(
                host=self._options.host,
                port=self._options.port,
                viser_port=scene.port,
                rules=scene.rules,
                health=self._health,
                token=self._options.token,
                extra_head=scene.head,
            )
            closing.callback(door.stop)
            door.start()
            tell(f"Stridescope is at {door.address}  (Ctrl-C ends it)")
            if self._options.open_browser:
                open_in_browser(door.address)
            await self._run(scene)
            self._give_up = True

    async def _run(self, scene: Scene) -> None:
        tasks = [
            asyncio.create_task(self._draw(scene), name="draw"),
            asyncio.create_task(self._obey(), name="orders"),
            asyncio.create_task(self._acquire(), name="acquire"),
            asyncio.create_task(self._reestimate(), name="re-estimate"),
            asyncio.create_task(self._watch_profiles(), name="profiles"),
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
        await self._prepare()
        async for item in self._source:
            if isinstance(item, m.RestartHere):
                self._take_order(m.Order(item, "replay", time.monotonic_ns()))
            else:
                self._session.take(item)
                self._fresh.set()
                self._last_sample_s = time.monotonic()

    async def _prepare(self) -> None:
        """Compile in a thread that does not hold up Ctrl-C, and say what is being compiled."""
        loop = asyncio.get_running_loop()
        ready = loop.create_future()

        def tell(what: str) -> None:
            loop.call_soon_threadsafe(self._say, f"Preparing {what} (slow only the first time)")

        def work() -> None:
            try:
                warm_up(tell)
                answer = partial(ready.set_result, None)
            except Exception as error:
                answer = partial(ready.set_exception, error)
            with contextlib.suppress(RuntimeError):  # the program has ended meanwhile
                loop.call_soon_threadsafe(answer)

        threading.Thread(target=work, name="prepare", daemon=True).start()
        await ready
        self._say("")

    def _role(self, sensor: str) -> m.Role:
        return self._source.info.sensors.get(sensor) or m.role_of(sensor)

    async def _obey(self) -> None:
        while True:
            self._take_order(await self._orders.get())

    def _take_order(self, order: m.Order) -> None:
        try:
            match order.command:
                case m.FindGains():
                    self._find_gains(order)
                case m.LoadProfile(name):
                    wanted = m.ReplaceCandidate(profiles.load_named(name), f"profile {name}")
                    self._session.apply(replace_command(order, wanted))
                case m.SaveProfile(name):
                    profiles.save(name, self._session.main.settings)
                    self._status = replace(self._status, profiles=profiles.names())
                    self._say(f"profile {name} saved")
                case m.Pause() | m.Step() | m.Speed() | m.Seek() | m.Loop() as command:
                    self._source.control(command)
                case _:
                    self._session.apply(order)
        except m.InputError as error:
            self._say(str(error))
        if self._session.wanted is not None:
            self._work.set()

    # --- long work ---------------------------------------------------------------------------------

    async def _reestimate(self) -> None:
        loop = asyncio.get_running_loop()
        while True:
            await self._work.wait()
            self._work.clear()
            job = self._session.wanted
            if job is not None:
                track = await loop.run_in_executor(self._workers, job.run)
                self._session.adopt(job, track)
                self._fresh.set()
                if self._session.wanted is not None:
                    self._work.set()

    def _find_gains(self, order: m.Order) -> None:
        if self._sweeping is not None and not self._sweeping.done():
            raise m.InputError("the search for gains is still running")
        if not self._session.main.feet:
            raise m.InputError("no samples yet: gains can be searched once there is a walk")
        gains.demand_gains(self._session.main.settings)
        self._status = replace(self._status, sweep_progress=0.0, sweep=None)
        self._sweeping = asyncio.create_task(self._sweep(order), name="sweep")

    async def _sweep(self, order: m.Order) -> None:
        loop = asyncio.get_running_loop()
        settings, epoch = self._session.main.settings, self._session.epoch
        stores = [store.samples.share() for store in self._session.stores.values()]
        bases = [self._session.main.bases().get(sensor) for sensor in self._session.stores]
        halves = np.array_split(gains.GAINS_STANCE, 2)  # two cores; each sees the whole walk
        done = np.zeros((len(stores), len(halves)))

        def closures(i: int, k: int) -> m.Floats:
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
            self._take_order(replace_command(order, m.ReplaceCandidate(best, "best gains")))

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
                scene.draw(self._session.snapshot(), self._status_now())
            except Exception:
                log.exception("drawing failed")
                await asyncio.sleep(1.0)
            due = max(due + FRAME_S, time.monotonic())
            await asyncio.sleep(max(0.001, due - EARLY_S - time.monotonic()))
            self._fresh.clear()

    def _status_now(self) -> m.Status:
        now = time.monotonic()
        if self._message_until and now > self._message_until:
            self._say("")
        link = self._link()
        return replace(
            self._status,
            link=link,
            stale_s=max(0.0, now - self._last_sample_s) if link is m.Link.LIVE else 0.0,
            speed=self._source.speed,
            loop=self._source.loop,
            position_s=self._source.position_s,
        )

    def _link(self) -> m.Link:
        if not self._session.stores:
            return m.Link.WAITING
        if self._source.paused:
            return m.Link.PAUSED
        return m.Link.ENDED if self._source.ended else m.Link.LIVE

    def _say(self, message: str) -> None:
        self._status = replace(self._status, message=message)
        self._message_until = time.monotonic() + MESSAGE_S if message else 0.0

    def _health(self) -> dict[str, object]:
        """For /healthz; read on the door's thread, so only what is one read."""
        return {"link": self._link().value, "taken": self._session.number}


def replace_command(order: m.Order, command: m.Command) -> m.Order:
    """The same person's order, as another command."""
    return order._replace(command=command)


def open_in_browser(address: str) -> None:
    """Open the page where there is a desktop; elsewhere the printed address is enough."""
    desktop = sys.platform == "darwin" or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))
    if desktop:
        with contextlib.suppress(webbrowser.Error):
            webbrowser.open(address)
