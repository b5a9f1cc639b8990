"""The laboratory: a replay whose samples are spoilt from the moment it is asked for."""

from __future__ import annotations

import asyncio
from dataclasses import asdict

import pytest

from app.motion.basics import InputError
from app.motion.commands import Pause, Seek, SetErrors
from app.motion.recording import Stretch
from app.motion.samples import Sample
from app.simulate.lab import LESSONS, PERFECT, lesson, pendulum
from app.sources.laboratory import Laboratory
from app.sources.opening import open_source
from app.sources.spec import parse_spec

SPEC = "sim:walk?distance_m=6&rate_hz=50&still_s=1"


def opened(spec: str = SPEC) -> Laboratory:
    source = open_source(f"{spec}&speed=0", finish=True, stretches=True)
    assert isinstance(source, Laboratory)
    return source


async def played(source: Laboratory, after: int | None = None, *commands: SetErrors) -> list[Sample]:
    """All samples; the commands come after so many of them."""
    found: list[Sample] = []
    async for item in source:
        assert isinstance(item, Sample)
        found.append(item)
        if len(found) == after:
            for command in commands:
                source.control(command)
    return found


def test_errors_begin_with_the_command() -> None:
    perfect = asyncio.run(played(opened()))
    spoilt = asyncio.run(played(opened(), 40, SetErrors((("force_bias_mps2", 0.5),))))
    assert len(spoilt) == len(perfect)
    moved = [a.specific_force_b[1] - b.specific_force_b[1] for a, b in zip(spoilt, perfect, strict=True)]
    assert moved[:40] == [0.0] * 40
    assert moved[40:] == pytest.approx([0.5] * len(moved[40:]))


def test_a_seek_passes_over_spoilt_samples_too() -> None:
    async def sought() -> list[Sample]:
        source = open_source("sim:walk?distance_m=60&rate_hz=50", stretches=True)
        source.control(SetErrors((("force_bias_mps2", 0.5),)))
        source.control(Seek(40.0))
        source.control(Pause(True))
        found: list[Sample] = []
        async for item in source:
            assert not isinstance(item, Stretch)
            if isinstance(item, Sample):
                found.append(item)
                if item.device_ns >= 39_900_000_000:
                    return found
        return found

    found = asyncio.run(asyncio.wait_for(sought(), 60))
    assert found[0].specific_force_b == pytest.approx((0.5, 0.5, 0.5 - 9.80665))
    assert len(found) > 1900


def test_bad_errors_are_refused_in_one_line() -> None:
    source = opened()
    for changes in ((("noise", -1.0),), (("noise", float("nan")),), (("colour", 1.0),)):
        with pytest.raises(InputError, match="expected"):
            source.control(SetErrors(changes))
    assert source.errors == asdict(PERFECT)


def test_a_recording_has_no_errors_to_set() -> None:
    source = open_source("replay:recordings/stairs.csv")
    assert source.errors is None
    with pytest.raises(InputError, match="simulated"):
        source.control(SetErrors((("noise", 1.0),)))


@pytest.mark.parametrize("name", [x.name for x in LESSONS])
def test_every_lesson_can_be_taken_and_says_two_sentences(name: str) -> None:
    source = opened()
    errors, settings = lesson(name)
    source.control(errors)
    assert settings.estimator == "papers"
    (taken,) = (x for x in LESSONS if x.name == name)
    assert source.errors == dict(errors.changes)
    assert taken.notice.count(". ") == 1
    assert taken.notice.endswith(".")


def test_an_unknown_lesson_is_refused() -> None:
    with pytest.raises(InputError, match="expected one of Perfect"):
        lesson("Cooking")


def test_the_pendulums_spec_opens() -> None:
    source = opened(pendulum(-12.5))
    assert source.info.rod_m == 1.0
    assert parse_spec(pendulum(-12.5)).options == {"start_deg": "-12.5"}
