"""sim:gestures against SciPy, against its own truth, and against Table 14."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.motion.basics import InputError, MotionId
from app.simulate.gestures import FEET, SimulatedGestures, make_gestures
from app.simulate.gestures_options import GESTURES
from app.sources.opening import open_recording
from app.sources.spec import parse_spec

EXACT = {"noise": "0", "drift": "0", "mounting": "0"}


@pytest.fixture(scope="module")
def random_bouts() -> SimulatedGestures:
    return make_gestures({"script": "random:32", "seed": "4"})


def test_velocity_acceleration_and_rate_are_those_of_position_and_orientation(
    random_bouts: SimulatedGestures,
) -> None:
    t, h = np.random.default_rng(1).uniform(0.0, 100.0, 4000), 1e-5
    for foot in random_bouts.feet.values():
        before, now, after = foot.at(t - h), foot.at(t), foot.at(t + h)
        velocity = (after.position_n - before.position_n) / (2 * h)
        np.testing.assert_allclose(velocity, now.velocity_n, atol=1e-4)
        acceleration = (after.velocity_n - before.velocity_n) / (2 * h)
        np.testing.assert_allclose(acceleration, now.acceleration_n, atol=0.2)
        turns = [Rotation.from_quat(m.q_nb[:, [1, 2, 3, 0]]) for m in (before, after)]
        rate = (turns[0].inv() * turns[1]).as_rotvec() / (2 * h)
        np.testing.assert_allclose(rate, now.angular_rate_b, atol=0.02)


def test_a_perfect_sensor_reads_force_and_rate_of_the_truth() -> None:
    made = make_gestures({"script": "none:1,forward_right:4,none:1", **EXACT})
    for samples in made.recording.sensors:
        motion = made.feet[samples.sensor].at(samples.matrix[:, 0] * 1e-9)
        np.testing.assert_allclose(samples.matrix[:, 4:7], motion.angular_rate_b, atol=1e-12)
        turn = Rotation.from_quat(motion.q_nb[:, [1, 2, 3, 0]])
        force = turn.inv().apply(motion.acceleration_n - [0.0, 0.0, 9.80665])
        np.testing.assert_allclose(samples.matrix[:, 1:4], force, atol=1e-9)


def test_feet_move_within_bouts_only_and_come_back(random_bouts: SimulatedGestures) -> None:
    t = random_bouts.recording.sensors[0].matrix[:, 0] * 1e-9
    resting = np.ones(len(t), np.bool_)
    for bout in random_bouts.bouts:
        resting &= (t < bout.onset_s) | (t > bout.end_s)
    assert resting.any()
    assert not resting.all()
    for foot in random_bouts.feet.values():
        motion = foot.at(t)
        assert np.abs(motion.velocity_n[resting]).max() < 1e-9
        assert np.abs(motion.angular_rate_b[resting]).max() < 1e-9
        assert np.abs(motion.position_n[resting]).max() < 1e-9


@pytest.mark.parametrize(
    ("gesture", "active"),
    [(g, FEET) for g in ("forward", "forward_right", "forward_left", "backward")]
    + [
        ("side_right", ("right",)),
        ("side_left", ("left",)),
        ("turn_cw", ("right",)),
        ("turn_ccw", ("left",)),
    ],
)
def test_each_gesture_moves_the_feet_of_table_14(gesture: str, active: tuple[str, ...]) -> None:
    made = make_gestures({"script": f"none:1,{gesture}:5,none:1", **EXACT})
    (bout,) = made.bouts
    assert bout.motion == MotionId[gesture.upper()]
    for samples in made.recording.sensors:
        moves = np.abs(samples.matrix[:, 4:7]).max() > 0.5
        assert moves == (samples.sensor in active)


def test_right_foot_twists_clockwise_and_left_foot_counter_clockwise() -> None:
    for gesture, foot, sign in (("turn_cw", "right", 1.0), ("turn_ccw", "left", -1.0)):
        made = make_gestures({"script": f"none:1,{gesture}:5", **EXACT})
        yaw = sign * made.feet[foot].channels["yaw"].at(np.linspace(0.0, 6.0, 600)).value
        assert yaw.max() > 0.3 > 0.1 > -yaw.min()


def test_marching_lifts_the_heel_first_and_stepping_back_the_toe() -> None:
    for gesture, sign in (("forward", -1.0), ("backward", 1.0)):
        made = make_gestures({"script": f"none:1,{gesture}:5", **EXACT})
        for foot in made.feet.values():
            pitch = foot.channels["pitch"]
            begin = pitch.start_s[np.abs(pitch.size) > 0.1].min()
            assert sign * pitch.at(np.array([begin + 0.1])).value[0] > 0.05


def test_the_bouts_say_the_cadence() -> None:
    made = make_gestures({"script": "none:1,forward:10", "cadence": "1.25", "vary": "0", "hesitation": "0"})
    assert made.bouts[0].cycle_s == pytest.approx(0.8, rel=1e-9)
    for foot in made.feet.values():
        lifts = np.unique(foot.channels["up"].start_s[foot.channels["up"].size > 0.05])
        np.testing.assert_allclose(np.diff(lifts), 0.8, atol=1e-9)


def test_pastimes_ask_for_nothing_but_move_the_feet() -> None:
    made = make_gestures({"script": "none:1,tap:10,shift:10", **EXACT})
    assert not made.bouts
    assert max(np.abs(s.matrix[:, 4:7]).max() for s in made.recording.sensors) > 0.3


def test_all_gestures_are_performed_equally_often(random_bouts: SimulatedGestures) -> None:
    counts = {m: sum(bout.motion == m for bout in random_bouts.bouts) for m in MotionId if m}
    assert counts == dict.fromkeys(counts, 4)
    assert len(counts) == len(GESTURES)


def test_nothing_is_the_same_twice(random_bouts: SimulatedGestures) -> None:
    cycles = [round(bout.cycle_s, 6) for bout in random_bouts.bouts]
    assert len(set(cycles)) == len(cycles)
    assert any(not bout.after_rest for bout in random_bouts.bouts)


def test_the_same_options_give_the_same_samples_and_another_seed_others() -> None:
    one, same, other = (make_gestures({"script": "random:2", "seed": s}).recording for s in ("1", "1", "2"))
    for a, b in zip(one.sensors, same.sensors, strict=True):
        np.testing.assert_array_equal(a.matrix, b.matrix)
    assert not np.array_equal(one.sensors[0].matrix[:50], other.sensors[0].matrix[:50])


def test_a_script_too_long_is_refused_and_a_foreign_sensor_too() -> None:
    with pytest.raises(InputError, match="shorter script"):
        make_gestures({"script": "none:36000", "rate": "2000"})
    with pytest.raises(ValueError, match="no sensor 'nose'"):
        make_gestures({"script": "none:1"}).truth("nose", np.zeros(1))


def test_what_would_change_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="vary"):
        make_gestures({"script": "none:1", "vary": "3"})


def test_a_spec_opens_it_with_its_truth() -> None:
    recording, truth = open_recording(parse_spec("sim:gestures?script=none:1,turn_cw:3&seed=2"))
    assert {samples.sensor for samples in recording.sensors} == set(FEET)
    assert truth is not None
    position, _ = truth("left", np.array([0.5]))
    np.testing.assert_array_equal(position, 0.0)
    again, _ = open_recording(parse_spec(str(recording.spec)))
    np.testing.assert_array_equal(again.sensors[0].matrix, recording.sensors[0].matrix)
