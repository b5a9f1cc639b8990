"""Heart: whole recordings of two feet, sample by sample in the order of time, through a decoder."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from app.gestures.words import FEET, UNKNOWN_Q, Decision, Decoder, FootReading, standing
from app.motion.basics import Floats, Role
from app.motion.samples import Column, Samples


def readings(
    feet: Mapping[Role, Samples], orientation: Mapping[Role, Floats] | None = None
) -> Iterator[FootReading]:
    """Both feet's samples merged by their stamps. ``orientation``: q_nb [n, 4] of each foot, if known."""
    roles = [role for role in FEET if role in feet]
    stamps = [
        feet[role].device_ns + feet[role].matrix[:, Column.ELAPSED_NS].astype(np.int64) for role in roles
    ]
    every = np.concatenate(stamps) if stamps else np.zeros(0, np.int64)
    whose = np.repeat(np.arange(len(roles)), [len(part) for part in stamps])
    place = np.concatenate([np.arange(len(part)) for part in stamps]) if stamps else whose
    order = np.lexsort((whose, every))
    tables = [feet[role].matrix.tolist() for role in roles]
    turns = [None if orientation is None else orientation[role].tolist() for role in roles]
    for stamp, foot, i in zip(
        every[order].tolist(), whose[order].tolist(), place[order].tolist(), strict=True
    ):
        _, fx, fy, fz, wx, wy, wz, *_ = tables[foot][i]
        turned = turns[foot]
        q = UNKNOWN_Q if turned is None else tuple(turned[i])
        yield FootReading(roles[foot], stamp, (fx, fy, fz), (wx, wy, wz), q)


def decode(
    decoder: Decoder, feet: Mapping[Role, Samples], orientation: Mapping[Role, Floats] | None = None
) -> list[Decision]:
    """Every decision in order."""
    found = (decoder.take(reading) for reading in readings(feet, orientation))
    return [decision for decision in found if decision is not None]


def changes(decisions: list[Decision]) -> list[Decision]:
    """Those that change the motion, its speeds or their certainty; another reason alone is left out."""
    kept = [standing(0, "")]
    for decision in decisions:
        if decision[1:4] + decision[5:6] != kept[-1][1:4] + kept[-1][5:6]:
            kept.append(decision)
    return kept[1:]
