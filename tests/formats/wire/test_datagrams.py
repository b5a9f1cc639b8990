"""Datagrams of many senders on one port: each told by its form, each its own sensor."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.mounting import AS_GIVEN
from app.formats.options import Options
from app.formats.wire import datagrams, identify, lines, ngimu, ximu3, ximu3_talk
from app.formats.wire.catalogue import Model
from app.formats.wire.datagrams import Datagrams
from app.formats.wire.message import encode_binary, encode_json
from app.motion.samples import Sample

STEP_NS = 10_000_000


def walk(count: int, sensor: str = "foot") -> list[Sample]:
    return [
        Sample(sensor, i, i * STEP_NS, i * STEP_NS, (0.1 * i, 1.0, -9.8), (0.0, 0.1, 0.01 * i))
        for i in range(count)
    ]


ENCODERS = {
    "ngimu": lambda: ngimu.NgimuEncoder(slip=False),
    "ximu3": lambda: ximu3.Ximu3Encoder(),
    "csv": lambda: lines.LinesEncoder(with_field=False),
}


def fed(box: Datagrams, encoder: object, sender: tuple[str, int], samples: list[Sample]) -> list[Sample]:
    return [s for sent in samples for s in box.feed(encoder.encode(sent), sender, sent.host_ns)]  # type: ignore[attr-defined]


@pytest.mark.parametrize("device", ENCODERS)
def test_a_sensor_is_told_by_its_datagrams(device: str) -> None:
    box = Datagrams()
    got = fed(box, ENCODERS[device](), ("10.0.0.7", 8000), walk(100))
    assert len(got) >= 90
    np.testing.assert_allclose(got[-1].specific_force_b, walk(100)[-1].specific_force_b, atol=1e-4)
    assert {s.sensor for s in got} == {"foot"}
    assert any("10.0.0.7" in note for note in box.notes)


@pytest.mark.parametrize("device", ENCODERS)
def test_a_device_that_was_named_needs_no_listening(device: str) -> None:
    box = Datagrams(Options(device=device, foot="left"))
    got = fed(box, ENCODERS[device](), ("10.0.0.7", 8000), walk(100))
    assert len(got) == 100
    assert got[0].sensor == "left"


def test_two_sensors_and_a_board_on_one_port() -> None:
    box = Datagrams(names={"10.0.0.7": "left", "10.0.0.8:9": "right"})
    left, right = ngimu.NgimuEncoder(slip=False), ximu3.Ximu3Encoder()
    got = []
    for a in walk(60):
        got += box.feed(left.encode(a), ("10.0.0.7", 5), a.host_ns)
        got += box.feed(right.encode(a), ("10.0.0.8", 9), a.host_ns)
        got += box.feed(encode_json(1, [a._replace(sensor="chest")]).encode(), ("10.0.0.9", 5), a.host_ns)
    counts = {name: sum(s.sensor == name for s in got) for name in ("left", "right", "chest")}
    assert counts["chest"] == 60
    assert min(counts.values()) >= 55


@pytest.mark.parametrize("rubbish", [b"", b"booting\n", b"{", bytes(1000)])
def test_rubbish_first_makes_no_stranger_of_a_board(rubbish: bytes) -> None:
    """A board may print while it starts, or a message be cut."""
    box = Datagrams()
    assert not box.feed(rubbish, ("10.0.0.9", 9), 0)
    sent = walk(5, "left")
    assert box.feed(encode_binary(1, sent, doubles=True), ("10.0.0.9", 9), sent[-1].host_ns) == [
        sample._replace(host_ns=sent[-1].host_ns) for sample in sent
    ]


def test_a_stranger_costs_little(monkeypatch: pytest.MonkeyPatch) -> None:
    """All sensors wait while one is looked at."""
    looked: list[int] = []
    monkeypatch.setattr(identify, "identify", lambda data: looked.append(len(data)))
    box = Datagrams()
    for number in range(1000):
        box.feed(bytes(1000), ("10.0.0.9", 9), number * 1_000_000)
    assert sum(looked) < 150_000  # a million came


def test_temperatures_are_told_by_sensor_whichever_way_they_come() -> None:
    box = Datagrams(names={"10.0.0.7": "left", "10.0.0.8": "right"})
    devices: dict[str, Model] = {"10.0.0.7": ngimu.NgimuDevice(), "10.0.0.8": ximu3_talk.Ximu3Device()}
    for a in walk(300):
        for host, device in devices.items():
            if data := device.measure(a):
                box.feed(data, (host, 5), a.host_ns)
    message = encode_binary(1, [walk(1)[0]._replace(sensor="chest")], temperature_c=36.5)
    box.feed(message, ("10.0.0.9", 5), 0)
    told = box.temperatures()
    assert set(told) == {"left", "right", "chest"}
    assert told["chest"] == 36.5
    assert 24.0 <= told["left"] < 24.1
    assert 24.0 <= told["right"] < 24.1


def test_a_board_that_comes_back_from_another_port_is_the_same() -> None:
    box = Datagrams(Options(device="ngimu"))
    encoder = ngimu.NgimuEncoder(slip=False)
    fed(box, encoder, ("10.0.0.7", 5), walk(10))
    later = [s._replace(host_ns=s.host_ns + 10**10, device_ns=s.device_ns + 10**10) for s in walk(10)]
    assert {s.sensor for s in fed(box, encoder, ("10.0.0.7", 6), later)} == {"foot"}
    assert {s.sensor for s in fed(box, encoder, ("10.0.0.8", 6), later)} == {"foot-2"}


def test_axes_and_rate_reach_every_kind_of_sender() -> None:
    box = Datagrams(Options(device="ngimu", axes=AS_GIVEN, rate_hz=50.0))
    got = fed(box, ngimu.NgimuEncoder(AS_GIVEN, slip=False), ("10.0.0.7", 5), walk(3))
    got += box.feed(encode_binary(1, walk(3, "right"), doubles=True), ("10.0.0.8", 5), 0)
    assert [s.device_ns for s in got] == 2 * [0, 20_000_000, 40_000_000]
    np.testing.assert_allclose(got[0].specific_force_b, walk(1)[0].specific_force_b, atol=1e-4)


def test_losses_are_told_in_words() -> None:
    box = Datagrams()
    sent = [encode_binary(1, [s]) for s in walk(10)]
    for data in (sent[0], sent[3], sent[3], sent[4][:-1]):
        box.feed(data, ("10.0.0.7", 5), 0)
    told = {reason: count for reason, count in box.lost().items() if count}
    assert told == {"lost on the way": 2, "came twice or too late": 1, "damaged messages": 1}


@given(st.lists(st.tuples(st.integers(0, 3), st.binary(max_size=300)), max_size=30))
def test_any_datagrams_give_no_sample_and_no_error(sent: list[tuple[int, bytes]]) -> None:
    box = Datagrams()
    for i, (sender, data) in enumerate(sent):
        assert box.feed(data, (f"10.0.0.{sender}", 5), i) == []


def test_strangers_without_end_are_not_remembered() -> None:
    box = Datagrams()
    rubbish = np.random.default_rng(1).integers(0, 256, (300, 40), np.uint8)
    for i, row in enumerate(rubbish):
        box.feed(row.tobytes(), (f"10.0.{i}.1", 5), 0)
    assert len(box._senders) == datagrams.MOST_SENDERS
    assert box.ignored == 300 - datagrams.MOST_SENDERS
    late = 10**10
    got = [
        s
        for sent in walk(50)
        for s in box.feed(ngimu.NgimuEncoder(slip=False).encode(sent), ("10.9.9.9", 5), late + sent.host_ns)
    ]
    assert len(got) >= 45, "those that never were known make room"
