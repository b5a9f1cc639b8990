from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.catalogue import KINDS
from app.formats.wire.gx1_talk import Gx1Device
from app.formats.wire.identify import Found, Identifier, identify, probe
from app.formats.wire.mip_talk import MipDevice
from app.formats.wire.xsens_talk import XsensDevice
from tests.formats.wire.protocols import WIRES, Wire, at_rest, converse, packets, result, walk

every_stream = pytest.mark.parametrize(
    "wire", [wire for wire in WIRES if not wire.datagrams], ids=lambda wire: wire.name
)


@every_stream
@pytest.mark.parametrize("cut", [0, 1, 7, 23, 101])
def test_every_stream_is_known_behind_rubbish_and_cut_anywhere(wire: Wire, cut: int) -> None:
    rubbish = np.random.default_rng(cut).integers(0, 256, 40, np.uint8).tobytes()
    stream = b"".join(packets(wire, walk(wire, 30)))
    for data in (stream, stream[cut : -cut or None], rubbish + stream):
        found = identify(data)
        assert found is not None
        assert found.device == wire.device
        assert str(len(data)) in found.evidence


@every_stream
def test_a_little_is_enough_and_less_is_not_guessed(wire: Wire) -> None:
    sent = packets(wire, walk(wire, 8))
    assert identify(b"".join(sent)) is not None
    assert identify(sent[3][: len(sent[3]) // 4]) is None


def test_noise_is_nothing() -> None:
    rng = np.random.default_rng(1)
    for _ in range(6):
        assert identify(rng.integers(0, 256, 4000, np.uint8).tobytes()) is None
        assert identify(rng.integers(32, 127, 1000, np.uint8).tobytes()) is None


@given(st.binary(max_size=600))
def test_any_bytes_raise_nothing(data: bytes) -> None:
    assert identify(data) is None


@pytest.mark.parametrize("data", [b"", bytes(1000), b"\xff" * 1000, b"login: \r\n" * 50, b"\x55" * 500])
def test_lines_that_rest_or_chatter_are_nothing(data: bytes) -> None:
    assert identify(data) is None


def test_listening_ends_when_it_is_certain() -> None:
    wire = WIRES[0]
    ear = Identifier()
    heard = [ear.feed(packet) for packet in packets(wire, walk(wire, 4))]
    assert heard[:2] == [None, None]
    assert heard[2] == Found("gx1", "3 3DM-GX1 messages with sound checksums in 93 bytes")


def test_what_was_heard_is_not_lost_to_the_decoder() -> None:
    wire = next(wire for wire in WIRES if wire.name == "lines-csv")
    ear, sent = Identifier(), packets(wire, walk(wire, 20))
    heard = next(i for i, packet in enumerate(sent) if ear.feed(packet) is not None)
    assert len(wire.decoded(ear.heard + b"".join(sent[heard + 1 :]))) == 20


@pytest.mark.parametrize("name", ["ngimu-udp", "ximu3-binary", "ximu3-ascii", "lines-json"])
def test_datagrams_are_known_too(name: str) -> None:
    wire = next(wire for wire in WIRES if wire.name == name)
    ear = Identifier(datagrams=True)
    heard = [found for packet in packets(wire, walk(wire, 6)) if (found := ear.feed(packet)) is not None]
    assert heard[0].device == wire.device


@pytest.mark.parametrize(
    ("device", "name"), [(MipDevice(), "mip"), (XsensDevice(), "xsens"), (Gx1Device(), "gx1")]
)
def test_into_silence_it_asks(device, name: str) -> None:
    found = result(converse(probe(), device))
    assert found.device == name
    assert "answered" in found.evidence


def test_nobody_there_is_no_answer() -> None:
    talk = converse(probe(), KINDS["witmotion"].model(KINDS["witmotion"].axes))
    assert (talk.result, talk.failed) == (None, "")


def test_a_probe_never_sends_what_could_write_to_a_gx1() -> None:
    class Listening(Gx1Device):
        def receive(self, data: bytes) -> bytes:
            assert not set(data) & {0x09, 0x29, 0x24, 0x0F, 0x11, 0x40, 0x42}
            return b""

    converse(probe(), Listening())


@pytest.mark.parametrize("name", KINDS)
def test_every_kind_starts_streams_and_decodes(name: str) -> None:
    kind = KINDS[name]
    model, setup, rest = kind.model(kind.axes), None, b""
    samples = at_rest(600)
    if kind.start_up is not None:
        talk = converse(kind.start_up(100.0), model, samples[:150])
        setup, rest = result(talk), talk.left_over
    decoder = kind.decoder("left", kind.axes, setup)
    sent = [rest, *map(model.measure, samples[150:])]
    got = [s for i, data in enumerate(sent) for s in decoder.feed(data, i * 10_000_000)]
    assert len(got) > 40
    assert {sample.sensor for sample in got} == {"left"}
    np.testing.assert_allclose([s.specific_force_b for s in got], [(0, 0, -9.80665)] * len(got), atol=0.01)
    assert identify(b"".join(sent)) is not None
    assert len(kind.bauds) == len(set(kind.bauds)) > 0
