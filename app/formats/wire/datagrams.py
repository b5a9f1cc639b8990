"""Heart: what many senders put into datagrams on one port: our messages, and sensors' own protocols.

Our messages say themselves which sensor they are of. Anything else is told by its form, a decoder for each
sender. A sender is its address and port; one that comes back from another port after a silence (a board
that restarted) is the same.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from app.formats.options import Options
from app.formats.wire import ngimu
from app.formats.wire.catalogue import KINDS, Decoder
from app.formats.wire.identify import Identifier
from app.formats.wire.intake import Intake
from app.formats.wire.message import MAGIC
from app.formats.wire.stream import Counters
from app.motion.samples import Sample

MOST_SENDERS = 64
_TRIES = 64  # datagrams by which a sender must be known
_SILENT_NS = 2_000_000_000

Address = tuple[str, int]


@dataclass
class _Sender:
    """One address: listened to until it is known; then its decoder, or nothing for one that never is."""

    listening: Identifier | None
    decoder: Decoder | None = None
    sensor: str = ""
    heard: int = 0
    last_ns: int = 0


class Datagrams:
    """``feed`` each datagram with its sender. ``names`` says which address is which foot.

    ``options.device`` says what all of them are instead of listening first.
    """

    def __init__(self, options: Options | None = None, names: Mapping[str, str] | None = None) -> None:
        self._options = options or Options()
        self._names = names or {}
        self.intake = Intake(self._options)
        self._senders: dict[Address, _Sender] = {}
        self._notes: list[str] = []
        self._named = 0
        self.ignored = 0

    @property
    def notes(self) -> list[str]:
        """What was found and what was assumed."""
        told = [note for decoder in self._decoders().values() for note in decoder.notes]
        return list(dict.fromkeys([*self._notes, *self.intake.notes, *told]))

    def _decoders(self) -> dict[str, Decoder]:
        """By their sensors; asked for from another thread than ``feed``'s, so of a copy."""
        return {s.sensor: s.decoder for s in list(self._senders.values()) if s.decoder is not None}

    def counters(self) -> dict[str, Counters]:
        """What became of the bytes: of our messages together, of others by sensor."""
        return {"messages": self.intake.counters} | {n: d.counters for n, d in self._decoders().items()}

    def temperatures(self) -> dict[str, float]:
        """Of the sensors that tell it, °C."""
        told = {name: decoder.temperature_c for name, decoder in self._decoders().items()}
        found = {name: celsius for name, celsius in told.items() if celsius is not None}
        return {**self.intake.temperatures, **found}

    def lost(self) -> dict[str, int]:
        """What did not become a sample, by reason in words."""
        sums: Counter[str] = Counter()
        for counters in self.counters().values():
            sums["lost on the way"] += counters.lost
            sums["came twice or too late"] += counters.repeated
            sums["unusable readings"] += counters.dropped
            sums["damaged messages"] += counters.bad_checksum
        sums["datagrams of unknown senders"] = self.ignored
        return dict(sums)

    def feed(self, data: bytes, sender: Address, host_ns: int) -> list[Sample]:
        """The samples that a datagram completes."""
        known = self._senders.get(sender)
        if (known is None or known.decoder is None) and _is_ours(
            data
        ):  # also of one that sent rubbish before
            return self.intake.take(data, host_ns)[0]
        if known is None:
            known = self._admit(sender, host_ns)
            if known is None:
                self.ignored += 1
                return []
        known.last_ns = host_ns
        if known.decoder is not None:
            return self._timed(known.decoder.feed(data, host_ns))
        return self._timed(self._listen(known, sender, data, host_ns))

    def _timed(self, samples: list[Sample]) -> list[Sample]:
        rate_hz = self._options.rate_hz
        if rate_hz is None:
            return samples
        return [sample._replace(device_ns=round(sample.seq * 1e9 / rate_hz)) for sample in samples]

    def _admit(self, sender: Address, host_ns: int) -> _Sender | None:
        host, _ = sender
        silent = [a for a, s in self._senders.items() if host_ns - s.last_ns > _SILENT_NS]
        again = next((a for a in silent if a[0] == host), None)
        if again is not None:
            known = self._senders.pop(again)
            known.heard = 0
        else:
            for strange in silent:
                if self._senders[strange].decoder is None:
                    del self._senders[strange]
            if len(self._senders) >= MOST_SENDERS:
                return None
            known = _Sender(Identifier(datagrams=True))
            if self._options.device is not None:
                self._open(known, sender, self._options.device, "")
        self._senders[sender] = known
        return known

    def _listen(self, known: _Sender, sender: Address, data: bytes, host_ns: int) -> list[Sample]:
        known.heard += 1
        if known.listening is None or known.heard > _TRIES:
            self.ignored += 1
            return []
        found = known.listening.feed(data)
        if found is None:
            return []
        heard = data if found.device == "ngimu" else known.listening.heard
        self._open(known, sender, found.device, found.evidence)
        known.listening = None
        return known.decoder.feed(heard, host_ns) if known.decoder else []

    def _open(self, known: _Sender, sender: Address, device: str, evidence: str) -> None:
        name = known.sensor = self._name(sender)
        kind = KINDS.get(device)
        axes = self._options.axes or (kind.axes if kind else None)
        if kind is None or axes is None:
            return
        if device == "ngimu":
            known.decoder = ngimu.NgimuDecoder(name, axes, slip=False)
        else:
            known.decoder = kind.decoder(name, axes, None)
        if evidence:
            self._notes.append(
                f"{name}: {sender[0]} sends as {kind.title.removesuffix(' (serial)')}: {evidence}"
            )

    def _name(self, sender: Address) -> str:
        told = self._names.get(f"{sender[0]}:{sender[1]}") or self._names.get(sender[0])
        if told:
            return told
        self._named += 1
        first = self._options.foot or "foot"
        return first if self._named == 1 else f"{first}-{self._named}"


def _is_ours(data: bytes) -> bool:
    return data.startswith(MAGIC) or (data[:1] == b"{" and b'"session"' in data)
