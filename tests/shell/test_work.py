"""Long work beside a walk: what was asked of one walk is no answer about the next."""

from __future__ import annotations

import asyncio

import pytest

from app.motion.basics import InputError
from app.motion.commands import FindGains, Order
from app.session import Session
from app.shell.work import Work
from tests.estimator.walks import PAPERS
from tests.sessions import WALK, fed, order


def test_gains_that_are_found_when_another_walk_has_begun_are_not_told() -> None:
    sessions, taken = [fed(Session(PAPERS), WALK)], list[Order]()

    async def search() -> Work:
        work = Work(lambda: sessions[-1], taken.append, lambda: None)
        work.find_gains(order(FindGains()))
        sessions.append(Session(PAPERS, epoch=1))
        work.forget()
        with pytest.raises(InputError, match="still running"):
            work.find_gains(order(FindGains()))
        while work._sweeping is not None and not work._sweeping.done():
            await asyncio.sleep(0.05)
        work.close()
        return work

    work = asyncio.run(asyncio.wait_for(search(), 300.0))
    assert (work.sweep, work.progress, taken) == (None, None, [])
