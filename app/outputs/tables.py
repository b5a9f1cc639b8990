"""Edge: a processed walk as files: trajectory, strides and TUM: ``process --out``."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from app.motion.basics import Floats, GaitPhase, InputError
from app.motion.estimate import RowColumn, Stride

TRAJECTORY = "t_s,foot,north_m,east_m,down_m,vn_mps,ve_mps,vd_mps,qw,qx,qy,qz,phase"
STRIDES = "foot,start_s,end_s,length_m,duration_s,swing_s,stance_s,lift_m,turn_deg"


class FootTable(NamedTuple):
    """One foot's result: ``t_s`` [n] from the recording's first sample, rows [n, 13], strides."""

    foot: str
    t_s: Floats
    rows: Floats
    strides: Sequence[Stride]
    offset_s: float  # of this foot's first sample


def write(folder: Path, feet: Sequence[FootTable]) -> list[Path]:
    """Write all files into ``folder`` (made if need be); a full or closed disk is ``InputError``."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        files = [folder / "trajectory.csv", folder / "strides.csv"]
        _write(files[0], TRAJECTORY, trajectory_lines(feet))
        _write(files[1], STRIDES, stride_lines(feet))
        for foot in feet:
            files.append(folder / f"trajectory_{foot.foot}.tum")
            _write(files[-1], None, tum_lines(foot))
    except OSError as error:
        raise InputError(f"--out {folder}: cannot be written: {error.strerror}") from None
    return files


def trajectory_lines(feet: Sequence[FootTable]) -> Iterable[str]:
    """All feet's rows in time order; numbers as short as they round-trip."""
    times = np.concatenate([foot.t_s for foot in feet]) if feet else np.empty(0)
    which = (
        np.concatenate([np.full(len(foot.t_s), i) for i, foot in enumerate(feet)]) if feet else np.empty(0)
    )
    rows = np.concatenate([foot.rows for foot in feet]) if feet else np.empty((0, len(RowColumn)))
    for i in np.argsort(times, kind="stable").tolist():
        *numbers, phase = rows[i, : RowColumn.PHASE + 1].tolist()
        name = GaitPhase(int(phase)).name.lower()
        yield f"{times[i]:.9f},{feet[int(which[i])].foot},{','.join(map(repr, numbers))},{name}"


def stride_lines(feet: Sequence[FootTable]) -> Iterable[str]:
    """Strides of all feet in the order they ended."""
    rows = sorted((s.end_s + foot.offset_s, foot, s) for foot in feet for s in foot.strides)
    for _, foot, s in rows:
        times = (s.start_s + foot.offset_s, s.end_s + foot.offset_s)
        figures = (s.length_m, s.duration_s, s.swing_s, s.stance_s, s.lift_m, math.degrees(s.turn_rad))
        yield f"{foot.foot},{times[0]:.9f},{times[1]:.9f},{','.join(f'{x:.6f}' for x in figures)}"


def tum_lines(foot: FootTable) -> Iterable[str]:
    """``t x y z qx qy qz qw``, north–east–down."""
    for t, row in zip(foot.t_s.tolist(), foot.rows.tolist(), strict=True):
        n, e, d, _, _, _, w, x, y, z = row[:10]
        yield f"{t:.9f} {n:.9f} {e:.9f} {d:.9f} {x:.9f} {y:.9f} {z:.9f} {w:.9f}"


def _write(path: Path, header: str | None, lines: Iterable[str]) -> None:
    file = path.open("w", encoding="utf-8", newline="\n")
    try:
        with file:
            if header is not None:
                file.write(header + "\n")
            file.writelines(line + "\n" for line in lines)
    except OSError:
        path.unlink()  # half of a table looks like a whole one
        raise
