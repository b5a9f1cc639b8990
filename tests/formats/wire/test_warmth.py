"""A sensor's temperature: what is sent is what is told, beside the samples and never instead of one."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.formats.wire import gx1, lines, mip, ngimu, witmotion, ximu3, xsens
from app.formats.wire.catalogue import KINDS, Decoder
from app.formats.wire.columns import find_columns
from app.formats.wire.stream import Counters
from app.formats.wire.warmth import COLDEST_C, HOTTEST_C, believed, warming
from app.motion.samples import Sample
from tests.formats.wire.protocols import at_rest, converse, result

STILL = at_rest(2)
celsius = st.floats(COLDEST_C + 0.1, HOTTEST_C - 0.1)
AXES = "ax,ay,az,gx,gy,gz"


def told(decoder: Decoder, data: bytes) -> float | None:
    decoder.feed(data, 0)
    assert decoder.counters.bad_checksum == 0
    return decoder.temperature_c


def of_witmotion(degrees: float) -> float | None:
    encoder = witmotion.WitmotionEncoder()
    encoder.temperature_c = degrees
    return told(witmotion.WitmotionDecoder("foot"), b"".join(map(encoder.encode, STILL)))


def of_ximu3(binary: bool) -> Callable[[float], float | None]:
    encoder = ximu3.Ximu3Encoder(binary=binary)
    return lambda degrees: told(ximu3.Ximu3Decoder("foot"), encoder.temperature(STILL[0], degrees))


def of_ngimu(slip: bool) -> Callable[[float], float | None]:
    encoder = ngimu.NgimuEncoder(slip=slip)
    return lambda degrees: told(ngimu.NgimuDecoder("foot", slip=slip), encoder.encode(STILL[0], degrees))


def of_mip(degrees: float) -> float | None:
    encoder = mip.MipEncoder()
    encoder.temperature_c = degrees
    return told(mip.MipDecoder("foot"), encoder.message(STILL[0], [mip.TEMPERATURE]))


def of_xsens(degrees: float) -> float | None:
    encoder = xsens.XsensEncoder()
    encoder.temperature_c = degrees
    return told(xsens.XsensDecoder("foot"), encoder.mtdata2(STILL[0], [xsens.TEMPERATURE], 0))


def of_gx1(gyro_gain: int) -> Callable[[float], float | None]:
    setup = gx1.Gx1Setup(gyro_gain=gyro_gain)
    encoder = gx1.Gx1Encoder(setup=setup)

    def tell(degrees: float) -> float | None:
        reply = gx1.framed(gx1.TEMPERATURE, encoder.temperature(degrees), 7)
        return told(gx1.Gx1Decoder("foot", setup=setup), reply)

    return tell


def of_lines(style: str) -> Callable[[float], float | None]:
    def tell(degrees: float) -> float | None:
        encoder = lines.LinesEncoder(style=style, with_temperature=True)
        encoder.temperature_c = degrees
        return told(lines.LinesDecoder("foot"), b"".join(map(encoder.encode, STILL)))

    return tell


WIRES = {
    "witmotion": (of_witmotion, 0.005),
    "ximu3-binary": (of_ximu3(True), 1e-5),
    "ximu3-ascii": (of_ximu3(False), 5e-5),
    "ngimu-slip": (of_ngimu(True), 1e-5),
    "ngimu-udp": (of_ngimu(False), 1e-5),
    "mip": (of_mip, 1e-5),
    "xsens": (of_xsens, 1e-5),
    "gx1": (of_gx1(10000), 0.5 * 500 / 65536),
    "lines-csv": (of_lines("csv"), 5e-7),
    "lines-json": (of_lines("json"), 5e-7),
}


@pytest.mark.parametrize("name", WIRES)
@settings(max_examples=25)
@given(degrees=celsius)
def test_what_is_sent_is_what_is_told(name: str, degrees: float) -> None:
    send, rounding = WIRES[name]
    assert send(degrees) == pytest.approx(degrees, abs=1.01 * rounding)


@given(degrees=st.floats(0.0, HOTTEST_C - 0.1))
def test_the_ancestor_has_its_own_scale(degrees: float) -> None:
    assert of_gx1(64)(degrees) == pytest.approx(degrees, abs=0.0611)


@pytest.mark.parametrize("name", [name for name in WIRES if not name.startswith(("witmotion", "gx1"))])
@pytest.mark.parametrize("degrees", [-300.0, 2000.0])
def test_what_no_sensor_can_have_is_not_told(name: str, degrees: float) -> None:
    assert WIRES[name][0](degrees) is None


@given(st.floats())
def test_any_number_is_believed_or_the_one_before_stays(number: float) -> None:
    kept = believed(number, 20.0)
    assert kept in (number, 20.0)
    assert kept is not None
    assert COLDEST_C <= kept <= HOTTEST_C
    assert believed(math.nan) is None


@pytest.mark.parametrize(
    ("decoder", "wire", "degrees"),
    [
        # (9830 × 5 / 65536 − 0.5) × 100, T = 1003, the word sum
        (gx1.Gx1Decoder("foot"), "07 2666 03EB 2A58", 24.9969),
        # min 24, max 26, mean 25.5
        (mip.MipDecoder("foot"), "7565 80 0E 0E14 41C00000 41D00000 41CC0000 A9F5", 25.5),
        (xsens.XsensDecoder("foot"), "FA FF 36 07 081004 41CC0000 9B", 25.5),
        # 16.32: 32 bits of the fraction first
        (xsens.XsensDecoder("foot"), "FA FF 36 09 081206 80000000 0019 09", 25.5),
        # T, 0 µs, 25.5 °C, little-endian, as its manual's layout says
        (ximu3.Ximu3Decoder("foot"), "D4 0000000000000000 0000CC41 0A", 25.5),
        (ximu3.Ximu3Decoder("foot"), b"T,1000000,25.5000\r\n".hex(), 25.5),
    ],
)
def test_the_printed_bytes(decoder: Decoder, wire: str, degrees: float) -> None:
    assert told(decoder, bytes.fromhex(wire)) == pytest.approx(degrees, abs=1e-4)
    assert decoder.counters.bytes_skipped == 0


def test_ngimu_tells_its_sensors_not_its_processors() -> None:
    for numbers, degrees in (((40.0, 30.0), 30.0), ((40.0, 30.0, 20.0), 30.0), ((25.0,), 25.0)):
        packet = ngimu.bundle(1, ngimu.message(ngimu.TEMPERATURE, numbers))
        decoder = ngimu.NgimuDecoder("foot")
        assert told(decoder, packet) == degrees
        assert decoder.counters.unknown == 0


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("temp", True),
        ("Temperature", True),
        ("temp_c", True),
        ("tempC", True),
        ("imu_degC", True),
        ("IMU temp (°C)", True),
        ("temperature [C]", True),
        ("temp (°F)", False),
        ("tempF", False),
        ("t", False),
        ("tempo", False),
    ],
)
def test_a_column_is_a_temperature_by_its_name(name: str, found: bool) -> None:
    columns = find_columns(f"{AXES},{name}".split(","))
    assert columns is not None
    assert (columns.temperature is not None) is found
    assert "temperature" not in columns.units


def test_a_cell_that_is_no_number_costs_its_temperature_only() -> None:
    decoder = lines.LinesDecoder("foot")
    header = b"t_us,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps,temp\n"
    got = decoder.feed(header + b"0,0,0,1,0,0,0,21.5\n10000,0,0,1,0,0,0,hot\n", 0)
    assert len(got) == 2
    assert decoder.temperature_c is None


def streamed(device: str, seconds: float, step_ns: int = 10_000_000) -> tuple[Decoder, list[Sample]]:
    """A modelled sensor started and read for a while, asked its question twice a second."""
    kind = KINDS[device]
    model, setup = kind.model(kind.axes), None
    if kind.start_up is not None:
        setup = result(converse(kind.start_up(100.0), model, at_rest(1000)))
    decoder = kind.decoder("foot", kind.axes, setup)
    samples = []
    for i, sample in enumerate(at_rest(round(seconds * 1e9 / step_ns), step_ns=step_ns)):
        asked = model.receive(kind.question) if kind.question and i % 50 == 0 else b""
        ns = 20 * 10**9 + sample.device_ns  # later than what the start-up saw
        samples += decoder.feed(asked + model.measure(sample._replace(device_ns=ns)), ns)
    return decoder, samples


@pytest.mark.parametrize("device", KINDS)
def test_every_model_warms_up_and_its_decoder_says_so(device: str) -> None:
    decoder, samples = streamed(device, 4.0)
    assert len(samples) > (150 if device == "gx1" else 350)
    counters: Counters = decoder.counters
    assert counters.unknown == counters.dropped == counters.bytes_skipped == 0
    assert decoder.temperature_c is not None
    now_c = warming(24 * 10**9)
    assert abs(decoder.temperature_c - now_c) < now_c - warming(22 * 10**9) + 0.02
    assert struct.pack("<d", decoder.temperature_c) != struct.pack("<d", 25.0)


@pytest.mark.parametrize("device", ["mip", "xsens"])
def test_a_sensor_without_a_thermometer_is_started_all_the_same(device: str) -> None:
    """The host asks again without it."""
    kind = KINDS[device]
    model = kind.model(kind.axes)
    receive, refused = model.receive, []

    def stubborn(data: bytes) -> bytes:
        if (b"\x14" in data[6:] and device == "mip" and data[2] == 0x0C) or b"\x08\x10" in data:
            refused.append(data)
            return (
                mip.packet(0x0C, (0xF1, bytes([0x0F, 3]))) if device == "mip" else xsens.message(0x42, b"!")
            )
        return receive(data)

    model.receive = stubborn  # type: ignore[method-assign]
    setup = result(converse(kind.start_up(100.0), model))  # type: ignore[misc]
    assert refused
    decoder = kind.decoder("foot", kind.axes, setup)
    got = [s for sample in at_rest(300) for s in decoder.feed(model.measure(sample), sample.device_ns)]
    assert len(got) == 300
    assert all(sample.device_q_nb is not None for sample in got)
    assert decoder.temperature_c is None
