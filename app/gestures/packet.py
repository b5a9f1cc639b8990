"""Heart: MOVESMover's UDP packet (dissertation, ch. V-B): two shorts, motion and speed."""

from __future__ import annotations

import struct

from app.gestures.words import Decision
from app.motion.basics import MotionId

PACKET = struct.Struct(">hh")  # motion id, speed in mm/s: signed, big-endian
_MOST = 2**15 - 1


def encode(motion: MotionId, speed_mps: float) -> bytes:
    """Four bytes. A speed beyond 32.767 m/s is sent as that; one that is no number as standing still."""
    speed = round(1000.0 * speed_mps) if abs(speed_mps) < 1e6 else 0
    return PACKET.pack(int(motion), max(-_MOST, min(_MOST, speed)))


def packet_of(decision: Decision) -> bytes:
    """The packet that says this decision."""
    return encode(decision.motion, decision.speed_mps)


def decode(data: bytes) -> tuple[MotionId, float]:
    """The motion and the speed in m/s; ``ValueError`` if these are not four bytes of a known motion."""
    if len(data) != PACKET.size:
        raise ValueError(f"{len(data)} bytes, expected {PACKET.size}")
    motion, speed = PACKET.unpack(data)
    return MotionId(motion), speed * 1e-3
