"""By channel or message by message: the same is found, in a whole file and in a damaged one."""

from __future__ import annotations

import random

import pytest

from app.formats import mcap
from app.formats.gathering import Doubles, gather
from tests.formats.walks import random_samples, write

WHOLE = write(random_samples(120), chunk=6)


def one_by_one(data: bytes) -> dict[str, list[tuple[int, int, int, bytes]]]:
    contents = mcap.read(data)
    found: dict[str, list] = {}
    for message in (message for chunk in contents.chunks for message in chunk):
        numbers = (message.sequence, message.log_ns, message.publish_ns, message.data)
        found.setdefault(contents.channels[message.channel].topic, []).append(numbers)
    return found


def by_channel(data: bytes) -> dict[str, list[tuple[int, int, int, bytes]]]:
    contents = gather(data, lambda channel: True)
    found = {}
    for number, channel in contents.channels.items():
        own = contents.gathered[number]
        stamps = (own.log_ns.astype("u8").tolist(), own.publish_ns.astype("u8").tolist())
        found[channel.topic] = list(zip(own.sequence.tolist(), *stamps, own.data, strict=True))
        assert (own.place[1:] > own.place[:-1]).all()
    return {topic: messages for topic, messages in found.items() if messages}


@pytest.mark.parametrize("together", [1, 3000, 2**20])
def test_a_damaged_file_gives_the_same_either_way(together: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.formats.gathering._TOGETHER", together)
    chance = random.Random(3)
    assert by_channel(WHOLE) == one_by_one(WHOLE)
    for _ in range(60):
        damaged = bytearray(WHOLE)
        for _ in range(3):
            damaged[chance.randrange(len(WHOLE))] ^= 1 << chance.randrange(8)
        assert by_channel(bytes(damaged)) == one_by_one(bytes(damaged))


def test_a_message_too_short_for_its_doubles_is_an_error() -> None:
    with pytest.raises(ValueError, match="too short"):
        gather(WHOLE, lambda channel: Doubles(10**4, (0,)))
