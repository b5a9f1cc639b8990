"""Shell: long work on a walk in worker threads: re-estimation, hindsight, the search for gains."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from app.estimator import sweep as gains
from app.motion.basics import Floats, InputError
from app.motion.commands import LookBack, Order, ReplaceCandidate
from app.motion.estimate import Sweep
from app.motion.source import Link
from app.session import Session
from app.sources.source import Source
from app.tracks import Reestimation, Track
from app.warm import warm_up

#: Between looks whether the walk halts.
HALT_S = 0.2


class Work:
    """What the session there is now wants done. Made, and used, on the loop."""

    def __init__(
        self, session: Callable[[], Session], take: Callable[[Order], None], changed: Callable[[], None]
    ) -> None:
        """``take`` obeys an order, ``changed`` says that there is something new to draw."""
        self._session, self._take, self._changed = session, take, changed
        self.sweep: Sweep | None = None  # the last search's
        self.progress: float | None = None  # 0…1 while it runs
        # two for a search, one so that a slider never waits for it
        self._workers = ThreadPoolExecutor(3, thread_name_prefix="estimate")
        self._wanted = asyncio.Event()
        self._filling: asyncio.Task[None] | None = None
        self._sweeping: asyncio.Task[None] | None = None
        self._give_up = False

    def close(self) -> None:
        """Give up what is under way."""
        self._give_up = True
        self._workers.shutdown(wait=False, cancel_futures=True)

    def forget(self) -> None:
        """Another walk: what was found of the last is void."""
        self.sweep = self.progress = None

    # --- tracks --------------------------------------------------------------------------------------

    def wake(self) -> None:
        """An order was taken: see whether something is to be re-estimated now."""
        if self._session().applying.wanted is not None:
            self._wanted.set()

    async def reestimate(self) -> None:
        """Do what is wanted, one job after the other."""
        while True:
            await self._wanted.wait()
            self._wanted.clear()
            job = self._session().applying.wanted
            if job is not None:
                track = await self._in_thread(job)
                self._session().applying.adopt(job, track)
                self._changed()
                self.wake()

    def fill(self, session: Session) -> None:
        """Estimate the walk before a landing."""
        self._filling = asyncio.create_task(self._fill(session), name="fill in")

    async def _fill(self, session: Session) -> None:
        job = session.applying.filling
        if job is not None:
            session.applying.filled(job, await self._in_thread(job))
            self._changed()

    async def _in_thread(self, job: Reestimation) -> Track:
        return await asyncio.get_running_loop().run_in_executor(self._workers, reestimated, job)

    async def look_back(self, source: Callable[[], Source]) -> None:
        """Once at each halt (a pause, the end) have the walk smoothed, if its settings ask for hindsight."""
        seen = -1
        while True:
            await asyncio.sleep(HALT_S)
            session, halted = self._session(), source().link in (Link.PAUSED, Link.ENDED)
            if halted and session.main.settings.looks_back and session.number != seen:
                self._take(Order(LookBack(), "hindsight", time.monotonic_ns()))
                seen = self._session().number

    # --- gains ---------------------------------------------------------------------------------------

    def find_gains(self, order: Order) -> None:
        """Begin a search over the walk so far; the best become the candidate's."""
        if self._sweeping is not None and not self._sweeping.done():
            raise InputError("the search for gains is still running")
        if not self._session().main.feet:
            raise InputError("no samples yet: gains can be searched once there is a walk")
        gains.demand_gains(self._session().main.settings)
        self.sweep, self.progress = None, 0.0
        self._sweeping = asyncio.create_task(self._sweep(order, self._session()), name="sweep")

    async def _sweep(self, order: Order, session: Session) -> None:
        loop = asyncio.get_running_loop()
        settings, epoch = session.main.settings, session.epoch
        stores = [store.samples.share() for store in session.stores.values()]
        bases = [session.main.bases().get(sensor) for sensor in session.stores]
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
        self.progress = None
        if epoch == self._session().epoch:
            self.sweep = found = gains.best_of(surfaces)
            best = settings.with_changes({"gain_stance": found.best[0], "gain_swing": found.best[1]})
            self._take(order._replace(command=ReplaceCandidate(best, "best gains")))

    def _tell_progress(self, done: float) -> None:
        if self.progress is not None:
            self.progress = done


def reestimated(job: Reestimation) -> Track:
    """A job's result; an estimator that is new to this run is compiled here, not where samples wait."""
    warm_up(job.settings.estimator)
    return job.run()
