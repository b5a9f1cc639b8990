"""Shell: a source onto the disk without a browser."""

from __future__ import annotations

import asyncio
import contextlib
import signal
from collections.abc import Callable
from pathlib import Path

from app.formats.journal import Start
from app.home.calibrations import Corrections
from app.home.key import key
from app.motion.basics import InputError
from app.motion.commands import Order, RestartHere
from app.motion.samples import Sample
from app.motion.status import RecorderState
from app.outputs.recorder import Recorder
from app.saving import Saver
from app.session import Session
from app.settings import BUILT_IN
from app.shell.aside import aside
from app.shell.early import Early
from app.sources.opening import open_source
from app.sources.phone import PhoneSource
from app.sources.source import Source
from app.warm import warm_up

#: A recording without a browser may take longer to end: nobody waits for the page.
CLOSE_S = 30.0
#: Samples between looks whether a state is due, and memory for the walk as it is estimated.
LOOK_AFTER = 32
BUDGET = 64 * 2**20
#: What a walk from the recording starts with.
START = BUILT_IN["default"]


def record(spec: str, folder: Path, seconds: float | None, tell: Callable[[str], None]) -> RecorderState:
    """Record until the source ends, ``seconds`` are over or Ctrl-C; what was recorded."""
    source = open_source(spec, finish=True, changes=False)
    if isinstance(source, PhoneSource):
        raise InputError(f"{spec}: a phone comes by the page's port: walk --source {spec} --record {folder}")
    if source.replay:
        warm_up(START.estimator)
    recorder = Recorder(folder, "default", spec, source.info, source.made_by, key=key())
    tell(f"Recording to {recorder.path}  (Ctrl-C ends it)")
    recorder.start(Start(START, START, False))
    try:
        asyncio.run(_fill(source, recorder, seconds))
    finally:
        recorder.learn(source.info)
        source.close()
        recorder.close(CLOSE_S)
    return recorder.state


async def _fill(source: Source, recorder: Recorder, seconds: float | None) -> None:
    prepared = asyncio.create_task(aside(lambda: warm_up(START.estimator), "prepare"))
    if source.replay:  # it can wait; what a sensor sends is recorded at once
        await prepared
    task = asyncio.create_task(_take(source, recorder, prepared))
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, task.cancel)
    with contextlib.suppress(asyncio.CancelledError, TimeoutError):
        await asyncio.wait_for(task, seconds)


async def _take(source: Source, recorder: Recorder, prepared: asyncio.Task[None]) -> None:
    # nobody sees this walk and only each foot's own state is kept: it needs no clock
    session, corrections = Session(START, budget_bytes=BUDGET), Corrections(lambda: source.info)
    early = Early(session.take)
    recording = _record(source, recorder, session, early, corrections)
    try:
        if source.replay:
            await early.release(prepared)
            await recording
        else:
            await asyncio.gather(early.release(prepared), recording)
    finally:
        source.close()
        for sample in source.unread():  # whoever sent them may know that they have come
            recorder.sample(corrections.apply(sample))


async def _record(
    source: Source, recorder: Recorder, session: Session, early: Early[Sample], corrections: Corrections
) -> None:
    taken, saver = 0, Saver()
    saver.begin(session)
    async for item in source:
        taken += 1
        if isinstance(item, RestartHere):
            again = Order(item, "replay", 0)
            session.apply(again)
            saver.begin(session)
            recorder.order(taken, again)
            recorder.start(Start(START, START, False))
        elif isinstance(item, Sample):
            sample = corrections.apply(item)
            recorder.sample(sample)
            early.add(sample) if early.holds else session.take(sample)
            for due in saver.due(session) if taken % LOOK_AFTER == 0 and not early else ():
                recorder.estimate(*due)
            while early.full:
                await asyncio.sleep(0.02)
            if taken % LOOK_AFTER == 0:
                recorder.learn(source.info)
            while source.replay and recorder.waiting > 10_000:  # as fast as possible is as fast as the disk
                await asyncio.sleep(0.01)
        if not recorder.on:
            raise InputError(f"{recorder.path}: {recorder.state.trouble}")
