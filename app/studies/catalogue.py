"""Heart: every study by its name, in the order they are told."""

from __future__ import annotations

from app.studies import attitude, gains, gait, heading, integrators, pendulum, stairs, walks
from app.studies.monte_carlo import WalkConfig
from app.studies.words import Experiment

STUDIES: dict[str, Experiment] = {
    "integrators": Experiment(integrators.Config(), integrators.tasks, integrators.conclude),
    "pendulum": Experiment(pendulum.Config(), pendulum.tasks, pendulum.conclude),
    "attitude": Experiment(attitude.Config(), attitude.tasks, attitude.conclude),
    "walk-noise": Experiment(WalkConfig(), walks.noise_tasks, walks.noise_study),
    "walk-bias": Experiment(walks.BiasConfig(), walks.bias_tasks, walks.bias_study),
    "gains": Experiment(gains.Config(), gains.tasks, gains.conclude),
    "gait": Experiment(gait.Config(), gait.tasks, gait.conclude),
    "heading": Experiment(heading.Config(), heading.tasks, heading.conclude),
    "stairs": Experiment(stairs.Config(), stairs.tasks, stairs.conclude),
}
