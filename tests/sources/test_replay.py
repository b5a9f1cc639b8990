import asyncio
from collections.abc import AsyncIterator, Callable, Sequence
from itertools import pairwise

import pytest

from app.formats.reading import read
from app.motion.basics import InputError
from app.motion.commands import Loop, Pause, RestartHere, Seek, Speed, Step
from app.motion.samples import Sample
from app.sources.replay import HostClock, Replay
from app.sources.source import Item
from tests.formats.walks import keeper, random_samples

HUNDRED_HZ = ("foot", list(range(0, 2000, 10)))  # 200 samples, 1.99 s


async def take(stream: AsyncIterator[Item], count: int) -> list[Item]:
    """The next items; a replay that stalls fails by the test's time limit."""
    return [await anext(stream) for _ in range(count)]


async def everything(replay: Replay) -> list[Sample]:
    items = [item async for item in replay]
    return [item for item in items if isinstance(item, Sample)]


async def stalls(stream: AsyncIterator[Item]) -> asyncio.Task:
    """A task that waits for the next item, after every chance to get one."""
    task = asyncio.ensure_future(anext(stream))
    for _ in range(50):
        await asyncio.sleep(0)
    assert not task.done()
    return task


def seqs(items: Sequence[Item]) -> list[int | str]:
    return [item.seq if isinstance(item, Sample) else "restart" for item in items]


def timeless(items: Sequence[Item]) -> list[Sample]:
    return [item._replace(host_ns=0) for item in items if isinstance(item, Sample)]


def run(test: Callable[[], object]) -> None:
    asyncio.run(test())  # type: ignore[arg-type]


@pytest.mark.parametrize("speed", [0.1, 0.5, 1.0, 2.0, 8.0])
def test_the_recorded_pace_times_the_speed(recording_of, clock, speed: float) -> None:
    replay = Replay(recording_of(HUNDRED_HZ), speed=speed, finish=True, clock=clock)
    start = clock.ns
    items = asyncio.run(everything(replay))
    assert seqs(items) == list(range(200))
    assert clock.ns - start == pytest.approx(1.99e9 / speed, abs=6e6)
    late = [(item.host_ns - start) * speed - item.device_ns for item in items]
    assert min(late) > -10  # never early, but for the rounding of a nanosecond
    assert max(late) <= 5e6 * speed + 10
    assert replay.ended


def test_wake_ups_are_5_ms_apart_and_release_all_that_is_due(recording_of, clock) -> None:
    replay = Replay(recording_of(("foot", list(range(1000)))), finish=True, clock=clock)
    asyncio.run(everything(replay))
    assert min(clock.waits) >= 0.005
    assert len(clock.waits) == pytest.approx(200, abs=2)


def test_speed_zero_never_waits(recording_of, clock) -> None:
    replay = Replay(recording_of(HUNDRED_HZ), speed=0.0, finish=True, clock=clock)
    assert len(asyncio.run(everything(replay))) == 200
    assert clock.waits == []
    assert replay.position_s == replay.duration_s == pytest.approx(1.99)


def test_both_feet_come_in_time_order(recording_of, clock) -> None:
    recording = recording_of(("left", [0, 10, 20]), ("right", [5, 10, 25]), start_ns=10**18)
    items = asyncio.run(everything(Replay(recording, finish=True, clock=clock)))
    assert [(i.sensor, (i.device_ns - 10**18) // 10**6) for i in items] == [
        ("left", 0), ("right", 5), ("left", 10), ("right", 10), ("left", 20), ("right", 25),
    ]  # fmt: skip


def test_a_gap_is_waited_for(recording_of, clock) -> None:
    start = clock.ns
    asyncio.run(everything(Replay(recording_of(("foot", [0, 10, 10_010])), finish=True, clock=clock)))
    assert clock.ns - start == pytest.approx(10.01e9, abs=6e6)


def test_the_playhead_waits_for_the_reader(recording_of, clock) -> None:
    replay = Replay(recording_of(HUNDRED_HZ), finish=True, clock=clock)
    clock.ns += 5 * 10**9
    assert replay.position_s == 0.0
    start = clock.ns
    assert len(asyncio.run(everything(replay))) == 200
    assert clock.ns - start == pytest.approx(1.99e9, abs=6e6)


def test_a_pause_holds_and_goes_on_where_it_was(recording_of, clock) -> None:
    async def test() -> None:
        replay = Replay(recording_of(HUNDRED_HZ), clock=clock)
        stream = aiter(replay)
        await take(stream, 100)
        replay.control(Pause(True))
        waiting = await stalls(stream)
        position = replay.position_s
        clock.ns += 60 * 10**9
        assert replay.position_s == position == pytest.approx(0.99, abs=0.02)
        replay.control(Pause(False))
        assert (await waiting).seq == 100
        assert replay.position_s == pytest.approx(1.0, abs=0.02)

    run(test)


def test_steps_while_paused(recording_of, clock) -> None:
    async def test() -> None:
        replay = Replay(recording_of(HUNDRED_HZ), clock=clock)
        stream = aiter(replay)
        await take(stream, 3)
        replay.control(Step(5))  # not paused: no effect
        replay.control(Pause(True))
        waiting = await stalls(stream)
        replay.control(Step())
        assert (await waiting).seq == 3
        replay.control(Step(2))
        replay.control(Step(2))
        assert seqs(await take(stream, 4)) == [4, 5, 6, 7]
        assert replay.position_s == pytest.approx(0.07)
        replay.control(Step(1000))
        assert len(await take(stream, 192)) == 192
        (await stalls(stream)).cancel()

    run(test)


def test_a_seek_forward_releases_all_on_the_way_without_waiting(recording_of, clock) -> None:
    async def test() -> None:
        replay = Replay(recording_of(HUNDRED_HZ), clock=clock)
        stream = aiter(replay)
        await take(stream, 1)
        replay.control(Seek(1.0))
        before = clock.ns
        assert seqs(await take(stream, 100)) == list(range(1, 101))
        assert clock.ns == before
        assert replay.position_s == pytest.approx(1.0)
        await take(stream, 50)
        assert clock.ns - before == pytest.approx(0.5e9, abs=6e6)

    run(test)


def test_a_seek_backward_starts_the_walk_again(recording_of, clock) -> None:
    async def test() -> None:
        replay = Replay(recording_of(HUNDRED_HZ), clock=clock)
        stream = aiter(replay)
        await take(stream, 150)
        replay.control(Seek(0.5))
        before = clock.ns
        items = await take(stream, 52)
        assert seqs(items) == ["restart", *range(51)]
        assert isinstance(items[0], RestartHere)
        assert clock.ns == before
        assert seqs(await take(stream, 10)) == list(range(51, 61))
        assert clock.ns - before == pytest.approx(0.1e9, abs=6e6)

    run(test)


def test_seeks_beyond_the_ends_are_held_to_them(recording_of, clock) -> None:
    async def test() -> None:
        replay = Replay(recording_of(HUNDRED_HZ), clock=clock)
        stream = aiter(replay)
        await take(stream, 10)
        replay.control(Seek(-5.0))
        assert seqs(await take(stream, 2)) == ["restart", 0]
        replay.control(Seek(1e9))
        assert seqs(await take(stream, 199)) == list(range(1, 200))
        (await stalls(stream)).cancel()
        assert replay.ended
        assert replay.position_s == pytest.approx(1.99)

    run(test)


def test_two_seeks_at_once_end_where_the_second_says(recording_of, clock) -> None:
    async def test() -> None:
        replay = Replay(recording_of(HUNDRED_HZ), clock=clock)
        stream = aiter(replay)
        await take(stream, 100)
        replay.control(Pause(True))
        replay.control(Seek(0.2))
        replay.control(Seek(1.5))
        items = await take(stream, 152)
        assert seqs(items) == ["restart", *range(151)]
        (await stalls(stream)).cancel()
        assert replay.position_s == pytest.approx(1.5)

    run(test)


def test_a_change_of_speed_does_not_jump(recording_of, clock) -> None:
    async def test() -> None:
        replay = Replay(recording_of(HUNDRED_HZ), clock=clock)
        stream = aiter(replay)
        await take(stream, 50)
        for factor in (8.0, 0.1, 0.0, 2.0, 1.0):
            before = replay.position_s
            replay.control(Speed(factor))
            assert replay.position_s == pytest.approx(before, abs=0.0101)
            assert replay.speed == factor
        start, position = clock.ns, replay.position_s
        replay.control(Speed(4.0))
        await take(stream, 100)
        assert replay.position_s - position == pytest.approx(4e-9 * (clock.ns - start), abs=1e-6)

    run(test)


def test_at_the_end_it_waits_for_a_seek(recording_of, clock) -> None:
    async def test() -> None:
        replay = Replay(recording_of(HUNDRED_HZ), clock=clock)
        stream = aiter(replay)
        await take(stream, 200)
        waiting = await stalls(stream)
        assert replay.ended
        replay.control(Seek(0.0))
        assert isinstance(await waiting, RestartHere)
        assert not replay.ended
        assert seqs(await take(stream, 3)) == [0, 1, 2]

    run(test)


def test_at_the_end_it_waits_for_a_loop(recording_of, clock) -> None:
    async def test() -> None:
        replay = Replay(recording_of(HUNDRED_HZ), clock=clock)
        stream = aiter(replay)
        await take(stream, 200)
        waiting = await stalls(stream)
        replay.control(Loop(True))
        assert isinstance(await waiting, RestartHere)
        assert replay.loop

    run(test)


@pytest.mark.parametrize("speed", [0.0, 1.0])
def test_a_loop_repeats_the_same_samples(recording_of, clock, speed: float) -> None:
    async def test() -> None:
        replay = Replay(recording_of(HUNDRED_HZ), speed=speed, loop=True, clock=clock)
        stream = aiter(replay)
        rounds = [await take(stream, 200)]
        for _ in range(2):
            assert isinstance(await anext(stream), RestartHere)
            rounds.append(await take(stream, 200))
        for one, other in pairwise(rounds):
            assert timeless(one) == timeless(other)
            assert seqs(one) == list(range(200))

    run(test)


def test_a_loop_of_one_sample_leaves_the_loop_alive(recording_of) -> None:
    async def test() -> None:
        replay = Replay(recording_of(("foot", [0])), loop=True)
        stream = aiter(replay)
        items = await asyncio.wait_for(take(stream, 5), 30)
        assert seqs(items) == [0, "restart", 0, "restart", 0]

    run(test)


def test_a_long_burst_lets_others_run(recording_of, clock) -> None:
    """As fast as possible, a reader that needs 1 ms a sample: others get a turn every 6."""

    async def test() -> None:
        turns = 0

        async def other() -> None:
            nonlocal turns
            while True:
                turns += 1
                await asyncio.sleep(0)

        task = asyncio.ensure_future(other())
        async for _ in Replay(recording_of(("foot", list(range(600)))), speed=0.0, finish=True, clock=clock):
            clock.ns += 1_000_000
        task.cancel()
        assert turns >= 90

    run(test)


def test_a_command_wakes_the_sleeper_at_once(recording_of) -> None:
    """With the machine's own clock: a gap of an hour is left by a seek."""

    async def test() -> None:
        replay = Replay(recording_of(("foot", [0, 3_600_000])), clock=HostClock())
        stream = aiter(replay)
        await take(stream, 1)
        waiting = await stalls(stream)
        replay.control(Seek(3600.0))
        assert (await asyncio.wait_for(waiting, 30)).seq == 1

    run(test)


def test_bad_commands_change_nothing(recording_of, clock) -> None:
    replay = Replay(recording_of(HUNDRED_HZ), clock=clock)
    for command in (Speed(9.0), Speed(-1.0), Speed(float("nan")), Seek(float("nan")), Seek(float("inf"))):
        with pytest.raises(InputError, match="expected"):
            replay.control(command)
    assert (replay.speed, replay.position_s) == (1.0, 0.0)
    with pytest.raises(InputError):
        Replay(recording_of(HUNDRED_HZ), speed=100.0)


def test_what_it_says_of_itself(recording_of, clock) -> None:
    info = Replay(recording_of(("left", [0, 10, 20]), ("right", [5, 15, 25])), clock=clock).info
    assert (info.name, info.format) == ("walk.csv", "plain CSV")
    assert info.rate_hz == pytest.approx(100)
    assert dict(info.sensors) == {"left": "left", "right": "right"}
    assert info.duration_s == pytest.approx(0.025)


def test_what_the_thermometers_read_is_told_where_the_replay_is(clock) -> None:
    made = keeper()
    written = made.begin(0)
    for i, sample in enumerate(random_samples(40)):
        if i in (4, 20, 21):
            made.temperature("left" if i < 21 else "right", sample.host_ns, 20.0 + i)
        made.sample(sample)
    replay = Replay(read("x", written + made.end()), speed=0.0, clock=clock)

    async def test() -> None:
        stream = aiter(replay)
        assert replay.info.temperatures == {}
        await take(stream, 10)
        assert replay.info.temperatures == {"left": 24.0}
        await take(stream, 30)
        assert replay.info.temperatures == {"left": 40.0, "right": 41.0}
        replay.control(Seek(0.05))
        assert (await take(stream, 2))[0] == RestartHere()
        assert replay.info.temperatures == {}

    run(test)
