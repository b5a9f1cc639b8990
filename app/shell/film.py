"""Shell: a recording as one page that plays its walk offline: ``export --format html``."""

from __future__ import annotations

from pathlib import Path

from app.clocks import SAME, FixedClock
from app.motion.basics import InputError, role_of
from app.motion.recording import Recording
from app.motion.source import Truth
from app.outputs.files import write_new
from app.scene.share import film
from app.session import Session
from app.settings import Settings
from app.sources.opening import open_recording
from app.sources.spec import parse_spec
from app.sources.timeline import Timeline
from app.warm import warm_up

#: Frames a second of the film, and how many at most: a longer walk is played faster.
RATE_HZ = 20.0
MOST_FRAMES = 6000


def share(spec: str, settings: Settings, path: Path) -> Path:
    """Write the whole walk under these settings as an HTML file; one that exists is ``InputError``."""
    if path.exists():
        raise InputError(f"{path}: exists already, expected a new file")
    recording, truth = open_recording(parse_spec(spec))
    if not recording.sensors:
        raise InputError(f"{recording.name}: no sensor in it, expected a walk")
    warm_up(settings.estimator)
    write_new(path, _filmed(recording, truth, settings).encode())
    return path


def _filmed(recording: Recording, truth: Truth | None, settings: Settings) -> str:
    timeline = Timeline(recording)
    frames = timeline.duration_ns * 1e-9 * RATE_HZ
    pace = max(1.0, round(frames / MOST_FRAMES + 0.49))
    step_ns = int(1e9 * pace / RATE_HZ)
    roles = {samples.sensor: samples.role for samples in recording.sensors}
    session = Session(
        settings,
        lambda sensor: roles.get(sensor) or role_of(sensor),
        truth,
        clock=lambda sensor: FixedClock(recording.clocks.get(sensor, SAME)),
        rod_m=recording.rod_m,
    )
    taken = 0
    with film(recording.name, pace) as made:
        for elapsed_ns in range(0, timeline.duration_ns + step_ns, step_ns):
            taken = _go_on(session, timeline, taken, timeline.due(elapsed_ns))
            made.take(session.snapshot(), 1.0 / RATE_HZ)
        return made.page()


def _go_on(session: Session, timeline: Timeline, taken: int, due: int) -> int:
    while taken < due:
        end = min(due, timeline.block_end(taken))
        session.take_stretch(timeline.stretch(taken, end, 0))
        taken = end
    return taken
