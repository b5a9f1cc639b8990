"""A walk into MCAP and back: to the bit, through any damage, and readable by others."""

from __future__ import annotations

import io
import math
import random
from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader

from app.formats import kept, mcap, plain
from app.formats.journal import Start
from app.formats.keeping import Keeper
from app.formats.reading import read
from app.motion.basics import InputError, Role
from app.motion.commands import Order, RestartHere, SetCandidate
from app.motion.samples import Sample
from app.settings import Settings
from tests.formats.walks import CLOCK_NS, keeper, random_samples, write

numbers = st.floats(width=64)
vectors = st.tuples(numbers, numbers, numbers)
finite = st.floats(-1.0, 1.0)
any_sample = st.builds(
    Sample,
    st.sampled_from(["left", "right", "tail/é"]),
    st.integers(0, 2**32 - 1),
    st.integers(-(2**63), 2**63 - 1),
    st.integers(0, 2**62),
    vectors,
    vectors,
    st.none() | vectors,
    st.integers(0, 511),
    st.none() | st.tuples(finite, finite, finite, finite),
)


def exact(samples: list[Sample]) -> list[str]:
    return [repr(sample) for sample in samples]  # NaN is not equal to itself, its name is


@settings(max_examples=60)
@given(st.lists(any_sample, max_size=12), st.integers(1, 5))
def test_every_sample_comes_back_to_the_bit(samples, chunk) -> None:
    assert exact(kept.samples(kept.kept("x", write(samples, chunk)))) == exact(samples)


@settings(max_examples=40)
@given(st.lists(st.tuples(st.sampled_from(["left", "right"]), st.floats(-50, 125)), max_size=8), st.data())
def test_every_temperature_comes_back_between_its_samples(told, data) -> None:
    samples, made = random_samples(20), keeper()
    written = made.begin(0)
    places = sorted(data.draw(st.integers(0, 20)) for _ in told)
    waiting = list(zip(places, told, strict=True))
    for i, sample in enumerate([*samples, None]):
        while waiting and waiting[0][0] == i:
            _, (sensor, celsius) = waiting.pop(0)
            made.temperature(sensor, 5_000_000 * i, celsius)
        if sample is not None:
            made.sample(sample)
        written += made.chunk() if i % 6 == 0 else b""
    written += made.end()
    recording = read("x", written)
    assert recording.journal is not None
    found = sorted(recording.journal.temperatures)
    assert found == sorted((place, *one) for place, one in zip(places, told, strict=True))
    assert exact(kept.samples(kept.kept("x", written))) == exact(samples)


def test_a_recording_has_the_samples_in_columns_and_their_order() -> None:
    samples = random_samples(100)
    recording = read("x.mcap", write(samples))
    assert [len(sensor) for sensor in recording.sensors] == [50, 50]
    assert [sensor.role for sensor in recording.sensors] == [Role.LEFT, Role.RIGHT]
    assert recording.journal is not None
    assert recording.journal.arrivals.tolist() == [0, 1] * 50
    left = recording.sensors[0]
    assert tuple(left.matrix[7, 1:4].tolist()) == samples[14].specific_force_b
    assert left.saturation[7] == samples[14].saturation
    assert left.device_ns + int(left.matrix[7, 0]) == samples[14].device_ns
    assert math.isnan(left.matrix[0, 7])


def test_samples_that_do_not_count_are_dropped_and_counted() -> None:
    samples = random_samples(40)
    samples[6] = samples[6]._replace(specific_force_b=(math.nan, 0.0, 0.0))
    samples[9] = samples[9]._replace(device_ns=samples[7].device_ns)
    recording = read("x.mcap", write(samples))
    assert recording.dropped_rows == 2
    assert recording.journal is not None
    assert len(recording.journal.arrivals) == 38


def test_orders_markers_and_settings_stand_where_they_were_given() -> None:
    made = keeper()
    data = made.begin(0)
    start = Start(Settings().with_changes({"gain_swing": 0.11}), Settings(), True)
    made.start(0, start)
    order = Order(SetCandidate((("gain_stance", 0.25), ("magnetometer", False))), "Ann", 12)
    for i, sample in enumerate(random_samples(30)):
        if i == 11:
            made.order(12, order)
        if i == 20:
            made.marker(7, "Ann", "stairs <b>begin</b>")
        made.sample(sample)
    journal = read("x.mcap", data + made.end()).journal
    assert journal is not None
    assert journal.orders == ((11, order),)
    assert Start(journal.settings, journal.candidate, journal.apply_at_once) == start
    assert [text for _, text in journal.markers] == ["stairs <b>begin</b>"]


def test_a_source_that_begins_anew_begins_a_new_walk() -> None:
    made = keeper()
    data = made.begin(0)
    changed = Settings().with_changes({"gain_swing": 0.11})
    samples = random_samples(30)
    made.start(0, Start(Settings(), Settings(), False))
    for sample in samples:
        made.sample(sample)
    made.order(31, Order(RestartHere(), kept.SOURCE, 0))
    made.start(0, Start(changed, changed, False))
    for sample in samples[:10]:
        made.sample(sample)
    recording = read("x.mcap", data + made.end())
    assert [len(sensor) for sensor in recording.sensors] == [5, 5]
    assert recording.journal is not None
    assert recording.journal.settings == changed
    assert recording.journal.orders == ()


def cuts(data: bytes) -> list[int]:
    """Every byte of a record's head and the one before it, and each 29th of what lies between."""
    found, at = set(range(0, len(data), 29)), len(mcap.MAGIC)
    while at < len(data) - len(mcap.MAGIC):
        found |= set(range(at - 1, at + 10))
        at += 9 + int.from_bytes(data[at + 1 : at + 9], "little")
    assert at == len(data) - len(mcap.MAGIC)
    return sorted(found | set(range(at, len(data))))


def test_wherever_it_is_cut_a_prefix_is_left() -> None:
    samples = random_samples(24)[::2]
    data = write(samples, chunk=3)
    lengths = set()
    for length in cuts(data):
        try:
            found = kept.samples(kept.kept("x", data[:length]))
        except InputError:
            continue
        assert found == samples[: len(found)]
        assert len(found) % 3 == 0
        lengths.add(len(found))
    assert lengths >= {3, 6, 9, 12}


def reader(data: bytearray) -> Callable[[int, int], bytes]:
    return lambda at, count: bytes(data[at : at + count])


def test_a_flipped_bit_is_an_error_of_one_line_or_costs_one_chunk() -> None:
    samples = random_samples(48)
    data = write(samples, chunk=6)
    chance = random.Random(3)
    for _ in range(300):
        damaged = bytearray(data)
        damaged[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
        try:
            whole = kept.kept("x", bytes(damaged))
        except InputError as error:
            assert "\n" not in str(error)
            continue
        found = kept.samples(whole)
        assert len(found) >= len(samples) - 6
        if whole.closed:  # it says so
            told = any("damaged in 1 place" in line for line in kept.recording_of("x", whole).assumed)
            assert told == (whole.damaged == 1)
            assert told or len(found) == len(samples) or mcap.index(len(damaged), reader(damaged)) is None
        assert [sample for sample in samples if sample in found] == found


def test_foxgloves_reader_sees_the_same_numbers() -> None:
    samples = random_samples(60)
    data = write(samples)
    found = list(make_reader(io.BytesIO(data), validate_crcs=True).iter_messages(log_time_order=False))
    imu = [(schema, channel, message) for schema, channel, message in found if channel.topic.endswith("/imu")]
    assert len(imu) == len(samples)
    assert {schema.name for schema, _, _ in imu if schema} == {"sensor_msgs/msg/Imu"}
    assert [message.sequence for _, _, message in imu] == [sample.seq for sample in samples]


def test_a_strangers_file_is_said_to_be_one() -> None:
    writer = mcap.Writer()
    data = writer.begin()
    writer.add(writer.channel("/a", "json", "a", "{}"), 0, 0, 0, b"{}")
    with pytest.raises(InputError, match="another program's"):
        read("x.mcap", data + writer.chunk() + writer.end())


@pytest.mark.parametrize("option", ["rate", "axes", "device"])
def test_what_a_recording_says_itself_cannot_be_told(option: str) -> None:
    from app.formats.options import parse_options

    told = parse_options({option: {"rate": "100", "axes": "x,y,z", "device": "gx1"}[option]})
    with pytest.raises(InputError, match=option):
        read("x.mcap", write(random_samples(10)), told)


def test_a_foot_that_was_named_in_mid_walk_has_its_name_from_the_start() -> None:
    made = Keeper({"version": "test", "sensors": {}}, {}, CLOCK_NS)
    data = made.begin(0)
    for i, sample in enumerate(random_samples(40)):
        made.sample(sample._replace(sensor={"left": "a", "right": "b"}[sample.sensor]))
        if i == 20:
            made.learnt(0, {"sensors": {"a": "right", "b": "left", "c": "nonsense", "d": 3}})
    recording = read("walk.mcap", data + made.end())
    assert {sensor.sensor: sensor.role for sensor in recording.sensors} == {"a": Role.RIGHT, "b": Role.LEFT}


def two_clocks(apart_ns: int) -> bytes:
    """Two feet, the right one's samples three seconds later than the left one's, each by its own clock."""
    made = keeper()
    data = made.begin(0)
    for i in range(600):
        ns = 10_000_000 * i
        for sensor, began_ns, off_ns in (("left", 0, 0), ("right", 3_000_000_000, apart_ns)):
            if ns >= began_ns:
                made.sample(Sample(sensor, i, ns + off_ns, ns + 7, (0.0, 0.0, -9.8), (0.0, 0.0, 0.0)))
    return data + made.end()


@pytest.mark.parametrize("apart_ns", [0, 10**15, -(10**12)])
def test_sensors_with_clocks_of_their_own_share_the_recordings_time(apart_ns: int) -> None:
    recording = read("walk.mcap", two_clocks(apart_ns))
    left, right = recording.sensors
    assert (recording.offset_ns(left), recording.offset_ns(right)) == (0, 3_000_000_000)
    assert recording.duration_s == pytest.approx(5.99)
    again = read("walk.csv", plain.encode(recording))
    assert [again.offset_ns(sensor) for sensor in again.sensors] == [0, 3_000_000_000]
    assert again.duration_s == pytest.approx(5.99)
