"""Benchmarks: ten minutes at 100 Hz estimated again after a slider moved, until a client has the ghost."""

from __future__ import annotations

import statistics
from collections.abc import Callable
from typing import Any

from app.estimator.tracker import store
from app.settings import LIMITS, Settings
from app.sources.opening import open_recording
from app.sources.spec import parse_spec
from app.tracks import Track
from benchmarks.client import Client, backlog, controls, messages
from benchmarks.cost import processor_s
from benchmarks.figures import Figure, Section
from benchmarks.processes import first_line, free_port, running
from benchmarks.start import wait_for_samples

TEN_MINUTES = "sim:walk?path=oval&rate_hz=100&duration_s=600&noise=1"
SAMPLES = 60_001
MOVES = 12
#: No message of the ghost for so long: all of it is there.
SILENCE_S = 0.5


def ghost() -> Section:
    """A real slider message through the door, and the last message of the ghost back through it."""
    port = free_port()
    with running(
        "app",
        "walk",
        "--profile",
        "papers",
        "--source",
        f"{TEN_MINUTES}&speed=0",
        "--no-open",
        "--port",
        str(port),
    ) as viewer:
        first_line(viewer)
        wait_for_samples(port, SAMPLES)
        client = Client(port)
        slider = controls(backlog(client, 3.0))[title()]
        waits = [move(client, slider, 0.5 + 0.05 * i) for i in range(MOVES)]
        client.close()
    note = f"{MOVES} moves, {SAMPLES} samples"
    yield Figure("slider → all of the ghost, median", statistics.median(waits), "ms", 150.0, note=note)
    yield Figure("  the best of them", min(waits), "ms")
    yield Figure("  the worst of them", max(waits), "ms")
    yield Figure("  of it the estimator's processor time", 1e3 * processor_s(reestimate_all()), "ms")


def title() -> str:
    """The stance gain's slider as the page labels it."""
    limit = LIMITS["gain_stance"]
    return f"{limit.label} {limit.symbol}, {limit.unit}"


def move(client: Client, slider: str, gain: float) -> float:
    """Milliseconds from the slider's message to the last message that draws the ghost."""
    sent_ns = client.write(slider, gain)
    last_ns, frame = None, None
    while True:
        frame = client.frame(SILENCE_S)
        if frame is not None and any(is_ghosts(message) for message in messages(frame.data)):
            last_ns = frame.at_ns
        elif last_ns is not None and (frame is None or frame.at_ns - last_ns > 1e9 * SILENCE_S):
            return (last_ns - sent_ns) * 1e-6
        elif last_ns is None and (frame is None or frame.at_ns - sent_ns > 10e9):
            raise TimeoutError("no ghost came")


def is_ghosts(message: dict[str, Any]) -> bool:
    """Whether a message draws the candidate."""
    name = str(message.get("name", ""))
    return "/ghost" in name or "_ghost" in name


def reestimate_all() -> Callable[[], None]:
    """The estimator's part of it, as the session hands it out."""
    recording, _ = open_recording(parse_spec(TEN_MINUTES))
    (samples,) = recording.sensors
    table, settings = store(samples), Settings().with_changes({"gain_stance": 0.7})
    return lambda: Track("again", settings).advance(samples.sensor, table)
