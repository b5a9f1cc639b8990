"""Heart: every study by its name, in the order they are told."""

from __future__ import annotations

from app.studies import integrators
from app.studies.words import Experiment

STUDIES: dict[str, Experiment] = {
    "integrators": Experiment(integrators.Config(), integrators.tasks, integrators.conclude),
}
