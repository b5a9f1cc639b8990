"""Shell: studies from their plan to the report: tasks to the workers, values to the conclusions."""

from __future__ import annotations

import json
import platform
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from app import __version__, opinions
from app.motion.basics import InputError
from app.motion.samples import Samples
from app.outputs.report import number, report
from app.sources.opening import open_recording
from app.sources.spec import parse_spec
from app.studies.catalogue import STUDIES
from app.studies.gains import recorded_tasks
from app.studies.words import Row, Study, Task
from app.workers import Tell, run_all


class Outcome(NamedTuple):
    """What a run of some studies gave, and how long it took."""

    studies: tuple[Study, ...]
    seconds: float
    where: str


def names_of(name: str) -> tuple[str, ...]:
    """The studies a name stands for; ``InputError`` if none."""
    if name == "all":
        return tuple(STUDIES)
    if name not in STUDIES:
        raise InputError(f"study {name}: expected all or one of {', '.join(STUDIES)}")
    return (name,)


def study(
    names: Sequence[str], jobs: int, cluster: str | None, tell: Tell, recordings: Sequence[str] = ()
) -> Outcome:
    """Run these studies, their tasks all together; ``recordings`` are SPECs for the study of gains."""
    began = time.perf_counter()
    walks = _walks(recordings)
    plans = [(STUDIES[name], tasks_of(name, walks)) for name in names]
    done = run_all([task for _, tasks in plans for task in tasks], jobs, cluster, tell)
    studies, first = [], 0
    for experiment, tasks in plans:
        studies.append(experiment.conclude(experiment.config, done[first : first + len(tasks)]))
        first += len(tasks)
    where = f"the Dask cluster at {cluster}" if cluster else f"{jobs} process{'es' if jobs > 1 else ''}"
    return Outcome(tuple(studies), time.perf_counter() - began, where)


def tasks_of(name: str, walks: Mapping[str, Samples] = MappingProxyType({})) -> list[Task]:
    """A study's tasks, and those that outside opinions and recorded walks bring."""
    experiment = STUDIES[name]
    others: Sequence[Task] = ()
    if name == "attitude":
        others = opinions.tasks(experiment.config)
    elif name == "gains":
        others = recorded_tasks(walks)
    return [*experiment.tasks(experiment.config), *others]


def _walks(specs: Sequence[str]) -> dict[str, Samples]:
    """The sensors of recordings, by name."""
    found = {}
    for spec in specs:
        recording, _ = open_recording(parse_spec(spec))
        for samples in recording.sensors:
            found[f"{recording.name} {samples.sensor}"] = samples
    return found


def summary(outcome: Outcome) -> dict[str, object]:
    """What ``study --json`` prints."""
    return {
        "studies": {s.name: {"title": s.title, "config": dict(s.config)} for s in outcome.studies},
        "rows": [as_json(row) for s in outcome.studies for row in s.rows],
        "seconds": outcome.seconds,
    }


def as_json(row: Row) -> dict[str, object]:
    """One row; a figure that is not a number is null."""
    got = row.got if np.isfinite(row.got) else None
    return {
        "study": row.study,
        "item": row.item,
        "printed": row.printed,
        "printed_as": row.printed_as,
        "got": got,
        "unit": row.unit,
        "verdict": str(row.verdict),
        "why": row.why,
        "needs": row.needs,
    }


def write(outcome: Outcome, folder: Path) -> list[Path]:
    """The report and the rows into a folder."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        page, rows = folder / "report.html", folder / "rows.json"
        page.write_text(report(outcome.studies, _about(outcome)), "utf-8")
        rows.write_text(json.dumps(summary(outcome), indent=1, ensure_ascii=False) + "\n", "utf-8")
    except OSError as error:
        raise InputError(f"--out {folder}: {error.strerror}: expected a folder that can be written") from None
    return [page, rows]


def _about(outcome: Outcome) -> dict[str, str]:
    return {
        "stridescope": __version__,
        "Python, numpy": f"{platform.python_version()}, {np.__version__}",
        "took": f"{outcome.seconds:.1f} s in {outcome.where}",
    }


def lines(outcome: Outcome) -> list[str]:
    """The rows for a person."""
    text = []
    for done in outcome.studies:
        text.append(f"{done.name}: {done.title}")
        for row in done.rows:
            text.append(
                f"  {row.verdict:<14} {row.item}: printed {row.printed_as}, got {number(row.got)} {row.unit}"
            )
            if row.why:
                text.append(f"                 {row.why}")
    return text
