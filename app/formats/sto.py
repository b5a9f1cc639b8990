"""Heart: orientations as OpenSim reads them (OpenSense): one column of quaternions w,x,y,z a sensor."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from app.motion.basics import Floats, Role

_BODIES = {Role.LEFT: "calcn_l_imu", Role.RIGHT: "calcn_r_imu", Role.FOOT: "calcn_r_imu"}


def sto(rate_hz: float, feet: Mapping[Role, tuple[Floats, Floats]]) -> bytes:
    """A storage of role → (t_s [n], q_nb [n, 4] wxyz), at the times of the first; others by the nearest."""
    roles = [role for role in feet if role in _BODIES]
    times = feet[roles[0]][0]
    head = [f"DataRate={rate_hz:.6f}", "DataType=Quaternion", "version=3", "OpenSimVersion=4.1", "endheader"]
    lines = [*head, "\t".join(["time", *(_BODIES[role] for role in roles)])]
    columns = [_cells(*feet[role], times) for role in roles]
    rows = zip(times.tolist(), *columns, strict=True)
    lines += ["\t".join([f"{t_s:.9f}", *cells]) for t_s, *cells in rows]
    return ("\n".join(lines) + "\n").encode()


def _cells(t_s: Floats, q_nb: Floats, at_s: Floats) -> list[str]:
    after = (
        np.clip(np.searchsorted(t_s, at_s), 1, max(len(t_s) - 1, 1)) if len(t_s) > 1 else np.zeros_like(at_s)
    )
    rows = after.astype(np.int64)
    if len(t_s) > 1:
        rows -= (at_s - t_s[rows - 1]) < (t_s[rows] - at_s)
    return [",".join(f"{value:.9f}" for value in q) for q in q_nb[rows].tolist()]
