"""Heart: packets cut out of a byte stream that may begin, break and be damaged anywhere.

Where a packet does not hold, ONE byte is dropped and the search goes on behind it, so that an intact
packet is never lost to a damaged one before it. Every byte ends in exactly one counter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

#: Where, at or after a place, a packet may begin; the length of the bytes if nowhere.
Find = Callable[[bytes, int], int]
#: How long the packet at a place is; ``UNKNOWN_YET`` or ``NO_PACKET``.
Size = Callable[[bytes, int], int]
#: Whether a whole packet holds: its checksum, or what else the protocol offers.
Check = Callable[[bytes], bool]

UNKNOWN_YET = 0
NO_PACKET = -1


@dataclass
class Counters:
    """What became of the bytes and of the packets in them.

    Always ``bytes_fed == bytes_good + bytes_skipped + bytes_pending``.
    """

    bytes_fed: int = 0
    bytes_good: int = 0  # inside packets that held
    bytes_skipped: int = 0  # rubbish, and what was damaged
    bytes_pending: int = 0  # the beginning of a packet that has not ended yet
    packets: int = 0  # that held
    bad_checksum: int = 0  # began like a packet and did not hold
    unknown: int = 0  # held, but carry nothing that is read here
    dropped: int = 0  # held, but their reading was unusable: not finite, incomplete, a stamp twice
    lost: int = 0  # missing by the device's own packet counter, where it has one
    repeated: int = 0  # came again, or too late: known by their number, and not given twice


class Frames:
    """A stream of one protocol. ``largest`` is its longest packet, and so bounds what is kept."""

    def __init__(self, find: Find, size: Size, check: Check, largest: int) -> None:
        self.counters = Counters()
        self.breaks: set[int] = set()  # of the packets last given: those that bytes were skipped before
        self._find, self._size, self._check = find, size, check
        self._largest = largest
        self._pending = b""
        self._broken = False

    def feed(self, data: bytes) -> list[bytes]:
        """The packets that ``data`` completes, in order; the same however the stream is cut."""
        self.counters.bytes_fed += len(data)
        data = self._pending + data
        counters, find, size, check = self.counters, self._find, self._size, self._check
        packets: list[bytes] = []
        self.breaks.clear()
        at = good = 0
        while (start := find(data, at)) < len(data):
            length = size(data, start)
            self._broken |= start > at
            at = start
            waits = length == UNKNOWN_YET or at + length > len(data)
            if length > self._largest or (waits and len(data) - at >= self._largest):
                length = NO_PACKET
            elif waits:
                break
            if length > 0 and check(packet := data[at : at + length]):
                if self._broken:
                    self.breaks.add(len(packets))
                    self._broken = False
                packets.append(packet)
                good += length
                at += length
            else:
                counters.bad_checksum += length > 0
                self._broken = True
                at += 1
        else:
            self._broken |= len(data) > at
            at = len(data)
        counters.packets += len(packets)
        counters.bytes_good += good
        self._pending = data[at:]
        counters.bytes_pending = len(self._pending)
        counters.bytes_skipped = counters.bytes_fed - counters.bytes_good - counters.bytes_pending
        return packets

    def spoil(self, packet: bytes) -> None:
        """Count a packet that was given as one that did not hold: what stands in it says so."""
        counters = self.counters
        counters.packets -= 1
        counters.bad_checksum += 1
        counters.bytes_good -= len(packet)
        counters.bytes_skipped += len(packet)


def find_header(header: bytes) -> Find:
    """Where a fixed header begins, be it only its beginning at the very end of the bytes."""

    def find(data: bytes, at: int) -> int:
        start = data.find(header, at)
        if start >= 0:
            return start
        for kept in range(min(len(header) - 1, len(data) - at), 0, -1):
            if data.endswith(header[:kept]):
                return len(data) - kept
        return len(data)

    return find


def find_first(first_bytes: bytes) -> Find:
    """Where one of these bytes stands."""
    table = bytes(byte in first_bytes for byte in range(256))

    def find(data: bytes, at: int) -> int:
        if at < len(data) and table[data[at]]:
            return at
        start = data[at:].translate(table).find(1)
        return len(data) if start < 0 else at + start

    return find
