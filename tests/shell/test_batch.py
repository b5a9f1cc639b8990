"""``process``: the same steps as live, told with every key that scripts rely on."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest

from app.motion.estimate import Trust
from app.motion.recording import Recording
from app.motion.samples import ClockLine
from app.session import Session
from app.settings import BUILT_IN, Settings
from app.shell import batch
from app.simulate.gestures import make_gestures
from tests.estimator.walks import PAPERS, estimate, foot, one_by_one, rows_of, walk
from tests.sessions import fed, main_rows

KEYS = {"recording", "samples", "dropped_rows", "duration_s", "rate_hz", "estimator_s", "settings", "feet"}
FOOT_KEYS = {
    "strides", "distance_m", "end_ned_m", "closure_m", "closure_pct", "height_range_m", "stance_fraction",
}  # fmt: skip


def test_the_summary_has_every_key_and_the_trackers_figures() -> None:
    told = batch.summary(batch.process("sim:walk?path=eight&rate_hz=50&noise=1", PAPERS))
    assert set(told) >= KEYS
    samples = foot("path=eight&rate_hz=50&noise=1")
    tracker = estimate(samples)
    rows = rows_of(tracker)
    assert told["samples"] == len(samples)
    assert told["rate_hz"] == pytest.approx(50.0)
    assert told["duration_s"] == pytest.approx((len(samples) - 1) / 50.0)
    feet = told["feet"]
    assert isinstance(feet, dict)
    figures = feet["foot"]
    assert set(figures) >= FOOT_KEYS
    assert figures["strides"] == tracker.stride_count
    assert figures["distance_m"] == tracker.distance_m == sum(s.length_m for s in tracker.strides)
    assert figures["end_ned_m"] == rows[-1, :3].tolist()
    assert figures["closure_m"] == math.hypot(*figures["end_ned_m"][:2])
    assert figures["closure_pct"] == 100 * figures["closure_m"] / figures["distance_m"]
    assert figures["height_range_m"] == rows[:, 2].max() - rows[:, 2].min()
    assert figures["stance_fraction"] == (rows[:, 10] == 0).mean()
    json.dumps(told, allow_nan=False)


def test_a_foot_that_stood_has_no_percentage() -> None:
    tracker = estimate(foot("strides=1&still_s=5"), threshold_radps=20.0)
    assert tracker.distance_m == 0.0
    assert batch.foot_summary(tracker)["closure_pct"] is None


def test_how_sure_the_filter_is_stands_in_the_summary_and_in_words() -> None:
    walk = foot("strides=12&noise=1")
    half = walk.matrix.copy()
    half[:, 4:7] *= 0.5  # as of a sensor whose range is not what it is said to be
    for samples, word in ((walk, "good"), (replace(walk, matrix=half), "lost")):
        done = batch.estimate(Recording("walk", "made", (samples,)), BUILT_IN["default"])
        (tracker,) = done.trackers.values()
        told = batch.foot_summary(tracker)["trust"]
        sure = tracker.trust
        assert sure is not None
        assert told == {"word": word, "why": sure.why, "within_m": [sure.major_m, sure.minor_m]}
        assert f", {word}" in batch.lines(done)[-1]
    assert batch.sureness(None) is None
    assert batch.sureness(Trust(math.inf, 1.0, 0.0, "lost", "no stance for 3 s"))["within_m"] is None  # type: ignore[index]


def test_process_is_the_live_session_to_the_bit() -> None:
    done = batch.process("sim:walk?feet=2&strides=10&noise=1", PAPERS)
    samples = [s for sensor in done.recording.sensors for s in one_by_one(sensor)]
    session = fed(Session(PAPERS), sorted(samples, key=lambda s: s.device_ns))
    for sensor in ("left", "right"):
        assert rows_of(done.trackers[sensor]).tobytes() == main_rows(session, sensor).tobytes()


def test_settings_are_all_told() -> None:
    chosen = Settings(gain_stance=2.0, magnetometer=True)
    told = batch.summary(batch.process("sim:walk?strides=2", chosen))["settings"]
    assert isinstance(told, dict)
    assert Settings(**told) == chosen


def test_the_lines_for_a_person_name_each_foot() -> None:
    text = "\n".join(batch.lines(batch.process("sim:walk?feet=2&strides=4", PAPERS)))
    assert "left: 5 strides" in text
    assert "right: 4 strides" in text


def test_what_was_not_taken_is_told_with_its_reason() -> None:
    """Of a file that runs backward one row is left: without the reason that is a riddle."""
    (left,) = walk("feet=1&strides=2").recording.sensors
    one = replace(left, matrix=left.matrix[:1], dropped={"time went backward": 499, "repeated time": 0})
    done = batch.estimate(Recording("back.csv", "x", (one,), dropped_rows=499), PAPERS)
    assert batch.lines(done)[0].endswith("499 rows dropped (499 time went backward)")


def test_a_profile_for_hindsight_under_the_papers_estimator_is_the_papers_estimate() -> None:
    recording = walk("feet=2&strides=8").recording
    plain = batch.estimate(recording, BUILT_IN["papers"])
    asked = batch.estimate(recording, BUILT_IN["hindsight"].with_changes({"estimator": "papers"}))
    assert not asked.linked
    for sensor, tracker in plain.trackers.items():
        assert rows_of(asked.trackers[sensor]).tobytes() == rows_of(tracker).tobytes()


def test_times_are_the_recordings_whatever_the_sensors_clocks_show(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two sensors have been switched on at different times: their own clocks have nothing in common."""
    made = make_gestures({"script": "none:2,forward:4"}).recording
    apart = tuple(replace(s, device_ns=k * 10**15) for k, s in enumerate(made.sensors))
    lines = {s.sensor: ClockLine(s.device_ns, 5_000_000_000) for s in apart}
    told = []
    for recording in (made, replace(made, sensors=apart, clocks=lines)):
        monkeypatch.setattr(batch, "open_recording", lambda spec, found=recording: (found, None))
        feet = batch.foot_tables(batch.process("walk", PAPERS))
        asked = batch.gestures_summary(batch.decode_gestures("walk", "default"))
        told.append(([foot.t_s.tolist() for foot in feet], asked))
    assert told[0] == told[1]
