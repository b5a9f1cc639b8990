"""Heart: the steps of a calibration: the 2001 report's Appendix B, in words for a person.

Body axes: x to the toe, y to the right, z to the sole. A turn is positive about an axis as a right hand's
fingers curl about it.
"""

from __future__ import annotations

from typing import NamedTuple

AXES = "xyz"


class Step(NamedTuple):
    """One thing to do; it ends when the sensor lies still as it should."""

    down: int  # the axis that points down at its end, ...
    sign: int  # ... or, −1, up
    axis: int = -1  # of the turn that leads here; −1: none is measured
    degrees: float = 0.0
    words: str = ""

    @property
    def picture(self) -> str:
        """Which picture shows it: ``z+`` has z down, ``y*`` is a round about y."""
        if self.round:
            return f"{AXES[self.axis]}*"
        return f"{AXES[self.down]}{'+' if self.sign > 0 else '-'}"

    @property
    def round(self) -> bool:
        """Whether it is a whole turn for the magnetometer."""
        return abs(self.degrees) == 360.0


STEPS = (
    Step(2, 1, words="Lay the sensor flat on a level table: z (the sole) down. Let go of it."),
    Step(1, 1, 0, 90.0, words="Roll it a quarter turn to the right, onto its right side: y down."),
    Step(1, -1, 0, -180.0, words="Roll it half a turn back to the left, onto its left side: y up."),
    Step(0, -1, 2, 90.0, words="Stand it up on its heel: x (the toe) up."),
    Step(0, 1, 2, -180.0, words="Turn it over onto its toe: x down."),
    Step(2, -1, 1, -90.0, words="Lay it on its back: z (the sole) up."),
    Step(2, 1, 1, 180.0, words="Turn it back over the toe, flat again: z down."),
)
FIELD_STEPS = (
    Step(2, 1, 1, 360.0, words="Point x (the toe) to magnetic north. Turn it slowly all round about y, once, "
         "over the toe or over the heel, and lay it flat."),
    Step(2, 1, 0, 360.0, words="Point y (the right side) to magnetic north. Roll it slowly all round about "
         "x, once, and lay it flat."),
    Step(2, 1, words="Lay it flat with x (the toe) to magnetic north and leave it: the reference."),
)  # fmt: skip


def pose_words(down: int, sign: int) -> str:
    """What lies where: ``y is up``."""
    return f"{AXES[down]} is {'down' if sign > 0 else 'up'}"
