"""The town mode as its user runs it: a process, real sockets, one line for every mistake."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Browser
from pythonosc.osc_message import OscMessage

from app.commands.mover import wall_of
from app.door.access import Access
from app.gestures.packet import decode
from app.motion.basics import InputError, MotionId
from app.shell.mover import Options, addresses, demand_two_ports
from tests.refusals import refused
from tests.scene.pages import PATIENCE_MS

ROOT = Path(__file__).parent.parent.parent
PATIENCE_S = 240.0


@contextmanager
def mover(*arguments: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """The program and its address."""
    command = [sys.executable, "-m", "app", "mover", "--no-open", "--port", "0", *arguments]
    program = subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": str(ROOT)}
    )
    assert program.stdout
    try:
        line = program.stdout.readline()
        yield program, line.split(" at ")[1].split()[0]
    finally:
        program.send_signal(signal.SIGINT)
        assert program.wait(timeout=60) == 0


@contextmanager
def ear() -> Iterator[tuple[socket.socket, str]]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as made:
        made.bind(("127.0.0.1", 0))
        made.settimeout(PATIENCE_S)
        yield made, f"127.0.0.1:{made.getsockname()[1]}"


@pytest.mark.timeout(400)
def test_packets_and_axes_leave_while_simulated_feet_walk_and_end_in_zeros() -> None:
    with ear() as (packets, udp), ear() as (axes, osc):
        with mover("--udp", udp, "--osc", osc):
            end, seen = time.monotonic() + PATIENCE_S, set()
            while MotionId.FORWARD not in seen and time.monotonic() < end:
                motion, speed = decode(packets.recv(64))
                seen.add(motion)
                assert 0.0 <= speed <= 3.0
            assert MotionId.FORWARD in seen
        packets.settimeout(0.3)
        axes.settimeout(0.3)
        assert decode(last(packets)[-1]) == (MotionId.NONE, 0.0)
        told = [OscMessage(data) for data in last(axes)]
        assert any(m.address == "/input/Vertical" and m.params[0] > 0.1 for m in told)
        for address in ("/input/Vertical", "/input/Horizontal", "/input/LookHorizontal"):
            assert [m.params[0] for m in told if m.address == address][-1] == 0.0


def last(socket_: socket.socket) -> list[bytes]:
    found = []
    while True:
        try:
            found.append(socket_.recv(2048))
        except TimeoutError:
            return found


@pytest.mark.timeout(400)
def test_arrow_keys_in_a_real_browser_walk_the_town_to_a_target(browser: Browser, build_dir: Path) -> None:
    """Simulated feet stroll to the first target; then a person takes the keys."""
    with mover("--kiosk", "--source", "sim:gestures?cadence=1.9") as (_, address):  # brisk: it is a way
        page = browser.new_page(viewport={"width": 480, "height": 270})
        page.set_default_timeout(PATIENCE_MS)
        page.goto(f"{address}/?fixedDpr=1")
        score = "(n) => (document.querySelector('.mv-score')?.textContent ?? '').startsWith(n)"
        page.wait_for_function(score, arg="1 of 8", timeout=PATIENCE_MS)
        page.screenshot(path=build_dir / "mover_found.png", timeout=PATIENCE_MS)
        motion = "(words) => document.querySelector('.mv-motion').textContent.startsWith(words)"
        page.keyboard.down("ArrowLeft")
        page.wait_for_function(motion, arg="turning left", timeout=PATIENCE_MS)
        page.keyboard.up("ArrowLeft")
        page.wait_for_function(motion, arg="standing", timeout=PATIENCE_MS)
        page.evaluate("() => document.body.appendChild(document.createElement('input')).focus()")
        page.keyboard.press("Escape")  # while the hand is in a field
        page.wait_for_function(motion, arg="stopped", timeout=PATIENCE_MS)
        page.evaluate("() => document.activeElement.blur()")
        page.keyboard.press("f")
        page.wait_for_function("() => document.fullscreenElement", timeout=PATIENCE_MS)
        page.keyboard.press(" ")
        page.wait_for_function(motion, arg="standing", timeout=PATIENCE_MS)
        page.evaluate("() => document.exitFullscreen()")  # as Esc does, of which the page hears no key
        page.wait_for_function(motion, arg="stopped", timeout=PATIENCE_MS)
        page.close()


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--wall", "12"], "--wall"),
        (["--left", "sim:gestures"], "both --left and --right"),
        (["--source", "sim:gestures?cadence=99"], "cadence"),
        (["--osc", "nowhere"], "--osc"),
        (["--source", "no-such-file.csv"], "no such file"),
        (["--source", "sim:walk?feet=1&strides=2"], "expected the sensors left and right"),
        (["--left", "sim:walk?feet=2&strides=2", "--right", "ws:0"], "--left"),
    ],
)
def test_mistakes_are_one_line(arguments: list[str], word: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert word in refused(capsys, "mover", "--no-open", "--port", "0", *arguments)


def test_two_feet_are_two_ports(tmp_path: Path) -> None:
    port, alias = tmp_path / "port", tmp_path / "alias"
    port.touch()
    alias.symlink_to(port)
    demand_two_ports(f"serial:{port}", f"serial:{tmp_path / 'other'}")
    demand_two_ports("sim:gestures?script=none:1", "sim:gestures?script=none:1")
    with pytest.raises(InputError, match="a port for each foot"):
        demand_two_ports(f"serial:{port}", f"serial:{alias}?baud=9600")


@pytest.mark.parametrize("text", ["3", "x", "0x1", "3x", "3x1x1", "10x1"])
def test_a_wall_is_columns_by_rows(text: str) -> None:
    assert wall_of("3x1") == (3, 1)
    with pytest.raises(InputError, match="--wall"):
        wall_of(text)


def test_what_hangs_on_a_wall_moves_nothing() -> None:
    access = Access("0.0.0.0", 1, "to-operate", "to-watch")
    options = Options(None, None, None, "default", None, None, access, False, True, (3, 1))
    operator, *tiles = addresses("http://h:1/?token=to-operate", "http://h:1/?token=to-watch", options)
    assert operator.endswith("http://h:1/?token=to-operate&operator=1")
    assert [tile.partition("tile=")[2] for tile in tiles] == [
        f"{name}&fixedDpr=1" for name in ("left", "centre", "right")
    ]
    assert all("to-operate" not in tile for tile in tiles)
