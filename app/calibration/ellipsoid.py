"""Heart: the ellipsoid that readings of a constant vector lie on, and what makes it a sphere.

Every reading of gravity, or of the earth's field, has one true length. A sensor with nulls, scales and skewed
axes puts them on an ellipsoid instead: its centre is the null, the square root of its shape the scale.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import least_squares

from app.motion.basics import Floats


def fit(readings: Floats, length: float, skew: bool) -> tuple[Floats, Floats, float]:
    """Null [3], scale [3, 3] and the rms of what is left over, in the readings' unit.

    ``readings`` [n, 3]; the least n is 6, with ``skew`` 9. The scale is symmetric: three lengths alone do not
    tell how the whole triad is turned. Raises ``ValueError`` where the readings do not surround a centre.
    """
    null, scale = _quadric(readings, skew)
    parameters = np.concatenate([null, np.diag(scale) * length, scale[np.triu_indices(3, 1)] * length * skew])
    middle = np.mean(np.linalg.norm(readings - null, axis=1))

    def off(p: Floats) -> Floats:
        centre, shape = _unpacked(p, skew)
        return np.asarray(np.linalg.norm((readings - centre) @ shape, axis=1) - length)

    kept = 9 if skew else 6
    steps = np.concatenate([np.full(3, middle), np.ones(kept - 3)])
    found = least_squares(off, parameters[:kept], x_scale=steps)
    centre, shape = _unpacked(found.x, skew)
    if not np.all(np.linalg.eigvalsh(shape) > 0.0):
        raise ValueError("the readings lie on no ellipsoid")
    return centre, shape, float(np.sqrt(np.mean(found.fun**2)))


def _unpacked(p: Floats, skew: bool) -> tuple[Floats, Floats]:
    shape = np.diag(p[3:6])
    if skew:
        shape[np.triu_indices(3, 1)] = p[6:9]
        shape[np.tril_indices(3, -1)] = shape.T[np.tril_indices(3, -1)]
    return p[:3], shape


def _quadric(readings: Floats, skew: bool) -> tuple[Floats, Floats]:
    """A first guess by linear least squares: centre, and the scale that makes lengths one."""
    origin = readings.mean(axis=0)
    size = float(np.abs(readings - origin).max()) or 1.0
    x, y, z = ((readings - origin) / size).T
    columns = [x * x, y * y, z * z, 2 * x, 2 * y, 2 * z]
    if skew:
        columns += [2 * x * y, 2 * x * z, 2 * y * z]
    design = np.column_stack(columns)
    v, _, rank, _ = np.linalg.lstsq(design, np.ones(len(design)), rcond=1e-6)
    if rank < design.shape[1]:
        raise ValueError("the readings do not surround a centre")
    a = np.diag(v[:3])
    if skew:
        a[0, 1], a[0, 2], a[1, 2] = v[6:9]
        a = a + np.triu(a, 1).T
    values, vectors = np.linalg.eigh(a)
    if values.min() <= 0.0:
        raise ValueError("the readings lie on no ellipsoid")
    centre = -np.linalg.solve(a, v[3:6])
    gain = 1.0 + centre @ a @ centre
    shape = vectors @ np.diag(np.sqrt(values / gain)) @ vectors.T
    return origin + size * centre, shape / size
