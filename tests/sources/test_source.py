import asyncio

import pytest

from app.motion.basics import InputError
from app.motion.commands import Loop, Pause, Seek, Speed, Step
from app.motion.samples import Sample
from app.motion.source import Link
from app.simulate.walk import make_walk
from app.sources.replay import Replay
from app.sources.source import Live, Source


@pytest.mark.parametrize("command", [Pause(True), Step(), Speed(2.0), Seek(0.0), Loop(True)])
def test_nothing_pauses_a_live_source(command) -> None:
    with pytest.raises(InputError, match="live sensor"):
        Live().control(command)


def test_a_replay_says_what_it_is_doing() -> None:
    source: Source = Replay(make_walk({"strides": "1"}).recording, speed=0.0, finish=True)
    assert (source.link, source.detail, source.replay) == (Link.WAITING, "", True)

    async def samples() -> list[Sample]:
        return [item async for item in source if isinstance(item, Sample)]

    assert asyncio.run(samples())
    assert source.link is Link.ENDED
    source.close()
