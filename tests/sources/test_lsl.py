"""Real streams of the Lab Streaming Layer on this machine: out, in, and with what meta-data."""

from __future__ import annotations

import asyncio
import uuid
from itertools import pairwise

import numpy as np
import pytest

from app.motion.basics import InputError
from app.outputs.lsl import LslSender
from app.sources import lsl
from app.sources.lsl import LslSource
from app.sources.opening import open_source
from app.sources.spec import parse_spec
from tests.sources.links import STEP_NS, Reader, walk


@pytest.fixture
def pylsl():
    try:
        return lsl.library()
    except InputError as error:
        pytest.skip(str(error))


@pytest.fixture
def name() -> str:
    """No other test's streams on this network."""
    return f"t{uuid.uuid4().hex[:8]}"


def test_two_feet_go_out_and_come_in(pylsl, name: str) -> None:
    async def main() -> None:
        sender = LslSender(pylsl, name, 100.0)
        source = LslSource(parse_spec(f"lsl:{name}"))
        reader = Reader(source)
        i = 0
        while min(len(reader.of("left")), len(reader.of("right"))) < 100:
            for sensor in ("left", "right"):
                sender.send(walk(1, sensor, i)[0])
            await asyncio.sleep(STEP_NS * 1e-9)
            i += 1
            assert i < 20_000, "the streams were never found"
        for sensor in ("left", "right"):
            got = reader.of(sensor)
            first = round(got[0].specific_force_b[0] / 0.001)
            sent = walk(len(got), sensor, first)
            assert [s.specific_force_b for s in got] == [s.specific_force_b for s in sent]
            assert [s.field_b for s in got] == [s.field_b for s in sent]
            assert all(a.device_ns < b.device_ns for a, b in pairwise(got))
        assert sum(source.info.line.values()) == 0
        reader.stop()

    asyncio.run(main())


def test_the_meta_data_are_those_that_others_read(pylsl, name: str) -> None:
    sender = LslSender(pylsl, name, 100.0)
    sender.send(walk(1)[0])
    found = pylsl.resolve_byprop("name", f"{name}_left", timeout=60)
    assert len(found) == 1
    inlet = pylsl.StreamInlet(found[0])
    info = inlet.info(timeout=60)
    assert (info.type(), info.channel_count(), info.nominal_srate()) == ("IMU", 9, 100.0)
    assert info.get_channel_labels() == [f"{q}_{axis}" for q in ("acc", "gyr", "mag") for axis in "xyz"]
    assert info.get_channel_units() == ["m/s^2"] * 3 + ["rad/s"] * 3 + ["uT"] * 3
    assert info.get_channel_types() == ["ACC"] * 3 + ["GYRO"] * 3 + ["MAGN"] * 3
    assert info.desc().child_value("foot") == "left"
    inlet.close_stream()


def test_stamps_follow_the_sensors_clock_and_not_the_bursts(pylsl, name: str, monkeypatch) -> None:
    now = [0]
    monkeypatch.setattr("app.outputs.lsl.time.monotonic_ns", lambda: now[0])
    sender = LslSender(pylsl, name, 0.0)
    stamps = []
    for burst in range(20):
        now[0] += 8 * STEP_NS
        for sample in walk(8, "left", 8 * burst):
            sender.send(sample)
            stamps.append(sender._stamps["left"])
    steps = np.diff(stamps[80:])
    np.testing.assert_allclose(steps, STEP_NS * 1e-9, atol=1e-4)


def test_what_is_missing_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pylsl", None)
    with pytest.raises(InputError, match=r"pip install -e '\.\[lsl\]'"):
        open_source("lsl:")


def test_a_stream_that_goes_while_it_is_opened_is_tried_again(
    pylsl, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened, tries = pylsl.StreamInlet.open_stream, []

    def sometimes(inlet: object, timeout: float) -> None:
        tries.append(timeout)
        if len(tries) == 1:
            raise TimeoutError("the operation failed due to a timeout.")
        opened(inlet, timeout)

    monkeypatch.setattr(pylsl.StreamInlet, "open_stream", sometimes)

    async def main() -> None:
        sender, source = LslSender(pylsl, name, 100.0), LslSource(parse_spec(f"lsl:{name}"))
        reader = Reader(source)
        for i in range(20_000):
            if reader.of("left"):
                break
            sender.send(walk(1, "left", i)[0])
            await asyncio.sleep(STEP_NS * 1e-9)
        assert reader.of("left")
        reader.stop()

    asyncio.run(main())
    assert len(tries) > 1
