"""Packets and axes at a real socket: often enough, not too often, zeros at the end."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from pythonosc.osc_message import OscMessage

from app.formats import osc
from app.gestures.packet import decode, encode
from app.motion.basics import InputError, MotionId
from app.outputs.senders import AXES_S, AxesSender, Outlet, PacketSender, address_of


@contextmanager
def listening() -> Iterator[tuple[socket.socket, Outlet]]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ear:
        ear.bind(("127.0.0.1", 0))
        ear.settimeout(60.0)
        yield ear, Outlet(f"127.0.0.1:{ear.getsockname()[1]}", "--udp")


def received(ear: socket.socket) -> list[bytes]:
    ear.settimeout(0.2)
    found = []
    while True:
        try:
            found.append(ear.recv(2048))
        except TimeoutError:
            return found


def test_packets_on_every_change_and_ten_times_a_second() -> None:
    with listening() as (ear, outlet):
        sender, still = PacketSender(outlet, encode(MotionId.NONE, 0.0)), encode(MotionId.NONE, 0.0)
        for frame in range(120):  # two seconds
            sender.tell(encode(MotionId.FORWARD, 1.2) if frame >= 61 else still, frame / 60)
        came = received(ear)
        assert 20 <= len(came) <= 40
        first = next(i for i, data in enumerate(came) if data != still)
        assert decode(came[first]) == (MotionId.FORWARD, 1.2)
        sender.close()
        assert received(ear)[-3:] == [still] * 3


def test_axes_are_read_by_another_library_and_end_in_zeros() -> None:
    with listening() as (ear, outlet):
        sender = AxesSender(outlet)
        for frame in range(60):
            sender.tell(0.01 * frame, 0.0, -0.5, frame / 60)
        came = [OscMessage(data) for data in received(ear)]
        ahead = [m.params[0] for m in came if m.address == osc.FORWARD]
        assert len(ahead) <= 1.0 / AXES_S + 1
        assert ahead == sorted(ahead)
        assert next(m.params[0] for m in came if m.address == osc.TURN) == -0.5
        aside = [m.params[0] for m in came if m.address == osc.RIGHT]
        assert aside == [0.0] * 3  # said three times, then not again
        sender.close()
        last: dict[str, float] = {}
        for data in received(ear):
            last[OscMessage(data).address] = OscMessage(data).params[0]
        assert last == {osc.FORWARD: 0.0, osc.RIGHT: 0.0, osc.TURN: 0.0}


def test_a_stop_is_sent_at_once_and_again() -> None:
    with listening() as (ear, outlet):
        sender = AxesSender(outlet)
        for frame in range(120):
            sender.tell(0.6 if frame < 60 else 0.0, 0.0, 0.0, frame / 60)
        ahead = [m.params[0] for m in map(OscMessage, received(ear)) if m.address == osc.FORWARD]
        assert ahead[-3:] == [0.0] * 3
        assert ahead.count(0.0) == 3


def test_nobody_listening_is_no_fault() -> None:
    outlet = Outlet("127.0.0.1:9", "--udp")
    for _ in range(3):
        outlet.send(b"anybody?")
    outlet.close()


@pytest.mark.parametrize("text", ["", "host", "host:", ":9000", "host:0", "host:70000", "host:x", "host:-1"])
def test_a_wrong_address_is_one_line(text: str) -> None:
    with pytest.raises(InputError, match="--osc"):
        address_of(text, "--osc")


def test_an_address_of_version_six() -> None:
    assert address_of("[::1]:9000", "--osc") == ("::1", 9000)
