"""Benchmarks: both gesture decoders on simulated bouts, whose truth is known (docs/gestures.md)."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from app.estimator.tracker import track
from app.gestures.default import DefaultDecoder
from app.gestures.merge import decode, readings
from app.gestures.papers import PapersDecoder
from app.gestures.words import Decision, Decoder
from app.motion.basics import Floats, MotionId, Role
from app.motion.estimate import ATTITUDE
from app.motion.samples import Samples
from app.settings import Settings
from app.simulate.gestures import Bout, SimulatedGestures, simulate
from app.simulate.gestures_options import GestureOptions
from benchmarks.figures import Figure, Section

BOUTS = 504
_FRAME_S = 0.01
_TWO_FEET = (MotionId.FORWARD, MotionId.FORWARD_RIGHT, MotionId.FORWARD_LEFT, MotionId.BACKWARD)
IDLE = ",".join(["none:20,shift:60,tap:40"] * 20)


class Score(NamedTuple):
    """One cell: figures over all bouts; times in s."""

    accuracy: float
    first: Floats  # first movement after the onset, bouts after a rest
    certain: Floats  # certain and right, two-foot gestures: beyond half a cycle
    certain_s: Floats  # the same from the onset
    stop_two: Floats
    stop_one: Floats  # in cycles
    cadence: Floats  # relative errors
    confusion: Mapping[tuple[int, int], int]  # frames


def gestures() -> Section:
    """All cells, both decoders."""
    cells = {
        "nominal": GestureOptions(script=f"random:{BOUTS}", seed=11),
        "0.6 Hz": GestureOptions(script=f"random:{BOUTS}", seed=12, cadence_hz=0.6),
        "amplitude × 0.3": GestureOptions(script=f"random:{BOUTS}", seed=13, amplitude=0.3),
        "0.6 Hz and × 0.3": GestureOptions(script=f"random:{BOUTS}", seed=14, cadence_hz=0.6, amplitude=0.3),
        "2 Hz": GestureOptions(script=f"random:{BOUTS}", seed=15, cadence_hz=2.0),
        "amplitude × 1.5": GestureOptions(script=f"random:{BOUTS}", seed=16, amplitude=1.5),
    }
    wanted = {"nominal": 99.0, "0.6 Hz": 97.0, "amplitude × 0.3": 97.0}
    for cell, options in cells.items():
        made = simulate(options)
        for name, decisions in decoded(made):
            score = score_of(made, decisions, backward=name == "default")
            ours = name == "default"
            goal = wanted.get(cell) if ours else None
            yield Figure(
                f"{name}, {cell}: frame accuracy", 100 * score.accuracy, "%", goal, True, worst(score)
            )
            if cell == "nominal":
                yield from latencies(name, score, ours)
    paces = simulate(GestureOptions(script=f"random:{BOUTS}", seed=17, cadence_hz=0.8))
    quick = simulate(GestureOptions(script=f"random:{BOUTS}", seed=18, cadence_hz=1.4))
    for (name, slow), (_, fast) in zip(decoded(paces), decoded(quick), strict=True):
        both = np.concatenate([score_of(paces, slow).stop_two, score_of(quick, fast).stop_two])
        middle, late = (450.0, 800.0) if name == "default" else (None, None)
        yield Figure(
            f"{name}, 0.8 and 1.4 Hz: two feet stop, median", 1e3 * float(np.median(both)), "ms", middle
        )
        yield Figure(
            f"{name}, 0.8 and 1.4 Hz: two feet stop, p95", 1e3 * float(np.quantile(both, 0.95)), "ms", late
        )
    idle = simulate(GestureOptions(script=IDLE, seed=19))
    for name, decisions in decoded(idle):
        count = sum(a.motion == 0 != b.motion for a, b in itertools.pairwise(decisions))
        per = 600.0 * count / idle.recording.duration_s
        yield Figure(
            f"{name}: false motions in 10 min of shifting and tapping",
            per,
            "",
            1.0 if name == "default" else None,
        )
    yield Figure("default: cost of a sample", cost_us(paces), "µs", 5.0)


def latencies(name: str, score: Score, ours: bool) -> Section:
    """The nominal cell's delays."""
    yield Figure(
        f"{name}: first movement, median", 1e3 * float(np.median(score.first)), "ms", 120.0 if ours else None
    )
    note = f"from the onset {1e3 * float(np.median(score.certain_s)):.0f} ms"
    beyond = 1e3 * float(np.median(score.certain))
    yield Figure(
        f"{name}: certain class beyond half a cycle, median", beyond, "ms", 100.0 if ours else None, note=note
    )
    yield Figure(
        f"{name}: two feet stop, median",
        1e3 * float(np.median(score.stop_two)),
        "ms",
        450.0 if ours else None,
    )
    yield Figure(
        f"{name}: one foot stops, median", float(np.median(score.stop_one)), "cycles", 0.8 if ours else None
    )
    if ours:
        yield Figure(f"{name}: cadence error, median", 100 * float(np.median(score.cadence)), "%", 1.0)


def decoded(made: SimulatedGestures) -> Iterator[tuple[str, list[Decision]]]:
    """Each decoder's decisions. The papers' one is given the walk estimator's orientation."""
    feet = feet_of(made)
    turned = {role: track(samples, Settings()).rows for role, samples in feet.items()}
    orientation = {role: rows.table(rows.start, rows.end)[:, ATTITUDE] for role, rows in turned.items()}
    yield "papers", decode(PapersDecoder(), feet, orientation)
    yield "default", decode(DefaultDecoder(), feet)


def feet_of(made: SimulatedGestures) -> dict[Role, Samples]:
    """Both feet's samples."""
    return {samples.role: samples for samples in made.recording.sensors}


def score_of(made: SimulatedGestures, decisions: list[Decision], backward: bool = True) -> Score:
    """Decisions against the truth; without ``backward``, only the motions of Table 14."""
    t = np.array([d.t_ns * 1e-9 for d in decisions])
    motion = np.array([int(d.motion) for d in decisions])
    right = total = 0
    confusion: dict[tuple[int, int], int] = {}
    found: dict[str, list[float]] = {
        name: [] for name in ("first", "beyond", "certain", "two", "one", "cadence")
    }
    for bout, following in zip(made.bouts, [*made.bouts[1:], None], strict=True):
        if bout.motion == MotionId.BACKWARD and not backward:
            continue
        frames = np.arange(bout.onset_s + bout.cycle_s + 0.2, bout.end_s, _FRAME_S)
        said = motion[np.clip(np.searchsorted(t, frames, side="right") - 1, 0, None)]
        right, total = right + int(np.sum(said == bout.motion)), total + len(frames)
        for wrong in said[said != bout.motion].tolist():
            confusion[int(bout.motion), wrong] = confusion.get((int(bout.motion), wrong), 0) + 1
        measure(bout, following, decisions, t, found)
    first, beyond, certain, two, one, cadence = (np.array(values) for values in found.values())
    return Score(right / max(total, 1), first, beyond, certain, two, one, cadence, confusion)


def measure(
    bout: Bout, following: Bout | None, decisions: list[Decision], t: Floats, found: dict[str, list[float]]
) -> None:
    """One bout's delays; what never happened within the bout or the rest counts as its whole length."""
    i, j = int(np.searchsorted(t, bout.onset_s)), int(np.searchsorted(t, bout.end_s))
    length = bout.end_s - bout.onset_s
    if bout.after_rest:
        found["first"].append(next((t[k] - bout.onset_s for k in range(i, j) if decisions[k].motion), length))
        if bout.motion in _TWO_FEET:
            sure = (
                t[k] - bout.onset_s
                for k in range(i, j)
                if decisions[k].certain and decisions[k].motion == bout.motion
            )
            certain = next(sure, length)
            found["certain"].append(certain)
            found["beyond"].append(certain - 0.5 * bout.cycle_s)
    if j and decisions[j - 1].cadence_hz > 0.0:
        found["cadence"].append(abs(decisions[j - 1].cadence_hz * bout.cycle_s - 1.0))
    if following is None or not following.after_rest:
        return
    stop = 0.0
    if j and decisions[j - 1].motion:
        stop = next((t[k] - bout.end_s for k in range(j, len(t)) if not decisions[k].motion), np.inf)
    if bout.motion in _TWO_FEET:
        found["two"].append(stop)
    else:
        found["one"].append(stop / bout.cycle_s)


def worst(score: Score) -> str:
    """The commonest confusion in words."""
    if not score.confusion:
        return ""
    (true, said), frames = max(score.confusion.items(), key=lambda item: item[1])
    share = 100.0 * frames / sum(score.confusion.values())
    pair = f"{MotionId(true).name.lower()} read as {MotionId(said).name.lower()}"
    return f"{share:.0f} % of the wrong frames: {pair}"


def cost_us(made: SimulatedGestures) -> float:
    """Processor time of one sample of one foot, the decoder alone."""
    every = list(readings(feet_of(made)))[:100_000]
    decoder: Decoder = DefaultDecoder()
    decoder.take(every[0])
    began = time.process_time()
    for reading in every[1:]:
        decoder.take(reading)
    return 1e6 * (time.process_time() - began) / (len(every) - 1)
