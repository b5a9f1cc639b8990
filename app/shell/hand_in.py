"""Shell: what the lab shows as one page to hand in: the scene, the plots of the whole walk, all settings."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from app import __version__
from app.motion.basics import Floats, InputError
from app.motion.snapshot import Snapshot, Trail
from app.motion.status import Status
from app.outputs.chart import chart
from app.outputs.chart_style import style
from app.scene import sheet
from app.scene.figures import FEET
from app.studies.words import Curve, Plot

#: The samples' loop answers within this, or something is wrong.
PATIENCE_S = 10.0
#: The look of a truth in a plot: green, as in the scene.
TRUTH = 2


class Seen(NamedTuple):
    """What is shown at one instant. ``errors``: over the whole walk, by sensor, as ``Snapshot.errors``."""

    snapshot: Snapshot
    status: Status
    errors: Mapping[str, Floats]
    made_by: str | None  # the simulator's SPEC
    dark: bool


def hand_in(look: Callable[[], Seen]) -> Callable[[], tuple[str, bytes]]:
    """For the door: a file's name and bytes, of what ``look`` sees on the loop that runs now."""
    loop = asyncio.get_running_loop()

    async def looked() -> Seen:
        return look()

    return lambda: made(asyncio.run_coroutine_threadsafe(looked(), loop).result(PATIENCE_S))


def made(seen: Seen) -> tuple[str, bytes]:
    """The file; it may block. ``InputError``: there is nothing to show yet."""
    if not seen.snapshot.main.feet:
        raise InputError("no samples yet: save when there is a walk to be seen")
    saved = time.strftime("%Y-%m-%d %H:%M")
    about = {"Saved": saved, "Stridescope": __version__, "Source": seen.made_by or seen.status.source.name}
    plots = "".join(map(chart, plots_of(seen.snapshot, seen.errors)))
    shown = sheet.Sheet(plots, style(seen.dark), about, seen.dark)
    page = sheet.page(seen.snapshot, seen.status, shown)
    words = [seen.status.source.name, seen.status.lesson, saved]
    name = "-".join("".join(c if c.isalnum() else "-" for c in word) for word in words if word)
    return f"{name}.html", page.encode()


def plots_of(snapshot: Snapshot, errors: Mapping[str, Floats]) -> list[Plot]:
    """A pendulum's angles, or the way from above and the error of the whole walk."""
    if snapshot.pendulum is not None:
        return [plot for table in snapshot.errors.values() for plot in _swing(table)]
    names = {foot.sensor: FEET[foot.role] for foot in snapshot.main.feet}
    feet = {foot.sensor: foot.trail for foot in snapshot.main.feet}
    ways = [_way(f"{names[s]}: estimate", trail) for s, trail in feet.items()]
    ways += [_way(f"{names[s]}: truth", trail, TRUTH) for s, trail in snapshot.truth.items()]
    off = [Curve(names[sensor], table[:, 0], table[:, 1]) for sensor, table in errors.items()]
    return [
        Plot("The way from above", "east, m", "north, m", tuple(ways), equal=True),
        Plot("Error: from the estimate to the truth", "time, s", "distance, m", tuple(off)),
    ]


def _swing(table: Floats) -> list[Plot]:
    t_s, _, angle, true = table.T
    both = (Curve("estimate", t_s, np.degrees(angle)), Curve("truth", t_s, np.degrees(true), look=TRUTH))
    off = (Curve("error", t_s, np.degrees(angle - true)),)
    return [
        Plot("Angle, the last ten seconds", "time, s", "angle from the vertical, °", both),
        Plot("Error: estimate less truth", "time, s", "angle, °", off),
    ]


def _way(label: str, trail: Trail, look: int | None = None) -> Curve:
    """A trail as a line: where its segments begin."""
    pieces = [piece.segments for piece in trail.pieces] + [trail.growing, trail.provisional]
    points = np.concatenate(pieces)[:, 0].astype(np.float64)
    return Curve(label, points[:, 1], points[:, 0], look=look)
