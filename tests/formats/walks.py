"""Samples for tests of recordings: any numbers, two feet, missing fields, saturation, a device's own q."""

from __future__ import annotations

import numpy as np

from app.formats.journal import Start
from app.formats.keeping import Keeper
from app.motion.basics import Role
from app.motion.samples import Sample
from app.settings import Settings

CLOCK_NS = 1_700_000_000_000_000_000


def random_samples(count: int, seed: int = 1) -> list[Sample]:
    """``count`` samples of two feet with every optional part now and then."""
    rng = np.random.default_rng(seed)
    made = []
    for i in range(count):
        numbers = (rng.normal(size=13) * 30.0).tolist()
        force, rate, field, q = (tuple(numbers[a:b]) for a, b in ((0, 3), (3, 6), (6, 9), (9, 13)))
        made.append(
            Sample(
                ("left", "right")[i % 2],
                i // 2,
                10_000_000 * (i // 2) - 30_000_000,
                5_000_000 * i + 7,
                force,
                rate,
                None if i % 5 == 0 else field,
                int(rng.integers(512)) if i % 7 == 0 else 0,
                q if i % 3 == 0 else None,
            )
        )
    return made


def keeper(about: dict[str, object] | None = None) -> Keeper:
    roles = {"left": Role.LEFT, "right": Role.RIGHT}
    return Keeper(about or {"version": "test"}, roles, CLOCK_NS)


def write(samples: list[Sample], chunk: int = 20, settings: Settings | None = None) -> bytes:
    """A whole file of these samples, ``chunk`` a chunk."""
    made = keeper()
    data = made.begin(0)
    chosen = settings or Settings()
    made.start(0, Start(chosen, chosen, False))
    for i, sample in enumerate(samples, 1):
        made.sample(sample)
        if i % chunk == 0:
            data += made.chunk()
    return data + made.end()
