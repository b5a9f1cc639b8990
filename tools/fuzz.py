"""Tools: a coverage-guided search for bytes that break a decoder, a start-up or an ingest message.

    .venv/bin/python -m pip install atheris          (Linux; not in the lock: nothing else needs it)
    .venv/bin/python tools/fuzz.py -max_total_time=300 [-dict=… and libFuzzer's other options] [CORPUS]

It ends with the bytes that break a law, or says how many it tried. The laws: nothing raises; every byte is
in one counter; stamps and numbers increase; every reading is finite; no more than one packet is kept. A
corpus folder that is named keeps what was found, and the next run goes on from there.
"""

from __future__ import annotations

import math
import os
import sys
from itertools import pairwise
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
os.environ["NUMBA_DISABLE_JIT"] = "1"  # what is compiled cannot be watched

import atheris

with atheris.instrument_imports(include=["app.formats"]):
    from app.formats.wire import datagrams, identify, message
    from app.formats.wire.catalogue import KINDS, Decoder
    from app.formats.wire.talk import Talk
    from app.formats.wire.warmth import COLDEST_C, HOTTEST_C

from app.motion.samples import Sample

KEPT = 20_000  # bytes: the longest packet, and a talk's longest answer
DEVICES = tuple(KINDS)
MOST_ASKS = 2000


def check(samples: list[Sample], decoder: Decoder) -> None:
    """The laws of a decoder."""
    counters = decoder.counters
    assert counters.bytes_fed == counters.bytes_good + counters.bytes_skipped + counters.bytes_pending
    assert counters.bytes_pending <= KEPT
    assert decoder.temperature_c is None or COLDEST_C <= decoder.temperature_c <= HOTTEST_C
    for before, after in pairwise(samples):
        assert before.seq + 1 == after.seq
        assert before.device_ns < after.device_ns
    for sample in samples:
        assert all(map(math.isfinite, (*sample.specific_force_b, *sample.angular_rate_b)))
        assert sample.device_q_nb is None or 0.9 < sum(q * q for q in sample.device_q_nb) < 1.1


def feed(device: str, pieces: list[bytes]) -> None:
    """A decoder, fed piece by piece at 10 ms."""
    kind = KINDS[device]
    decoder = kind.decoder("foot", kind.axes, None)
    samples: list[Sample] = []
    for number, piece in enumerate(pieces):
        samples += decoder.feed(piece, number * 10_000_000)
    check(samples, decoder)


def start(device: str, pieces: list[bytes]) -> None:
    """A start-up that is answered with anything; its decoder reads on with what it learnt."""
    kind = KINDS[device]
    if kind.start_up is None:
        return
    talk = Talk(kind.start_up(100.0))
    for piece in pieces:
        if talk.ask is not None and not talk.receive(piece):
            talk.expire()
    for _ in range(MOST_ASKS):
        if talk.ask is None:
            break
        talk.expire()
    assert talk.ask is None, "it never ends"
    if not talk.failed:
        decoder = kind.decoder("foot", kind.axes, talk.result)
        check(decoder.feed(b"".join(pieces), 0), decoder)


def model(device: str, pieces: list[bytes]) -> None:
    """An emulated sensor that is told anything."""
    emulated = KINDS[device].model(KINDS[device].axes)
    for number, piece in enumerate(pieces):
        assert isinstance(emulated.receive(piece), bytes)
        still = Sample("foot", number, number * 10_000_000, 0, (0.0, 0.0, -9.8), (0.0, 0.0, 0.0))
        emulated.measure(still)
        assert emulated.rate_hz > 0.0


def one(data: bytes) -> None:
    """The first byte chooses what is fed, the second how it is cut."""
    if len(data) < 3:
        return
    choice, step = data[0], 1 + data[1] % 64
    rest = data[2:]
    pieces = [rest[at : at + step] for at in range(0, len(rest), step)] if data[1] < 192 else [rest]
    device = DEVICES[choice % len(DEVICES)]
    match choice // len(DEVICES) % 6:
        case 0 | 1:
            feed(device, pieces)
        case 2:
            start(device, pieces)
        case 3:
            model(device, pieces)
        case 4:
            identify.Identifier().feed(rest)
            message.decode(rest, 0)
        case _:
            listening = datagrams.Datagrams()
            for number, piece in enumerate(pieces):
                listening.feed(piece, ("10.0.0.1", 9000 + number % 3), number * 10_000_000)


def seeds(folder: Path) -> None:
    """What sound sensors send, to begin from."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, device in enumerate(DEVICES):
        emulated = KINDS[device].model(KINDS[device].axes)
        sent = emulated.receive(b"\x10\x00\x0c") if device == "gx1" else b""
        for i in range(8):
            sent += emulated.measure(Sample("foot", i, i * 100_000_000, 0, (0.1, 0.2, -9.8), (0.0, 0.1, 0.2)))
        for task in range(6):
            (folder / f"{device}-{task}").write_bytes(bytes([task * len(DEVICES) + number, 255]) + sent)


def main() -> None:
    """Hand over to libFuzzer."""
    folder = Path(__file__).resolve().parent.parent / "build" / "fuzz"
    seeds(folder)
    for found in (argument for argument in sys.argv[1:] if not argument.startswith("-")):
        Path(found).mkdir(parents=True, exist_ok=True)
    atheris.Setup([*sys.argv, str(folder)], one)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
