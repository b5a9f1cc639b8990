"""Heart: many noisy walks of the papers' foot: the readings made once, the noise of each walk its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from app.estimator import events as e
from app.estimator import state as s
from app.estimator.papers_run import run
from app.motion.basics import G_MPS2, Floats, Vector
from app.motion.estimate import ROW_WIDTH
from app.motion.samples import Column
from app.settings import Settings
from app.simulate.options import WalkOptions
from app.simulate.sensors import MICROTESLA_PER_GAUSS
from app.simulate.walk import simulate

#: Walks to a task: enough to be worth sending, few enough to keep every worker busy.
BLOCK = 10


class Errors(NamedTuple):
    """σ of each sensor, and the bias of each axis: m/s², rad/s, gauss."""

    force_noise: float = 0.0
    rate_noise: float = 0.0
    field_noise: float = 0.0
    force_bias: Vector = (0.0, 0.0, 0.0)
    rate_bias: Vector = (0.0, 0.0, 0.0)
    field_bias: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class WalkConfig:
    """The papers' walk (Table 9) and its estimator (2012 paper, Table II).

    σ as the dissertation has it; the 2012 paper rounds. The papers do not subtract the gyro's mean at
    rest, and a magnetometer holds the heading.
    """

    walks: int = 50
    strides: int = 100
    stride_m: float = 1.2
    lift_m: float = 0.25
    rate_hz: float = 50.0
    still_s: float = 2.0
    force_noise_mps2: float = 0.0325
    rate_noise_radps: float = 0.0077
    field_noise_gauss: float = 0.8212e-3
    force_bias_mps2: float = 0.0981
    rate_bias_radps: float = 7.2e-6
    field_bias_gauss: float = 0.0024
    gain_stance: float = 1.05
    gain_swing: float = 0.0
    threshold_radps: float = 1.0
    min_duration_s: float = 0.06
    gravity_mps2: float = G_MPS2
    seed: int = 2012

    @property
    def settings(self) -> Settings:
        """The estimator's."""
        return Settings(
            gain_stance=self.gain_stance,
            gain_swing=self.gain_swing,
            threshold_radps=self.threshold_radps,
            min_duration_s=self.min_duration_s,
            magnetometer=True,
            bias_from_rest=False,
            gravity_from_rest=False,
            gravity_mps2=self.gravity_mps2,
        )

    def noise(self, scale: float) -> Errors:
        """The sensors' σ times ``scale``."""
        return Errors(
            scale * self.force_noise_mps2, scale * self.rate_noise_radps, scale * self.field_noise_gauss
        )


def ideal(config: WalkConfig, strides: int) -> tuple[Floats, Floats]:
    """What perfect sensors read on a straight walk north [n, 10], and where it ends [3] m."""
    walk = simulate(
        WalkOptions(
            model="papers",
            strides=strides,
            stride_m=config.stride_m,
            lift_m=config.lift_m,
            rate_hz=config.rate_hz,
            still_s=config.still_s,
            gravity_mps2=config.gravity_mps2,
        )
    )
    matrix = walk.recording.sensors[0].matrix
    position, _ = walk.truth("foot", matrix[-1:, Column.ELAPSED_NS] * 1e-9)
    return matrix, position[0]


def walk_many(config: WalkConfig, errors: Errors, strides: int, stream: int, walks: range) -> Floats:
    """The footprints [walks, strides, 3] that the estimator finds; a stride it missed is NaN.

    Each walk draws from a stream of its own, (seed, stream, walk): how the walks are shared out over
    workers changes nothing.
    """
    perfect, _ = ideal(config, strides)
    sigma = np.repeat(errors[:3], 3) * ([1.0] * 6 + [MICROTESLA_PER_GAUSS] * 3)
    bias = np.concatenate(errors[3:]) * ([1.0] * 6 + [MICROTESLA_PER_GAUSS] * 3)
    settings, samples = config.settings, perfect.copy()
    scratch = np.empty((len(perfect), ROW_WIDTH))
    found = np.empty((len(walks), strides, 3))
    for k, walk in enumerate(walks):
        generator = np.random.default_rng([config.seed, stream, walk])
        noise = generator.standard_normal((len(perfect), 9))
        noise *= sigma
        noise += bias
        np.add(perfect[:, Column.FX :], noise, out=samples[:, Column.FX :])
        found[k] = footprints(samples, settings, strides, scratch)
    return found


def footprints(samples: Floats, settings: Settings, strides: int, scratch: Floats) -> Floats:
    """Where the papers' step says the foot stood after each stride [strides, 3]; NaN past the last found."""
    state = s.new_state(settings)
    found, count, place = np.full((strides, 3), np.nan), 0, 0
    events = np.zeros((strides + 8, e.WIDTH))
    while place < len(samples):
        place, happened = run(state, samples, scratch, place, len(samples), events)
        for event in events[:happened]:
            if int(event[e.HAPPENED]) & s.STRIDE and count < strides:
                found[count] = event[e.END : e.END + 3]
                count += 1
    return found
