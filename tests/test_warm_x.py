"""What is prepared at a start is all that a walk needs: nothing compiles while samples come."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from app.estimator.methods import METHODS
from app.warm import warm_up

#: A walk's kernels, and the kinds of arrays they were compiled for, beyond the prepared ones.
WALK = """
import json, sys
from app.session import Session
from app.settings import Settings
from app.sources.opening import open_recording
from app.sources.spec import parse_spec
from app.sources.timeline import Timeline
from app.warm import warm_up

def kernels():
    things = [x for name, m in list(sys.modules.items()) if name.startswith("app.") for x in vars(m).values()]
    compiled = [thing for thing in things if hasattr(thing, "nopython_signatures")]
    return {f"{x.__module__}.{x.__name__}{signature}" for x in compiled for signature in x.signatures}

estimator, *specs = sys.argv[1:]
timelines = [Timeline(open_recording(parse_spec(spec))[0]) for spec in specs]
warm_up(estimator)
prepared = kernels()
for timeline in timelines:
    session = Session(Settings(estimator=estimator))
    for sample in timeline.cut(0, len(timeline), 0):
        session.take(sample)
    assert session.snapshot().main.feet
print(json.dumps(sorted(kernels() - prepared)))
"""
SPECS = ("sim:walk?feet=2&path=oval&laps=1&noise=1", "sim:walk?strides=12&lost_fraction=0.02")


@pytest.mark.timeout(420)
@pytest.mark.parametrize("estimator", ["papers", "kalman"])
def test_a_walk_compiles_nothing_that_was_not_prepared(estimator: str) -> None:
    command = [sys.executable, "-c", WALK, estimator, *SPECS]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=400, check=True)
    assert json.loads(ran.stdout) == []


#: The kernels that a start had to compile though another start has kept its own.
MISSED = """
import json, sys
from app.estimator.methods import METHODS
from app.warm import warm_up

for estimator in METHODS:
    warm_up(estimator)
things = [x for name, m in list(sys.modules.items()) if name.startswith("app.") for x in vars(m).values()]
kernels = [thing for thing in things if hasattr(thing, "nopython_signatures")]
missed = {f"{x.__module__}.{x.__name__}" for x in kernels if x.stats.cache_misses}
print(json.dumps([len(kernels), sorted(missed)]))
"""


@pytest.mark.timeout(420)
def test_a_second_start_compiles_nothing_at_all() -> None:
    for estimator in METHODS:
        warm_up(estimator)
    ran = subprocess.run(
        [sys.executable, "-c", MISSED], capture_output=True, text=True, timeout=400, check=True
    )
    kernels, missed = json.loads(ran.stdout)
    assert kernels > 4
    assert missed == []
