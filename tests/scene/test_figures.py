from __future__ import annotations

import math
from dataclasses import replace

import pytest

from app.motion.basics import GaitPhase
from app.motion.estimate import Compass, Toe, Trust
from app.motion.snapshot import Change, Snapshot
from app.motion.source import Link
from app.motion.status import Status
from app.scene import figures, words
from app.settings import Settings
from tests.scene import fakes
from tests.scene.test_words import read

EVIL = '<img src=x onerror="document.title=1">](javascript:x) **b**'
OURS = {"div", "span", "b", "i", "small", "label", "table", "tr", "th", "td", "ul", "li"}


def everything(snapshot: Snapshot, status: Status) -> str:
    return "".join((
        figures.header(status), figures.message(snapshot, status), figures.feet(snapshot),
        figures.source(snapshot, status), figures.log(snapshot, 100.0), figures.position(status),
        figures.comparison(snapshot), figures.slots(snapshot),
    ))  # fmt: skip


def test_no_users_text_is_markup() -> None:
    snapshot = fakes.snapshot(9.7, candidate=True)
    status = fakes.status(message=EVIL)
    source = replace(status.source, name=EVIL, format=EVIL, assumed=(EVIL,), dropped={EVIL: 1})
    health = {EVIL: next(iter(snapshot.health.values()))._replace(dropped={EVIL: 2})}
    snapshot = replace(snapshot, health=health, changes=(Change(1, 0, EVIL, EVIL),))
    parsed = read(everything(snapshot, replace(status, source=source)))
    assert set(parsed.tags) <= OURS
    assert EVIL in parsed.text


@pytest.mark.parametrize(("phase", "word"), [(GaitPhase.STANCE, "STANCE"), (GaitPhase.SWING, "SWING")])
def test_the_phase_is_a_word_a_shape_and_a_colour(phase: GaitPhase, word: str) -> None:
    badge = figures.badge(fakes.foot(3.0)._replace(phase=phase))
    assert word in badge
    assert f"ss-{word.lower()}" in badge
    assert ("▬" in badge) == (phase is GaitPhase.STANCE)


def test_before_the_still_start_is_found() -> None:
    assert "STAND STILL" in figures.badge(fakes.foot(0.0)._replace(levelled=False))


def test_stale_is_said_after_half_a_second() -> None:
    assert "STALE" not in figures.header(fakes.status(stale_s=0.4))
    assert "STALE <b>3.2 s</b>" in figures.header(fakes.status(stale_s=3.2))
    assert "STALE" not in figures.header(fakes.status(stale_s=9.0, link=Link.ENDED))


def test_the_state_of_the_link_is_told_in_words() -> None:
    shown = figures.header(fakes.status(link=Link.LOST, detail="COM3 <gone>: trying again in 2 s"))
    assert "connection lost" in shown
    assert "COM3 &lt;gone&gt;: trying again in 2 s" in shown


def test_a_pose_that_is_no_number_is_said() -> None:
    snapshot = fakes.snapshot(5.0)
    lost = snapshot.main.feet[0]._replace(position_n=(math.nan, 0.0, 0.0))
    snapshot = replace(snapshot, main=snapshot.main._replace(feet=(lost,)))
    assert "not a finite number" in figures.message(snapshot, fakes.status())


def test_every_figure_has_its_unit() -> None:
    text = read(figures.feet(fakes.snapshot(9.7))).text
    for said in ("Strides8", "10.80 m", "m/s", "steps/min", "98.3 %", "0.12 m"):
        assert said in text


def test_two_feet_are_said_not_to_be_linked() -> None:
    two = fakes.snapshot(9.7, two=True)
    assert "not linked" in figures.feet(two)
    linked = figures.feet(replace(two, main=two.main._replace(linked=True)))
    assert "not linked" not in linked
    assert "Feet linked" in linked
    assert "not linked" not in figures.feet(fakes.snapshot(9.7))


def test_a_sensor_tells_how_warm_it_is_and_was() -> None:
    snapshot = fakes.snapshot(9.7)
    sensor = snapshot.main.feet[0].sensor
    assert "°C" not in figures.feet(snapshot)
    assert "Sensor at 31 °C." in figures.feet(snapshot, warmth={sensor: 31.2})
    known = replace(snapshot, remembered={sensor: "from 3 Nov 2026 at 24 °C"})
    told = "Gyro bias remembered from 3 Nov 2026 at 24 °C"
    assert f"{told}; now 31 °C." in figures.feet(known, warmth={sensor: 31.2})
    assert f"{told}." in figures.feet(known)
    assert "<img" not in figures.feet(replace(snapshot, remembered={sensor: EVIL}))


def test_the_difference_is_the_candidates_minus_the_mains() -> None:
    snapshot = fakes.snapshot(12.9, candidate=True)
    assert snapshot.candidate is not None
    main, other = snapshot.main.feet[0], snapshot.candidate.feet[0]
    text = read(figures.comparison(snapshot)).text
    assert words.signed(other.to_start_m - main.to_start_m) + " m" in text
    assert "k_s 1.05 → 1.6 1/s" in text


def test_the_box_is_as_tall_without_a_candidate() -> None:
    """Else the slider under a hand would jump as its candidate appears."""
    rows = [figures.comparison(fakes.snapshot(5.0, candidate=c)).count("<tr>") for c in (False, True)]
    assert rows[0] == rows[1] > 3


def test_angles_are_told_in_degrees() -> None:
    one = Settings()
    assert figures.differences(one, replace(one, start_heading_rad=math.pi / 2)) == "ψ_0 0 → 90 °"
    assert figures.differences(one, replace(one, magnetometer=True)) == "Magnetometer on"


def test_the_log_has_the_newest_first_and_ends() -> None:
    changes = tuple(Change(i * 100, 0, "browser 1", f"change {i}") for i in range(50))
    text = read(figures.log(replace(fakes.snapshot(3.0), changes=changes), 100.0)).text
    assert text.index("change 49") < text.index("change 48")
    assert "change 30" not in text


def test_north_is_magnetic_only_with_the_magnetometer() -> None:
    snapshot = fakes.snapshot(3.0)
    assert "the start heading" in figures.source(snapshot, fakes.status())
    held = snapshot.main._replace(settings=Settings(magnetometer=True))
    assert "magnetic north" in figures.source(replace(snapshot, main=held), fakes.status())


def test_trust_is_a_distance_a_word_and_its_reason_or_nothing() -> None:
    walker = fakes.foot(3.0)
    assert figures.trust(walker) == ""
    lost = Trust(1.234, 0.5, 0.0, "lost", "no stance for 3 s")
    text = figures.trust(walker._replace(trust=lost))
    assert "± 1.23 m" in text
    assert "lost: no stance for 3 s" in text
    assert ":" not in figures.trust(walker._replace(trust=lost._replace(word="good", why="")))


def test_a_field_that_strays_is_said_with_what_of_it() -> None:
    snapshot = fakes.snapshot(9.7)
    (foot,) = snapshot.main.feet
    assert "Magnetic field" not in figures.feet(snapshot)
    assert "Magnetic field steady" in figures.compass(foot._replace(compass=Compass(True, "")))
    assert "strays by 12 %" in figures.compass(
        foot._replace(compass=Compass(False, "its dip strays by 12 %"))
    )


def test_how_a_sensor_sits_on_its_shoe_is_told() -> None:
    alone = fakes.snapshot(9.7)
    assert "Toe direction" not in figures.feet(alone)
    for degrees, how in ((87.2, "87° to the left"), (-18.0, "18° to the right"), (-178.0, "backward")):
        toe = Toe(math.radians(degrees), 5, (1.0, 0.0, 0.0, 0.0))
        feet = (alone.main.feet[0]._replace(toe=toe),)
        told = figures.feet(replace(alone, main=alone.main._replace(feet=feet)))
        assert "Toe direction found from 5 strides" in told
        assert how in told


def test_the_share_of_the_distance_is_that_of_the_last_footprint_also_in_a_swing() -> None:
    first = fakes.footprint(1, 0.0)._replace(position_n=(1.2, 0.0, 0.0))
    swinging = fakes.foot(2.0)._replace(
        position_n=(2.3, 0.0, -0.1), to_start_m=2.3, distance_m=1.2, footprints=(first,)
    )
    snapshot = fakes.snapshot(2.0)
    snapshot = replace(snapshot, main=snapshot.main._replace(feet=(swinging,)))
    assert "100.0 %" in read(figures.feet(snapshot)).text
