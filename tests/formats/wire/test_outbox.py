"""What is kept until it is acknowledged, whatever is sent, acknowledged, cut and refused between."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.intake import Intake
from app.formats.wire.outbox import Outbox, Parcel
from app.formats.wire.reply import Ack
from app.motion.samples import Sample


def sample(i: int, sensor: str) -> Sample:
    return Sample(sensor, i, i, 0, (0.0, 0.1 * i, -9.8), (0.0, 0.0, 0.0))


steps = st.lists(
    st.sampled_from(["left", "right", "gap", "send", "send", "lose", "answer lost", "cut"]), max_size=120
)


@given(steps)
def test_through_any_cuts_each_sample_arrives_once_and_in_order(plan: list[str]) -> None:
    box, receiver = Outbox(1, 10**9), Intake()
    got: list[Sample] = []
    sent: dict[str, list[Sample]] = {"left": [], "right": []}
    count = {"left": 0, "right": 0}

    def deliver(parcel: Parcel, answered: bool) -> None:
        samples, answer = receiver.take(parcel.data, 0)
        got.extend(samples)
        assert isinstance(answer, Ack)
        if answered:
            box.acknowledge(answer)

    for step in plan:
        if step in sent:
            sent[step].append(sample(count[step], step))
            box.add(sent[step][-1])
            count[step] += 1
        elif step == "gap":
            count["left"] += 3
        elif step == "cut":
            box.rewind()
        elif (parcel := box.next()) is not None:
            if step == "lose":
                box.rewind()
            else:
                deliver(parcel, step == "send")
    box.rewind()
    while (parcel := box.next()) is not None:
        deliver(parcel, True)
    for sensor, expected in sent.items():
        assert [s for s in got if s.sensor == sensor] == expected
    assert box.waiting == 0
    assert box.delivered == len(got)
    assert box._bytes == 0


@given(st.integers(1, 400), st.integers(1000, 20_000))
def test_the_limit_holds_and_what_goes_is_counted(samples: int, limit: int) -> None:
    box = Outbox(1, limit)
    for i in range(samples):
        box.add(sample(i, "left"))
    kept = []
    while (parcel := box.next()) is not None:
        kept.append(parcel)
    kept = [parcel for parcel in kept if not parcel.done]  # one under way may be given up too
    assert sum(len(p.data) for p in kept) <= limit
    assert box.given_up + sum(p.end - p.first for p in kept) == samples == box.given_up + box.waiting
    assert all(a.end == b.first for a, b in pairwise(kept))


def test_a_refused_message_is_not_sent_again() -> None:
    box = Outbox(1, 10**6)
    box.add(sample(0, "left"))
    parcel = box.next()
    assert parcel is not None
    box.refuse(parcel)
    box.rewind()
    assert box.next() is None
    assert (box.given_up, box.waiting, box.delivered) == (1, 0, 0)


def test_a_temperature_goes_once_with_its_sensors_next_message() -> None:
    box, receiver = Outbox(1, 10**9), Intake()
    box.add(sample(0, "left"))
    box.warm({"left": 24.5, "right": 25.5})
    told = []
    for i in range(1, 4):
        while (parcel := box.next()) is not None:
            receiver.take(parcel.data, 0)
            told.append((parcel.sensor, len(parcel.data), dict(receiver.temperatures)))
        box.add(sample(i, "left" if i == 1 else "right"))
    small, large = min(size for _, size, _ in told), max(size for _, size, _ in told)
    assert large == small + 4
    assert told == [
        ("left", large, {"left": 24.5}),
        ("left", small, {"left": 24.5}),
        ("right", large, {"left": 24.5, "right": 25.5}),
    ]
