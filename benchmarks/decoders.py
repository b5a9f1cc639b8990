"""Benchmarks: the wire decoders' pace, and what 1 % of rubbish does to them."""

from __future__ import annotations

import time
from typing import Any

from app.formats.wire.catalogue import KINDS, Decoder, Kind
from app.formats.wire.faults import Faults, Line
from app.formats.wire.talk import Talk
from app.motion.samples import Sample
from app.simulate.walk import make_walk
from app.sources.timeline import Timeline
from benchmarks.figures import Figure, Section

COUNT = 20_000
#: As a host reads them at 115200 baud.
CHUNK = 64
BEST_OF = 3
#: A third each: flipped, dropped, and with a stray byte before it.
RUBBISH = Faults(lost=0.01 / 3, flip=0.01 / 3, garbage=0.01 / 3)
WANTED = 20.0
#: Without a checksum, their packets ended by a delimiter.
DELIMITED = ("ximu3", "ngimu", "csv")


def decoders() -> Section:
    """Each device: samples a second beside its fastest rate, and the figures of a bad line."""
    for device, kind in KINDS.items():
        setup, packets = sent(kind)
        yield pace(device, kind, setup, packets)
    for device, kind in KINDS.items():
        setup, packets = sent(kind)
        yield from rubbish(device, kind, setup, packets)


def sent(kind: Kind) -> tuple[Any, list[bytes]]:
    """What its start-up found, and a packet or burst for each of ``COUNT`` samples."""
    model, setup = kind.model(kind.axes), None
    if kind.start_up is not None:
        talk = Talk(kind.start_up(kind.fastest_hz))
        while talk.ask is not None:
            if not talk.receive(model.receive(talk.ask.send)):
                talk.expire()
        setup = talk.result
    rate_hz = model.rate_hz
    walk = make_walk({"duration_s": f"{COUNT / rate_hz + 2.0:.0f}", "rate_hz": f"{rate_hz:g}", "noise": "1"})
    samples = Timeline(walk.recording).cut(0, COUNT, 0)
    messages = (model.measure(sample._replace(device_q_nb=(1.0, 0.0, 0.0, 0.0))) for sample in samples)
    return setup, [message for message in messages if message]


def pace(device: str, kind: Kind, setup: Any, packets: list[bytes]) -> Figure:
    """Samples a second of processor time, the best of three runs."""
    stream = b"".join(packets)
    best = 0.0
    for _ in range(BEST_OF):
        decoder = kind.decoder("foot", kind.axes, setup)
        decoder.feed(stream[:4096], 0)
        taken, began = 0, time.process_time()
        for at in range(4096, len(stream), CHUNK):
            taken += len(decoder.feed(stream[at : at + CHUNK], at * 87_000))
        best = max(best, taken / (time.process_time() - began))
    times = best / kind.fastest_hz
    note = (
        f"{best:.0f} samples/s, {len(stream) / len(packets):.0f} bytes each; fastest {kind.fastest_hz:g} Hz"
    )
    return Figure(f"{device}: pace ÷ its fastest rate", times, "×", WANTED, True, note)


def rubbish(device: str, kind: Kind, setup: Any, packets: list[bytes]) -> Section:
    """With 1 % of bytes flipped, dropped or strange: intact packets missed, and whether the counters add up.

    Where a packet ends with a delimiter, it is intact if the delimiter before it is, too.
    """
    line = Line(RUBBISH, seed=1)
    carried = [packets[0], *(line.carry(packet) for packet in packets[1:])]  # a text's header comes once
    whole = [i for i, packet in enumerate(packets) if carried[i] == packet]
    if device in DELIMITED:
        whole = [i for i in whole if not i or carried[i - 1][-1:] == packets[i - 1][-1:]]
    clean, bad = kind.decoder("foot", kind.axes, setup), kind.decoder("foot", kind.axes, setup)
    should, came = read(clean, packets), read(bad, carried)
    values = {reading(sample) for sample in should}
    got = {reading(sample) for sample in came}
    missed = sum(reading(should[i]) not in got for i in whole) if len(should) == len(packets) else None
    c = bad.counters
    apart = c.bytes_fed - c.bytes_good - c.bytes_skipped - c.bytes_pending
    share = f"{len(whole)} of {len(packets)} intact"
    if device in DELIMITED:
        share += "; these came behind a damaged stamp that nothing tells from a true one"
    wanted = None if device in DELIMITED else 0.0
    yield Figure(f"{device}, 1 % rubbish: intact packets not read", missed, "", wanted, note=share)
    false = sum(reading(sample) not in values for sample in came)
    yield Figure(f"{device}, 1 % rubbish: samples that were never sent", false, "", note=weakness(device))
    yield Figure(f"{device}, 1 % rubbish: bytes fed less those counted", abs(apart), "", 0.0)


def weakness(device: str) -> str:
    """What its checksum can see."""
    sums = {"gx1": "16-bit sum", "mip": "Fletcher", "xsens": "8-bit sum", "witmotion": "8-bit sum"}
    return f"its {sums[device]} cannot see them" if device in sums else "it has no checksum"


def read(decoder: Decoder, packets: list[bytes]) -> list[Sample]:
    """All samples, the packets arriving a millisecond apart."""
    return [sample for i, packet in enumerate(packets) for sample in decoder.feed(packet, i * 1_000_000)]


def reading(sample: Sample) -> tuple[Any, ...]:
    """What was measured, without when."""
    return (sample.specific_force_b, sample.angular_rate_b)
