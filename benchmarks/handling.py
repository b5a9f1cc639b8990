"""Benchmarks: rough handling: pause, seek, speed, sliders, apply, undo in any order; then the walk's end."""

from __future__ import annotations

import random
import time
from typing import Any, NamedTuple

from app.estimator.tracker import track
from app.motion.estimate import POSITION
from app.settings import Settings
from app.sources.opening import open_recording
from app.sources.spec import parse_spec
from benchmarks.client import Client, backlog, controls, deaf, health, messages
from benchmarks.figures import Figure, Section
from benchmarks.hour import MB
from benchmarks.processes import first_line, free_port, rss_bytes, running
from benchmarks.start import wait_for_samples

WALK = "sim:walk?path=oval&rate_hz=100&duration_s=300&noise=1"
EVERY_S = 0.25
RANGES = {"Position": (0.0, 290.0), "Stance gain": (0.1, 2.9), "Speed": (1.0, 8.0)}
PRESSES = ("Apply", "Undo", "Drop", "Swap", "Keep as A", "Keep as B", "Step")


class Handled(NamedTuple):
    """After it all: how often, where the shoe ended, memory before and after, and whether it lived."""

    moves: int
    end: tuple[float, ...]
    rss: tuple[int, int]
    status: str
    longest_gap_s: float


def handling(clock_s: float) -> Section:
    """However it was handled, the walk's end is the batch's end to the bit; memory is that of the walk."""
    done = handle(clock_s)
    end = batch_end()
    away = max(abs(a - b) for a, b in zip(done.end, end, strict=True))
    yield Figure("moves of a person in a hurry", done.moves)
    yield Figure("replay ended, as it should", float(done.status == "ended"), "", 1, True, note=done.status)
    yield Figure("the shoe's end away from the batch's", away, "m", 0.0)
    yield Figure("resident memory grew by", (done.rss[1] - done.rss[0]) / MB, "MB", 80.0)
    yield Figure("longest wait of the reading client", done.longest_gap_s, "s", 1.5)


def batch_end() -> tuple[float, ...]:
    """Where the walk ends by ``track``."""
    recording, _ = open_recording(parse_spec(WALK))
    tracker = track(recording.sensors[0], Settings())
    return tuple(tracker.rows.table(tracker.rows.end - 1, tracker.rows.end)[0, POSITION].tolist())


def handle(clock_s: float) -> Handled:
    """Do what can be done, at random but the same each time."""
    port, chance = free_port(), random.Random(2)
    with running(
        "app", "walk", "--profile", "papers", "--source", f"{WALK}&speed=8", "--no-open", "--port", str(port)
    ) as viewer:
        first_line(viewer)
        wait_for_samples(port, 2000)
        silent, client = deaf(port), Client(port)
        seen = backlog(client, 3.0)
        before = rss_bytes(viewer.pid)
        person = Person(client, controls(seen), chance)
        moves, gap_s, last = 0, 0.0, time.monotonic()
        end = time.monotonic() + clock_s
        while time.monotonic() < end:
            person.move()
            moves += 1
            for frame in client.frames(EVERY_S):
                gap_s, last = max(gap_s, frame.at_ns * 1e-9 - last), frame.at_ns * 1e-9
        person.calm_down()
        place, status = rest(client, port)
        after = rss_bytes(viewer.pid)
        client.close()
        silent.close()
    return Handled(moves, place, (before, after), status, gap_s)


def rest(client: Client, port: int) -> tuple[tuple[float, ...], str]:
    """Where the shoe is once the replay has ended."""
    place: tuple[float, ...] = ()
    end = time.monotonic() + 60.0
    quiet_from = time.monotonic()
    status = ""
    while time.monotonic() < end:
        for frame in client.frames(0.5):
            found = [m["position"] for m in messages(frame.data) if is_shoe(m)]
            if found:
                place, quiet_from = tuple(found[-1]), time.monotonic()
        status = str(health(port)["link"])
        if status == "ended" and time.monotonic() > quiet_from + 3.0:
            break
    return place, status


def is_shoe(message: dict[str, Any]) -> bool:
    """Whether a message says where the shoe is."""
    return message.get("name") == "/ned/foot" and "position" in message


class Person:
    """Writes into the page's controls, by their labels."""

    def __init__(self, client: Client, labels: dict[str, str], chance: random.Random) -> None:
        self._client, self._labels, self._chance = client, labels, chance

    def move(self) -> None:
        """One thing at random."""
        kinds = ("Position", "Position", "Stance gain", "Stance gain", "Speed", "Pause", "Play", *PRESSES)
        kind = self._chance.choice(kinds)
        if kind in RANGES:
            self._set(kind, round(self._chance.uniform(*RANGES[kind]), 1))
        else:
            self._press(kind)

    def calm_down(self) -> None:
        """The settings as they were, and on to the end."""
        self._press("Reset all sliders")
        self._press("Apply")
        self._set("Speed", 0.0)
        self._press("Play")

    def _set(self, label: str, value: float) -> None:
        control = next(uuid for name, uuid in self._labels.items() if name.startswith(label))
        self._client.write(control, value)

    def _press(self, button: str) -> None:
        self._client.write(self._labels[button], button)
