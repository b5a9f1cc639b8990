"""The whole program as its user meets it: a process, a port, a real Chromium, a second browser, Ctrl-C."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page

from tests.conftest import ROOT
from tests.refusals import refused
from tests.scene.pages import DRAWN, PATIENCE_MS, open_page, pixels

#: A walk of a minute; drawn small, because a test machine has no graphics card.
SOURCE = "sim:walk?path=eight&size=6&duration=60&rate=100&still=1&noise=0.3"
POSITION = "() => Object.assign({}, window.__viserMutable.nodeRefFromName['/ned/foot'].position)"
HEIGHT_SHOWN = "() => Array.from(document.querySelectorAll('input')).some(i => i.value === '0.04')"
NODES = "() => Object.keys(window.__viserSceneTree.getState()).filter(name => name.startsWith('/ned'))"


def environment(tmp_path: Path) -> dict[str, str]:
    """A home of its own, so that no test sees another's profiles; compiled kernels are shared."""
    return {**os.environ, "XDG_CONFIG_HOME": str(tmp_path / "config")}


class Program:
    """``stridescope`` as a process."""

    def __init__(self, tmp_path: Path, *arguments: str, folder: Path = ROOT) -> None:
        self.port = free_port()
        command = [sys.executable, "-m", "app", "walk", "--no-open", "--port", str(self.port), *arguments]
        self.errors = tmp_path / "stderr.txt"
        with self.errors.open("w") as errors:
            self.process = subprocess.Popen(
                command,
                stdout=subprocess.PIPE,
                stderr=errors,
                text=True,
                env=environment(tmp_path) | {"PYTHONPATH": str(ROOT)},
                cwd=folder,
            )
        assert self.process.stdout is not None
        self.greeting = self.process.stdout.readline()
        self.address = f"http://127.0.0.1:{self.port}/"

    def health(self) -> dict[str, object]:
        with urllib.request.urlopen(f"{self.address}healthz", timeout=30) as answer:
            health: dict[str, object] = json.load(answer)
        return health

    def end(self, number: int = signal.SIGINT) -> int:
        self.process.send_signal(number)
        return self.process.wait(timeout=60)


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Program]:
    running = Program(tmp_path_factory.mktemp("program"), "--source", f"{SOURCE}&loop=1")
    yield running
    assert running.end() == 0
    assert "Traceback" not in running.errors.read_text()


@pytest.fixture(scope="module")
def page(browser: Browser, program: Program) -> Iterator[Page]:
    opened = open_page(browser, program.address, (900, 600))
    yield opened
    opened.close()


def test_it_says_where_it_is(program: Program) -> None:
    assert program.address.rstrip("/") in program.greeting
    assert program.health()["ok"] is True


def test_a_shoe_walks_and_is_drawn(page: Page, build_dir: Path) -> None:
    before = page.evaluate(POSITION)
    page.wait_for_function(
        "before => { const p = window.__viserMutable.nodeRefFromName['/ned/foot'].position;"
        " return Math.hypot(p.x - before.x, p.y - before.y, p.z - before.z) > 0.3 }",
        arg=before,
        timeout=PATIENCE_MS,
    )
    page.screenshot(path=str(build_dir / "walk.png"))
    blue = sum(b > r + 60 and b > 100 for r, _, b in pixels(page))
    assert blue > 20, "no pixel of the blue shoe or its trail on the page"


def test_the_phase_flips_by_word(page: Page) -> None:
    for word in ("STANCE", "SWING"):
        page.wait_for_function(f"() => document.body.innerText.includes('{word}')", timeout=PATIENCE_MS)


def test_strides_are_counted_while_it_walks(page: Page) -> None:
    strides = "() => Number((document.body.innerText.match(/Strides\\s+(\\d+)/) || [0, -1])[1])"
    page.wait_for_function(f"() => ({strides})() >= 2", timeout=PATIENCE_MS)


def move_slider(page: Page, label: str, value: str) -> None:
    """Type a value into a slider's number field, as a person does."""
    field = (
        page.get_by_text(re.compile(label))
        .first.locator("xpath=ancestor::*[.//input][1]")
        .locator("input")
        .last
    )
    field.fill(value)
    field.press("Enter")
    field.blur()


def test_a_slider_makes_a_ghost_that_both_browsers_see(
    browser: Browser, program: Program, page: Page
) -> None:
    second = open_page(browser, program.address, (900, 600))
    try:
        move_slider(page, "Sensor height", "0.04")
        for seen in (page, second):
            seen.wait_for_function(HEIGHT_SHOWN, timeout=PATIENCE_MS)
            seen.wait_for_function(
                f"() => ({NODES})().some(name => name.startsWith('/ned/ghost/'))", timeout=PATIENCE_MS
            )
        second.get_by_role("button", name="Apply", exact=True).click(timeout=PATIENCE_MS)
        for seen in (page, second):
            seen.wait_for_function(
                f"() => !({NODES})().some(name => name.startsWith('/ned/ghost/'))", timeout=PATIENCE_MS
            )
            assert seen.evaluate(HEIGHT_SHOWN), "after Apply the slider stays where it was moved"
    finally:
        second.close()


def test_a_reload_in_mid_walk_shows_the_present(page: Page) -> None:
    page.reload()
    page.wait_for_function(
        "() => /Strides\\s+[1-9]/.test(document.body.innerText)"
        " && window.__viserMutable.nodeRefFromName['/ned/foot']",
        timeout=PATIENCE_MS,
    )


def test_one_click_saves_what_is_seen_as_a_page_that_needs_no_network(
    browser: Browser, page: Page, tmp_path: Path, build_dir: Path
) -> None:
    page.get_by_text("Lab", exact=True).first.click()
    page.get_by_role("button", name="Gyro bias").click()
    page.get_by_text("The walk bends").wait_for(timeout=PATIENCE_MS)
    with page.expect_download(timeout=PATIENCE_MS) as coming:
        page.get_by_text("Save as one HTML file").click()
    kept = tmp_path / coming.value.suggested_filename
    coming.value.save_as(kept)
    assert kept.name.startswith("sim-walk-Gyro-bias-")
    context = browser.new_context(offline=True, viewport={"width": 1100, "height": 700})
    alone = context.new_page()
    alone.set_default_timeout(PATIENCE_MS)
    asked: list[str] = []
    alone.on("request", lambda r: asked.append(r.url) if r.url.startswith(("http", "ws")) else None)
    alone.goto(kept.as_uri())
    for node in ("/ned/foot", "/ned/trail/foot_truth/growing"):
        alone.wait_for_function(DRAWN, arg=node, timeout=PATIENCE_MS, polling=500)
    text = alone.locator("#sheet").inner_text()
    for said in ("The walk bends", "Error to truth", "0.5 °/s", "Minimum duration", "noise=0.3", "Seed"):
        assert said in text
    assert alone.locator("#sheet figure path.line").count() >= 3
    alone.screenshot(path=build_dir / "hand_in.png", timeout=PATIENCE_MS)
    context.close()
    assert asked == []


# --- without a browser ---------------------------------------------------------------------------------


def test_ctrl_c_ends_it_quietly(tmp_path: Path) -> None:
    program = Program(tmp_path, "--source", SOURCE)
    assert program.end(signal.SIGINT) == 0
    assert program.errors.read_text() == ""


def test_a_term_signal_ends_it_too(tmp_path: Path) -> None:
    assert Program(tmp_path, "--source", SOURCE).end(signal.SIGTERM) == 0


def test_a_taken_port_is_an_error(tmp_path: Path) -> None:
    """In a process of its own, as its user meets a mistake; the others are told in this one."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        done = subprocess.run(
            [sys.executable, "-m", "app", "walk", "--no-open", "--port", port, "--source", SOURCE],
            capture_output=True, text=True, timeout=250, env=environment(tmp_path), check=False,
        )  # fmt: skip
    assert done.returncode == 2, done.stderr
    assert port in done.stderr
    assert done.stderr.count("\n") == 1
    assert "Traceback" not in done.stderr


def test_on_another_host_tokens_are_made_and_told_once(tmp_path: Path) -> None:
    program = Program(tmp_path, "--source", SOURCE, "--host", "0.0.0.0")
    operator = program.greeting.split()[3]
    assert program.process.stdout is not None
    viewer = program.process.stdout.readline().split()[-1]
    assert re.fullmatch(r"http://[\d.]+:\d+/\?token=[\w-]{22}", operator)
    assert re.fullmatch(r"http://[\d.]+:\d+/\?token=[\w-]{22}", viewer)
    with pytest.raises(urllib.error.HTTPError, match="401"):
        urllib.request.urlopen(program.address, timeout=30)
    assert program.end() == 0
    assert "█" in program.process.stdout.read()
    assert program.errors.read_text() == ""


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--source", "no-such-file.csv"], "no-such-file.csv"),
        (["--source", "sim:walk?legs=3"], "legs"),
        (["--source", "serial:"], "serial"),
        (["--set", "gain_stance=99"], "gain_stance"),
        (["--set", "gain_stance"], "KEY=VALUE"),
        (["--profile", "nobody"], "nobody"),
        (["--port", "http"], "http"),
        (["--frobnicate"], "--frobnicate"),
    ],
)
def test_a_wrong_word_is_one_line(
    arguments: list[str], word: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:  # fmt: skip
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    assert word in refused(capsys, "walk", "--no-open", *arguments)
