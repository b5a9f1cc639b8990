"""Heart: how a sensor sits on the shoe: its axes turned into toe, right, down.

A mounting is a signed permutation: for each of toe, right, down, which sensor axis it is and which
way round. Whatever tilt is left is the estimator's to find.
"""

from __future__ import annotations

import numpy as np

from app.motion.basics import Floats, InputError

#: (sensor axis 0…2, sign ±1) for toe, right, down
Axes = tuple[tuple[int, int], tuple[int, int], tuple[int, int]]

AS_GIVEN: Axes = ((0, 1), (1, 1), (2, 1))
_LETTERS = "xyz"
_LEAN = 0.2  # about 12 degrees from upright


def parse_axes(text: str) -> Axes:
    """The mounting of ``x,-y,-z``: the sensor axes that point to the toe, right and down.

    Raises ``InputError`` unless it is three different axes that make a right-handed frame.
    """
    parts = [part.strip().lower() for part in text.split(",")]
    if len(parts) != 3 or any(part.lstrip("+-") not in ("x", "y", "z") or len(part) > 2 for part in parts):
        raise InputError(f"axes={text!r}: expected three sensor axes for toe,right,down such as x,-y,-z")
    toe, right, down = ((_LETTERS.index(part[-1]), -1 if part[0] == "-" else 1) for part in parts)
    axes = (toe, right, down)
    if len({index for index, _ in axes}) < 3:
        raise InputError(f"axes={text!r}: an axis is named twice, expected each of x, y, z once")
    if np.linalg.det(rotation(axes)) < 0:
        raise InputError(f"axes={text!r}: a mirror image, expected a right-handed frame: change one sign")
    return axes


def rotation(axes: Axes) -> Floats:
    """The matrix [3, 3] that takes sensor vectors into toe, right, down."""
    matrix = np.zeros((3, 3))
    for row, (index, sign) in enumerate(axes):
        matrix[row, index] = sign
    return matrix


def turn(vectors: Floats, axes: Axes) -> Floats:
    """Sensor vectors [n, 3] in the shoe's axes; exact, as only signs and places change."""
    turned: Floats = vectors[:, [index for index, _ in axes]] * np.array([float(sign) for _, sign in axes])
    return turned


def snap(rest_force: Floats) -> Axes:
    """The mounting nearest to gravity: down is the sensor axis that the force at rest [3] opposes.

    Gravity says nothing of the heading, so sensor x is taken as forward: it is the toe, or,
    where x itself is upright, the toe is the axis that lies under its lean.
    """
    index = int(np.argmax(np.abs(rest_force)))
    down = (index, -1 if rest_force[index] > 0 else 1)
    toe = (0, 1) if index else _under_lean(rest_force)
    return (toe, _right(toe, down), down)


def _under_lean(rest_force: Floats) -> tuple[int, int]:
    """Which of ±y, ±z lies most along the horizontal part of x; without a lean, y stays right."""
    # x less its vertical part, as y and z see it
    forward = -rest_force[0] * rest_force[1:] / (rest_force @ rest_force)
    if np.abs(forward).max() < _LEAN:
        return (2, 1 if rest_force[0] > 0 else -1)
    index = int(np.argmax(np.abs(forward)))
    return (1 + index, 1 if forward[index] > 0 else -1)


def _right(toe: tuple[int, int], down: tuple[int, int]) -> tuple[int, int]:
    """The axis that makes a right-handed frame: down × toe."""
    index = 3 - toe[0] - down[0]
    cyclic = (down[0] + 1) % 3 == toe[0]
    return (index, toe[1] * down[1] * (1 if cyclic else -1))


def describe(axes: Axes) -> str:
    """In words: ``toe = x, right = −y, down = −z``."""
    names = [("−" if sign < 0 else "") + _LETTERS[index] for index, sign in axes]
    return f"toe = {names[0]}, right = {names[1]}, down = {names[2]}"
