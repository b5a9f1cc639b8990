"""Heart: what a receiver of messages answers: how far it has taken them, or why it refused one."""

from __future__ import annotations

import json
from typing import NamedTuple

from app.formats.wire.message import HEX, NAME, VERSION


class Ack(NamedTuple):
    """Every sample of this sensor and session before ``next`` has been taken."""

    session: int
    sensor: str
    next: int


class Refused(NamedTuple):
    """A message was not taken, and why; or what came is no answer."""

    why: str


def encode_ack(ack: Ack) -> str:
    """For the sender, as JSON."""
    told = {"session": f"{ack.session:x}", "sensor": ack.sensor, "next": ack.next}
    return json.dumps({"v": VERSION, "ack": told}, separators=(",", ":"))


def encode_refusal(why: str) -> str:
    """Why a message was not taken, for the sender."""
    return json.dumps({"v": VERSION, "error": why[:200]}, separators=(",", ":"))


def decode_reply(data: bytes | str) -> Ack | Refused:
    """What a receiver answered: an ``Ack``, or why it refused, or that this is no answer."""
    try:
        told = json.loads(data)
        if "error" in told:
            return Refused(str(told["error"])[:200])
        ack = told["ack"]
        session, sensor, following = ack["session"], ack["sensor"], ack["next"]
        if HEX.fullmatch(session) and NAME.fullmatch(sensor) and type(following) is int:
            return Ack(int(session, 16), sensor, following)
    except (ValueError, TypeError, KeyError, RecursionError):
        pass
    return Refused("no answer of a receiver")
