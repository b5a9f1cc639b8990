from __future__ import annotations

import math

import numpy as np
import pytest

from app.formats.wire.lines import LinesDecoder, LinesEncoder
from app.motion.basics import G_MPS2, InputError
from app.motion.samples import Sample

HEADER = b"t_ms,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps,mx_ut,my_ut,mz_ut\n"
ROW = "{t},0,0,1,0,0,90,20,0,-40\n"


def rows(count: int, step: int = 10, start: int = 0, form: str = ROW) -> bytes:
    return b"".join(form.format(t=start + i * step).encode() for i in range(count))


def rests_with_a_turn(sample: Sample) -> bool:
    force, rate = sample.specific_force_b, sample.angular_rate_b
    return bool(np.allclose(force, (0, 0, -G_MPS2), rtol=1e-6) and np.allclose(rate, (0, 0, -math.pi / 2)))


def test_a_header_says_columns_and_units() -> None:
    decoder = LinesDecoder("foot")
    got = decoder.feed(HEADER + rows(3), 0)
    assert [sample.device_ns for sample in got] == [0, 10_000_000, 20_000_000]
    assert all(map(rests_with_a_turn, got))
    assert got[0].field_b == (20.0, 0.0, 40.0)
    assert decoder.notes == []


@pytest.mark.parametrize(
    "text",
    [
        HEADER.replace(b",", b"\t") + rows(2).replace(b",", b"\t"),
        HEADER.replace(b",", b";") + rows(2).replace(b",", b";"),
        HEADER.replace(b",", b" ") + rows(2).replace(b",", b"  "),
        HEADER.replace(b"\n", b",\r\n") + rows(2).replace(b"\n", b",\r\n"),
        b"booting...\n\n# a comment\n" + HEADER + rows(2),
        HEADER + rows(2, form="IMU," + ROW),
        b"#moves,v1,foot=L,acc=g,gyr=dps,mag=uT,t=ms\n" + rows(2, form="7," + ROW),
        rows(3, form="t_ms:{t},ax_g:0,ay_g:0,az_g:1,gx_dps:0,gy_dps:0,gz_dps:90\n"),
        rows(2, form='{{"t_ms":{t},"az_g":1,"ax_g":0,"ay_g":0,"gx_dps":0,"gy_dps":0.0,"gz_dps":9e1}}\n'),
    ],
    ids=["tabs", "semicolons", "spaces", "trailing comma", "boot text", "prefix", "native", "pairs", "json"],
)
def test_every_manner_of_writing(text: bytes) -> None:
    decoder = LinesDecoder("foot")
    got = [s for i, line in enumerate(text.splitlines(keepends=True)) for s in decoder.feed(line, i)]
    # the first of a board's lines that name each value is not believed: a header would say where one begins
    assert len(got) == 2
    assert all(map(rests_with_a_turn, got))


def test_nmea_checksums_are_checked() -> None:
    body = "IMU,5,0,0,1,0,0,90,20,0,-40"
    total = 0
    for byte in body.encode():
        total ^= byte
    decoder = LinesDecoder("foot")
    good, bad = f"${body}*{total:02X}\r\n", f"${body}*{total ^ 1:02x}\r\n"
    assert len(decoder.feed(HEADER + good.encode() + bad.encode(), 0)) == 1
    assert decoder.counters.bad_checksum == 1


def test_the_rest_of_a_line_is_not_taken_for_a_row() -> None:
    decoder = LinesDecoder("foot", columns="t_ms,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps,mx_ut,my_ut,mz_ut")
    whole = rows(3, start=1000)
    assert [s.device_ns for s in decoder.feed(whole[2:], 0)] == [1_010_000_000, 1_020_000_000]
    assert decoder.counters.dropped == 1


@pytest.mark.parametrize(("unit", "one_g"), [("g", 1.0), ("m/s2", G_MPS2), ("mg", 1000.0)])
@pytest.mark.parametrize(("time", "step"), [("s", 0.01), ("ms", 10), ("us", 10_000), ("ns", 10_000_000)])
def test_undeclared_units_are_told_by_the_numbers_and_no_row_is_lost(
    unit: str, one_g: float, time: str, step
) -> None:
    decoder = LinesDecoder("foot", units={"rate": "rad/s"})
    got = decoder.feed(b"t,ax,ay,az,gx,gy,gz\n", 0)
    for i in range(120):
        got += decoder.feed(f"{i * step:.12g},0,0,{one_g},0,0,1\n".encode(), i * 10_000_000)
    assert len(got) == 120
    np.testing.assert_allclose([sample.specific_force_b[2] for sample in got], -G_MPS2)
    np.testing.assert_allclose(np.diff([sample.device_ns for sample in got]), 10_000_000, atol=1)
    assert any(unit in note for note in decoder.notes)
    assert f"time in {time}: told by its steps" in decoder.notes


def test_a_rate_without_a_unit_is_assumed_in_degrees_and_that_is_said() -> None:
    decoder = LinesDecoder("foot")
    decoder.feed(b"t_us,ax_g,ay_g,az_g,gx,gy,gz\n", 0)
    (sample,) = decoder.feed(b"5,0,0,1,180,0,0\n", 0)
    assert sample.angular_rate_b[0] == pytest.approx(math.pi)
    assert any("deg/s" in note for note in decoder.notes)


def test_a_force_that_fits_no_unit_gives_no_sample_but_advice() -> None:
    decoder = LinesDecoder("foot")
    decoder.feed(b"t_us,ax,ay,az,gx,gy,gz\n", 0)
    for i in range(200):
        assert decoder.feed(f"{i}000,0,0,16384,0,0,1\n".encode(), 0) == []
    assert decoder.counters.dropped == 200
    assert any("hold the sensor still" in note for note in decoder.notes)


def test_without_a_header_it_says_what_to_do() -> None:
    decoder = LinesDecoder("foot")
    assert decoder.feed(rows(5), 0) == []
    assert any("no header seen" in note for note in decoder.notes)


def test_without_a_time_column_arrivals_stamp() -> None:
    decoder = LinesDecoder("foot", rate_hz=100.0)
    decoder.feed(b"ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps\n", 0)
    got = [s.device_ns for i in range(5) for s in decoder.feed(b"0,0,1,0,0,0\n", i * 10_000_000)]
    assert got == [i * 10_000_000 for i in range(5)]


def test_microseconds_wrap_after_71_minutes() -> None:
    decoder = LinesDecoder("foot")
    decoder.feed(b"micros,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps\n", 0)
    stamps = []
    for i in range(20):
        line = f"{(2**32 - 50_000 + i * 10_000) % 2**32},0,0,1,0,0,0\n"
        stamps += [s.device_ns for s in decoder.feed(line.encode(), i * 10_000_000)]
    assert set(np.diff(stamps)) == {10_000_000}
    assert len(stamps) == 20


def test_an_artemis_log_line() -> None:
    decoder = LinesDecoder("foot")
    decoder.feed(b"rtcDate,rtcTime,aX,aY,aZ,gX,gY,gZ,mX,mY,mZ,imu_degC,output_Hz,\r\n", 0)
    line = "01/02/2026,12:00:0{s}.50,0.0,0.0,1000.0,0.0,0.0,90.0,20.0,0.0,-40.0,25.0,10.0,\r\n"
    got = decoder.feed("".join(line.format(s=s) for s in range(3)).encode(), 0)
    assert all(map(rests_with_a_turn, got))
    assert [s.device_ns for s in got] == [(43_200_500 + i * 1000) * 1_000_000 for i in range(3)]


@pytest.mark.parametrize("cell", ["", "x", "nan", "inf", "1_0", "٣"])
def test_a_cell_that_is_no_number_costs_its_row(cell: str) -> None:
    decoder = LinesDecoder("foot")
    data = HEADER + f"1,{cell},0,1,0,0,90,20,0,-40\n".encode() + rows(1, start=10)
    assert len(decoder.feed(data, 0)) == 1
    assert decoder.counters.dropped + decoder.counters.bad_checksum == 1


@pytest.mark.parametrize("style", ["csv", "json"])
@pytest.mark.parametrize("share", [0.0, 0.2])
def test_damaged_lines_are_damage_and_what_else_a_board_says_is_none(style: str, share: float) -> None:
    """A byte in a fifth of the rows becomes another, anywhere; beside them the board says how it fares."""
    encoder, decoder = LinesEncoder(style=style), LinesDecoder("foot")
    random = np.random.default_rng(5)
    said = b'battery 3.9 V\n{"wifi":"connected","rssi":-60}\nGPS,1,2,3,4,5,6,7,8\n'
    fed = hit = 0
    for i in range(1000):
        turn = tuple(np.sin(0.01 * i * np.arange(1, 4)))
        sample = Sample("foot", i, i * 10_000_000, 0, (0.0, 0.0, -G_MPS2), turn, (20.0, 0.0, 40.0))
        line = bytearray(encoder.encode(sample))
        if i > 100 and random.random() < share:
            line[random.integers(len(line) - 2)] = random.integers(32, 127)
            hit += len(line)
        line += said if i % 10 == 0 else b""
        decoder.feed(bytes(line), i * 10_000_000)
        fed += len(line)
    counters = decoder.counters
    assert counters.bytes_fed == fed == counters.bytes_good + counters.bytes_skipped
    # of the bytes hit most were digits, and a digit that became another one cannot be told
    assert 0.6 * hit <= counters.bytes_skipped <= hit
    assert (counters.bad_checksum > 50) == bool(share)


def test_empty_field_cells_are_no_field() -> None:
    (sample,) = LinesDecoder("foot").feed(HEADER + b"1,0,0,1,0,0,90,,,\n", 0)
    assert sample.field_b is None


def test_the_sequence_column_counts_the_lost() -> None:
    decoder = LinesDecoder("foot")
    decoder.feed(b"seq," + HEADER, 0)
    for i, seq in enumerate((1, 2, 5, 6, 1, 2)):
        decoder.feed(f"{seq},".encode() + rows(1, start=10 * i), 0)
    assert decoder.counters.lost == 2


@pytest.mark.parametrize("units", [{"force": "stone"}, {"mood": "g"}, {"rate": "g"}])
def test_unknown_units_are_refused(units: dict[str, str]) -> None:
    with pytest.raises(InputError, match="expected units of force, rate, field or time"):
        LinesDecoder("foot", units=units)


def test_columns_without_a_sensor_are_refused() -> None:
    with pytest.raises(InputError, match="expected names with ax,ay,az"):
        LinesDecoder("foot", columns="t,ax,ay")


def test_many_layouts_are_not_remembered_for_ever() -> None:
    decoder = LinesDecoder("foot")
    for i in range(500):
        decoder.feed(f'{{"a{i}":1}}\n'.encode(), 0)
    assert len(decoder._named) <= 16


@pytest.mark.parametrize("damaged", [0, 7])
@pytest.mark.parametrize(
    ("key", "made"),
    [("t_ms", "t_s"), ("t_ms", "x_ms"), ("ax_g", "ax_mg"), ("gx_dps", "gx_rads"), ("t_ms", "t")],
)
def test_a_damaged_name_changes_no_clock_and_no_unit(damaged: int, key: str, made: str) -> None:
    form = '{{"t_ms":{t},"ax_g":0,"ay_g":0,"az_g":1,"gx_dps":0,"gy_dps":0,"gz_dps":90}}\n'
    decoder = LinesDecoder("foot")
    got = []
    for i in range(40):
        line = form.format(t=10 * i).replace(f'"{key}"', f'"{made if i == damaged else key}"')
        got += decoder.feed(line.encode(), 70_000_000_000_000 + 10_000_000 * i)
    assert all(map(rests_with_a_turn, got))
    assert [sample.device_ns for sample in got] == [10_000_000 * i for i in range(40) if i != damaged]
    assert decoder.counters.bad_checksum == 1


def test_rows_may_leave_out_a_field_and_a_board_may_print_otherwise_from_now_on() -> None:
    named = [
        '{{"t_ms":{t},"ax_g":0,"ay_g":0,"az_g":1,"gx_dps":0,"gy_dps":0,"gz_dps":90}}\n',
        '{{"t_ms":{t},"ax_g":0,"ay_g":0,"az_g":1,"gx_dps":0,"gy_dps":0,"gz_dps":90,"mx":1,"my":2,"mz":3}}\n',
        '{{"t_ms":{t},"ax_mg":0,"ay_mg":0,"az_mg":1000,"gx_dps":0,"gy_dps":0,"gz_dps":90}}\n',
    ]
    decoder = LinesDecoder("foot")
    forms = [named[i % 5 == 4] if i < 40 else named[2] for i in range(60)]
    got = [s for i, form in enumerate(forms) for s in decoder.feed(form.format(t=10 * i).encode(), i)]
    assert all(map(rests_with_a_turn, got))
    assert [sample.field_b is not None for sample in got[:40]] == [i % 5 == 4 for i in range(40)]
    assert [sample.device_ns // 10_000_000 for sample in got[40:]] == list(range(43, 60))
