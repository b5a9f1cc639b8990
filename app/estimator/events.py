"""Heart: the columns of an event, float64 [22]: what a step reports, and which rows change by it.

Plain numbers, because compiled code reads them. What happened is a sum of the codes in ``state.py``.
"""

from __future__ import annotations

HAPPENED = 0
LIFT_ROW = 1  # rows after it change
CONTACT_ROW = 2  # the first quiet row of the stance
ROW = 3  # the row just made; rows up to and with it change
LIFT_NS = 4
SWING_S = 5  # from the lift to the contact
EPSILON = 6  # 6…8: ε of eq. (10), m/s²: the papers' step
MOVED = 6  # 6…8: what the Kalman filter's updates since the contact changed of position, m …
START = 9  # 9…11: position at the lift
END = 12  # 12…14: position at the contact
APPLIED = 15  # 1: the rows are corrected already
SLOWED = 16  # 16…18: … of velocity, m/s, …
TURNED = 19  # 19…21: … and of attitude, a turn in n, rad
WIDTH = 22
