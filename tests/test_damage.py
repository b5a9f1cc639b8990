"""What a line damages, by its decoder's counters: the share, the light, the words."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from app.damage import Damage
from app.formats.mounting import AS_GIVEN
from app.formats.wire.gx1 import Gx1Decoder, Gx1Encoder, Gx1Setup
from app.formats.wire.stream import Counters
from app.motion.basics import Role, role_of
from app.motion.health import Light
from app.motion.samples import Sample
from app.session import Session
from app.settings import Settings


def seen_at(watch: Damage, rate: float, seconds: int, counters: Counters, began_s: float = 0.0) -> float:
    """A hundred packets of 31 bytes a second, of which ``rate`` are damaged; the share at the end."""
    for i in range(seconds):
        counters.bytes_fed += 3100
        counters.bytes_skipped += round(3100 * rate)
        counters.bad_checksum += round(100 * rate)
        share = watch.share("left", counters, began_s + i)
    return share


def test_the_share_is_that_of_the_last_ten_seconds() -> None:
    watch, counters = Damage(), Counters()
    assert seen_at(watch, 0.0, 30, counters) == 0.0
    assert seen_at(watch, 0.02, 10, counters, 30.0) == pytest.approx(0.02, abs=0.003)
    assert seen_at(watch, 0.0, 11, counters, 40.0) == 0.0


def test_what_is_said_is_said_for_a_second_and_in_whole_percents() -> None:
    """A line with a bit flipped now and then, looked at ten times a second: words that can be read."""
    watch, counters, random = Damage(), Counters(), np.random.default_rng(3)
    told = []
    for i in range(400):
        bad = int(np.count_nonzero(random.random(10) < 0.02))
        counters.bytes_fed += 310
        counters.bytes_skipped += 31 * bad
        counters.bad_checksum += bad
        told.append(watch.told({Role.LEFT: counters}, 0.125 * i))
    changes = [i for i in range(1, len(told)) if told[i] != told[i - 1]]
    assert len(changes) > 1
    assert min(b - a for a, b in pairwise(changes)) >= 8
    assert all(words.split(":")[1].split("%")[0].strip().isdigit() for words in told if words)


def test_one_damaged_packet_is_none_and_a_new_decoder_begins_anew() -> None:
    watch, counters = Damage(), Counters(bytes_fed=1000)
    watch.share("left", counters, 0.0)
    counters.bytes_fed, counters.bytes_skipped, counters.bad_checksum = 1100, 31, 1
    assert watch.share("left", counters, 1.0) == 0.0
    assert watch.share("left", Counters(bytes_fed=31), 2.0) == 0.0


@pytest.mark.parametrize(("spoilt", "light"), [(0, Light.GREEN), (2, Light.AMBER), (12, Light.RED)])
def test_a_bad_cable_is_said_of_its_foot(spoilt: int, light: Light) -> None:
    """Real packets, ``spoilt`` of each hundred with a bit flipped, through the decoder and the session."""
    setup = Gx1Setup(tick_ns=2_000_000)
    encoder, decoder = Gx1Encoder(AS_GIVEN, setup), Gx1Decoder("left", AS_GIVEN, setup)
    session, watch = Session(Settings(), role_of), Damage()
    flipped = np.random.default_rng(0).permutation(100) < spoilt
    for i in range(1200):
        now_ns = i * 10_000_000
        sample = Sample("left", i, now_ns, now_ns, (0.0, 0.0, -9.81), (0.0, 0.0, 0.0), (20.0, 0.0, 40.0))
        packet = bytearray(encoder.encode(sample))
        packet[9] ^= flipped[i % 100]
        for read in decoder.feed(bytes(packet), now_ns):
            session.take(read)
        told = watch.seen(session.snapshot(), {"left": decoder.counters}, now_ns * 1e-9) if i else None
    assert told is not None
    health = told.health["left"]
    assert health.light is light
    assert health.recent is not None
    assert health.recent.damaged == pytest.approx(spoilt / 100, abs=0.01)
    assert health.reason.startswith("left foot:") == bool(spoilt)
    assert ("packets damaged" in health.reason) == bool(spoilt)
    assert told.main.feet[0].role is Role.LEFT


def test_it_says_which_foot_of_two_it_is() -> None:
    watch, sound, bad = Damage(), Counters(), Counters()
    for i in range(11):
        for counters, rate in ((sound, 0.0), (bad, 0.2)):
            counters.bytes_fed += 3100
            counters.bytes_skipped += round(3100 * rate)
            counters.bad_checksum += round(100 * rate)
        told = watch.told({Role.LEFT: sound, Role.RIGHT: bad}, float(i))
    assert told.startswith("right foot: 20 % of packets damaged")
    assert not Damage().told({}, 0.0)
    assert not Damage().told({Role.LEFT: sound}, 0.0)
