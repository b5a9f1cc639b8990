"""Health: what was done to a stream is what the light says, and good streams stay green."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np
import pytest

from app.clocks import FixedClock, LiveClock
from app.health import BINS, Monitor, judge, percent, report
from app.motion.basics import GaitPhase, Role
from app.motion.health import Health, Light, Recent
from app.motion.samples import Sample

G = 9.80665


def stream(seconds: float, rate_hz: float = 100.0, seed: int = 0, start_ns: int = 0) -> Iterator[Sample]:
    """A foot that stands, with a sensor's noise; arrivals a millisecond late."""
    noise = np.random.default_rng(seed).normal(0.0, 0.05, (int(seconds * rate_hz), 3))
    for i, (a, b, c) in enumerate(noise.tolist()):
        at = start_ns + round(i * 1e9 / rate_hz)
        yield Sample("right", i, at, at + 1_000_000, (a, b, c - G), (0.0, 0.0, 0.0), (20.0, 0.0, 40.0))


def watched(samples: Iterator[Sample], keep: Callable[[Sample], bool] = lambda _: True) -> Monitor:
    clock = LiveClock()
    monitor = Monitor(clock)
    for sample in filter(keep, samples):
        clock.add(sample.device_ns, sample.host_ns)
        monitor.add(sample, True, GaitPhase.STANCE)
    return monitor


def seen(monitor: Monitor, silent_s: float = 0.0) -> tuple[Recent, Light, str]:
    recent = monitor.recent(silent_s, live=True)
    return recent, *judge(Role.RIGHT, recent, uses_field=True)


@pytest.mark.parametrize("rate_hz", [50.0, 60.0, 100.0, 400.0])
def test_a_good_stream_is_green(rate_hz: float) -> None:
    recent, light, reason = seen(watched(stream(30.0, rate_hz)))
    assert (light, reason) == (Light.GREEN, "")
    assert recent.rate_hz == pytest.approx(rate_hz, rel=1e-6)
    assert recent.lost == recent.duplicated == recent.rejected == recent.saturated == 0
    assert (BINS - 1) * rate_hz < recent.samples <= BINS * rate_hz
    assert recent.gravity_mps2 == pytest.approx(G, abs=0.02)
    assert recent.stance_mps2 is not None
    assert 0.0 < recent.stance_mps2 < 0.05  # the stillest of what scatters by 0.05
    assert recent.disturbance == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("every", "light"), [(33, Light.AMBER), (10, Light.RED), (500, Light.GREEN)])
def test_lost_samples_are_counted_and_said(every: int, light: Light) -> None:
    monitor = watched(stream(30.0), lambda sample: sample.seq % every != 7)
    recent, got, reason = seen(monitor)
    assert recent.lost / (recent.lost + recent.samples) == pytest.approx(1 / every, rel=0.2)
    assert got is light
    if every == 33:
        assert reason == "right foot: 3 % of samples lost in the last 10 s: move the receiver closer"


def test_what_is_over_is_forgotten() -> None:
    monitor = watched(stream(30.0), lambda sample: not (500 < sample.seq < 900 and sample.seq % 3))
    assert seen(monitor)[0].lost == 0
    assert seen(monitor)[1] is Light.GREEN


@pytest.mark.parametrize("cut_s", [1.5, 5.0, 25.0])
def test_a_cable_that_was_out_is_told_as_such_and_lost_no_samples(cut_s: float) -> None:
    """Not as a radio's loss, at any length; and ten seconds after it is in again all is well."""
    back = round(100 * (20.0 + cut_s))

    def plugged(sample: Sample) -> bool:
        return not 2000 < sample.seq < back

    recent, light, reason = seen(watched(stream(20.0 + cut_s + 3.0), plugged))
    assert recent.lost == 0
    assert recent.cut_s == pytest.approx(cut_s)
    told = f"nothing came from it for {cut_s:.1f} s: was it unplugged, without power or out of reach?"
    assert (light, reason) == (Light.AMBER, f"right foot: {told}")
    assert seen(watched(stream(20.0 + cut_s + 11.5), plugged))[1:] == (Light.GREEN, "")


def test_samples_that_went_by_unwatched_are_not_lost() -> None:
    monitor = watched(stream(20.0))
    monitor.skip()
    for sample in stream(5.0, start_ns=23 * 10**9):
        monitor.add(sample, True, GaitPhase.STANCE)
    assert seen(monitor)[0].lost == 0


def test_samples_twice_and_out_of_order_are_told_apart() -> None:
    monitor = watched(stream(20.0))
    last = list(stream(20.0))[-1]
    for _ in range(40):
        monitor.add(last, False, GaitPhase.STANCE)
    recent, light, reason = seen(monitor)
    assert (recent.duplicated, recent.rejected, light) == (40, 0, Light.AMBER)
    assert "twice" in reason
    for _ in range(200):
        monitor.add(last._replace(device_ns=5), False, GaitPhase.STANCE)
    recent, light, reason = seen(monitor)
    assert (recent.rejected, light) == (200, Light.RED)
    assert "no use" in reason


def test_late_arrivals_are_jitter_of_a_live_sensor_only() -> None:
    late = [s._replace(host_ns=s.host_ns + (s.seq % 7 == 0) * 300_000_000) for s in stream(30.0)]
    monitor = watched(iter(late))
    recent, light, reason = seen(monitor)
    assert recent.late_ms == pytest.approx(300.0, abs=1.0)
    assert recent.jitter_ms == pytest.approx(300.0 * math.sqrt(1 / 7 * 6 / 7), rel=0.05)
    assert light is Light.AMBER
    assert "late" in reason
    assert monitor.recent(0.0, live=False).jitter_ms is None


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (lambda s: s._replace(saturation=s.seq % 20 == 0), "range"),
        (
            lambda s: s._replace(specific_force_b=(0.0, 0.0, -G - 2.0 * (-1) ** s.seq)),
            "strap",
        ),
        (lambda s: s._replace(specific_force_b=(0.0, 0.0, -9.2)), "calibrate"),
        (lambda s: s._replace(field_b=(20.0, 0.0, 40.0 + (s.seq > 1500) * 30.0)), "iron"),
    ],
)
def test_what_the_sensor_does_wrong_is_said_with_its_remedy(
    change: Callable[[Sample], Sample], word: str
) -> None:
    _, light, reason = seen(watched(change(sample) for sample in stream(30.0)))
    assert light is Light.AMBER
    assert word in reason
    assert reason.startswith("right foot: ")


def test_a_disturbed_field_matters_only_where_it_is_used() -> None:
    monitor = watched(s._replace(field_b=(20.0, 0.0, 40.0 + (s.seq > 1500) * 30.0)) for s in stream(30.0))
    assert judge(Role.FOOT, monitor.recent(0.0, live=True), uses_field=False) == (Light.GREEN, "")


def test_silence_is_the_worst_and_a_slow_sensor_is_told() -> None:
    _, light, reason = seen(watched(stream(20.0)), silent_s=2.34)
    assert (light, reason.split(":")[1]) == (Light.RED, " silent for 2.3 s")
    assert seen(watched(stream(60.0, 25.0)))[2].startswith("right foot: 25 samples a second")


def test_a_clock_that_runs_away_is_told() -> None:
    fast = (s._replace(device_ns=round(s.device_ns * 1.002)) for s in stream(60.0))
    recent, light, reason = seen(watched(fast))
    assert recent.drift_ppm == pytest.approx(2000.0, abs=5.0)
    assert light is Light.AMBER
    assert "0.2 % too fast" in reason


def test_only_standing_tells_gravity() -> None:
    monitor = Monitor(FixedClock())
    for sample in stream(20.0):
        monitor.add(sample._replace(specific_force_b=(0.0, 0.0, -30.0)), True, GaitPhase.SWING)
    recent = monitor.recent(0.0, live=True)
    assert recent.stance_mps2 is recent.gravity_mps2 is None


def test_each_stance_tells_its_stillest_moment() -> None:
    """Half a second of swing that shakes by 20 m/s², half a second of stance that begins with a thud."""
    monitor = Monitor(FixedClock())
    for s in stream(20.0):
        part = s.seq % 100
        shake = 20.0 * (-1) ** s.seq if part < 50 else 8.0 * (-1) ** s.seq if part < 60 else 0.0
        phase = GaitPhase.SWING if part < 50 else GaitPhase.STANCE
        monitor.add(s._replace(specific_force_b=(0.0, 0.0, -G - shake)), True, phase)
    recent = monitor.recent(0.0, live=True)
    assert recent.gravity_mps2 == pytest.approx(G, abs=0.1)
    assert recent.stance_mps2 is not None
    assert recent.stance_mps2 < 1.5


def test_memory_does_not_grow() -> None:
    monitor = watched(stream(200.0))
    assert len(monitor._bins) == BINS
    assert all(a.second + 1 == b.second for a, b in pairwise(monitor._bins))


def test_the_report_is_json() -> None:
    recent, light, reason = seen(watched(stream(5.0)))
    told = report({"right": Health(100.0, 500, {"repeated time": 2}, 0, 1, recent, light, reason)})
    assert json.loads(json.dumps(told))["right"]["last_10_s"]["samples"] == 500


@pytest.mark.parametrize(
    ("share", "told"),
    [(0.0035, "0.35 %"), (0.03, "3 %"), (0.0994, "9.9 %"), (0.0996, "10 %"), (1.0, "100 %")],
)
def test_a_share_is_told_in_percent(share: float, told: str) -> None:
    assert percent(share) == told


#: A sound sensor's last ten seconds.
GOOD = Recent(
    rate_hz=100.0, samples=1000, lost=0, duplicated=0, rejected=0, saturated=0, jitter_ms=0.1, late_ms=1.0,
    stance_mps2=0.1, gravity_mps2=9.81, disturbance=0.02, drift_ppm=10.0, silent_s=0.0,
)  # fmt: skip
NO_LIGHT = (Light.GREEN, None)


@pytest.mark.parametrize(
    ("what", "value", "light", "said"),
    [
        ("silent_s", 0.5, *NO_LIGHT),
        ("silent_s", 0.6, Light.RED, "silent for 0.6 s"),
        ("cut_s", 0.4, Light.AMBER, "nothing came from it for 0.4 s"),
        ("lost", 10, *NO_LIGHT),
        ("lost", 11, Light.AMBER, "1.1 % of samples lost"),
        ("lost", 52, Light.AMBER, "4.9 % of samples lost"),
        ("lost", 53, Light.RED, "5 % of samples lost"),
        ("late_ms", 99.9, *NO_LIGHT),
        ("late_ms", 100.0, Light.AMBER, "up to 100 ms late"),
        ("late_ms", 499.9, Light.AMBER, "up to 500 ms late"),
        ("late_ms", 500.0, Light.RED, "up to 500 ms late"),
        ("rejected", 10, *NO_LIGHT),
        ("rejected", 11, Light.AMBER, "1.1 % of samples are no use"),
        ("rejected", 112, Light.RED, "10 % of samples are no use"),
        ("duplicated", 11, Light.AMBER, "1.1 % of samples came twice"),
        ("duplicated", 112, Light.RED, "10 % of samples came twice"),
        ("rate_hz", 50.0, *NO_LIGHT),
        ("rate_hz", 49.0, Light.AMBER, "49 samples a second: set the sensor to 50 or more"),
        ("rate_hz", 0.0, *NO_LIGHT),
        ("drift_ppm", 500.0, *NO_LIGHT),
        ("drift_ppm", 501.0, Light.AMBER, "0.05 % too fast"),
        ("drift_ppm", -2000.0, Light.AMBER, "0.2 % too slow"),
        ("saturated", 19, *NO_LIGHT),
        ("saturated", 20, Light.AMBER, "2 % of samples at the end"),
        ("saturated", 100, Light.RED, "10 % of samples at the end"),
        ("stance_mps2", 1.4, *NO_LIGHT),
        ("stance_mps2", 1.5, Light.AMBER, "shakes by 1.5 m/s²"),
        ("stance_mps2", 4.0, Light.RED, "shakes by 4.0 m/s²"),
        ("gravity_mps2", 10.15, *NO_LIGHT),
        ("gravity_mps2", 10.16, Light.AMBER, "gravity reads 10.16 m/s²"),
        ("gravity_mps2", 9.45, Light.AMBER, "gravity reads 9.45 m/s²"),
        ("disturbance", 0.2, *NO_LIGHT),
        ("disturbance", 0.25, Light.AMBER, "strays by 25 %"),
    ],
)
def test_each_limit_has_its_light_and_its_figure(
    what: str, value: float, light: Light, said: str | None
) -> None:
    got, reason = judge(Role.LEFT, Recent(**GOOD._asdict() | {what: value}), uses_field=True)
    assert got is light
    assert reason == "" if said is None else reason.startswith("left foot: ") and said in reason
