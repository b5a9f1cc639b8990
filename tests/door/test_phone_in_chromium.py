"""The phone's page in a real Chromium with a made-up motion sensor: what it measures ends in a session."""

from __future__ import annotations

import asyncio
import itertools
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, BrowserContext, Page

from app.door.access import is_loopback
from app.door.addresses import reachable
from app.door.front import Door
from app.door.ingest import phone_address
from app.motion.basics import G_MPS2, role_of
from app.motion.samples import Sample
from app.session import Session
from app.settings import Settings
from app.sources.phone import PhoneSource
from app.sources.spec import parse_spec
from tests.conftest import PATIENCE_MS

#: A phone that lies still with its screen up, then swings about its x axis: events as a browser gives them.
SENSOR = """([sign, axis]) => {
    let count = 0;
    window.motion = setInterval(() => {
        count += 1;
        const g = {x: 0, y: 0, z: 0}, swings = count > 80;
        g[axis] = sign * 9.80665;
        window.dispatchEvent(new DeviceMotionEvent('devicemotion', {
            accelerationIncludingGravity: g, interval: 10,
            rotationRate: {alpha: swings ? 90 : 0, beta: swings ? 45 : 0, gamma: swings ? 9 : 0},
        }));
    }, 10);
}"""
IPHONE = """answer => {
    DeviceMotionEvent.requestPermission = async () => {
        if (!navigator.userActivation.isActive) throw new Error('not from a tap');
        return answer;
    };
}"""


@pytest.fixture
def phone(browser: Browser) -> Iterator[BrowserContext]:
    made = browser.new_context(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    made.set_default_timeout(PATIENCE_MS)
    yield made
    made.close()


@pytest.fixture
def source() -> PhoneSource:
    return PhoneSource(parse_spec("phone:"))


def visit(phone: BrowserContext, house: Any) -> tuple[Page, list[str]]:
    page = phone.new_page()
    complaints: list[str] = []
    page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: complaints.append(error.message))
    page.goto(f"{house.origin}/phone")
    return page, complaints


def reading(source: PhoneSource, count: int) -> tuple[threading.Thread, list[Sample]]:
    """A thread that takes samples as a walk does, and what it has got."""
    got: list[Sample] = []

    async def fill() -> None:
        async with asyncio.timeout(60):
            async for item in source:
                assert isinstance(item, Sample)
                got.append(item)
                if len(got) >= count:
                    return

    thread = threading.Thread(target=lambda: asyncio.run(fill()))
    thread.start()
    return thread, got


def read(source: PhoneSource, count: int) -> list[Sample]:
    """The first samples."""
    thread, got = reading(source, count)
    thread.join()
    assert len(got) == count
    return got


def check_numbers(got: list[Sample]) -> None:
    assert [s.seq for s in got] == list(range(len(got)))
    assert all(a.device_ns < b.device_ns for a, b in itertools.pairwise(got))


@pytest.mark.parametrize("sign", [1, -1], ids=["android", "iphone"])
def test_a_phone_on_the_left_shoe_walks(
    phone: BrowserContext, open_house: Callable[..., Any], source: PhoneSource, sign: int
) -> None:
    house = open_house(taker=source)
    page, complaints = visit(phone, house)
    if sign < 0:
        page.evaluate(IPHONE, "granted")
    page.get_by_label("Left", exact=True).check()
    page.get_by_role("button").click()
    thread, got = reading(source, 300)
    page.evaluate(SENSOR, [sign, "z"])
    while len(got) < 200 and thread.is_alive():
        page.wait_for_timeout(50)
    page.evaluate("() => { const now = Date.now; Date.now = () => now() + 30_000; }")  # it was locked
    thread.join()
    check_numbers(got)
    gaps_s = [(b.device_ns - a.device_ns) * 1e-9 for a, b in itertools.pairwise(got)]
    assert sum(gap > 10.0 for gap in gaps_s) == 1, "a phone that slept goes on behind a gap"
    assert max(gaps_s) == pytest.approx(30.0, abs=10.0)
    session = Session(Settings(), role_of)
    for sample in got:
        session.take(sample)
    assert session.stores.keys() == {"left"}
    for sample in got:
        np.testing.assert_allclose(sample.specific_force_b, (0, 0, -G_MPS2), atol=1e-9)
    # screen up, top edge to the toe: the phone's y is the toe, its x the right side, its z up
    np.testing.assert_allclose(got[-1].angular_rate_b, np.radians([45, 90, -9]), atol=1e-9)
    page.get_by_text("Sending as the left foot").wait_for()
    page.get_by_role("button", name="Stop").click()
    page.get_by_text("Stopped").wait_for()
    assert complaints == []


def test_a_phone_on_the_right_side_of_the_shoe(
    phone: BrowserContext, open_house: Callable[..., Any], source: PhoneSource
) -> None:
    page, complaints = visit(phone, open_house(taker=source))
    page.get_by_label("Right", exact=True).check()
    page.get_by_label("On the right side").check()
    page.get_by_role("button").click()
    page.evaluate(SENSOR, [-1, "x"])  # its right edge is down
    got = read(source, 200)
    assert {s.sensor for s in got} == {"right"}
    np.testing.assert_allclose(got[-1].specific_force_b, (0, 0, -G_MPS2), atol=1e-9)
    np.testing.assert_allclose(got[-1].angular_rate_b, np.radians([45, 9, 90]), atol=1e-9)
    assert complaints == []


def test_a_phone_that_sits_otherwise_is_told_and_sends_nothing(
    phone: BrowserContext, open_house: Callable[..., Any], source: PhoneSource
) -> None:
    page, _ = visit(phone, open_house(taker=source))
    page.get_by_role("button").click()
    page.evaluate(SENSOR, [1, "y"])
    page.get_by_text("does not sit as chosen").wait_for()
    assert source.silent_s is None


def test_a_door_that_was_shut_for_a_while_costs_nothing(
    phone: BrowserContext,
    open_house: Callable[..., Any],
    source: PhoneSource,
    wait: Callable[[Callable[[], bool]], None],
) -> None:
    house = open_house(taker=source)
    page, _ = visit(phone, house)
    page.get_by_role("button").click()
    page.evaluate(SENSOR, [1, "z"])
    reader, got = reading(source, 500)
    wait(lambda: len(got) > 50)
    house.door.stop()
    page.get_by_text("kept and sent").wait_for()
    again = Door(
        replace(house.door.access, port=house.port),
        viser_port=house.viser.get_port(),
        rules=dict,
        health=dict,
        taker=source,
    )
    again.start()
    try:
        reader.join()
        assert len(got) == 500
        check_numbers(got)
        page.get_by_text("Sending as").wait_for()
    finally:
        again.stop()


def test_a_permission_that_was_refused_is_explained(
    phone: BrowserContext, open_house: Callable[..., Any], source: PhoneSource
) -> None:
    page, _ = visit(phone, open_house(taker=source))
    page.evaluate(IPHONE, "denied")
    page.get_by_role("button").click()
    page.get_by_text("Allow it").wait_for()


def test_a_computer_without_a_sensor_is_told(
    phone: BrowserContext, open_house: Callable[..., Any], source: PhoneSource
) -> None:
    page, _ = visit(phone, open_house(taker=source))
    page.get_by_role("button").click()
    page.get_by_text("No reading comes").wait_for()


def test_plain_http_from_another_machine_is_explained(
    phone: BrowserContext, open_house: Callable[..., Any], source: PhoneSource
) -> None:
    house = open_house(taker=source, host="0.0.0.0", operator="secret")
    if is_loopback(reachable("0.0.0.0")):
        pytest.skip("this machine has no address but loopback")
    page = phone.new_page()
    page.goto(phone_address(house.door.access))
    page.get_by_text("--tls-made").wait_for()
    assert page.get_by_role("button").is_disabled()
