"""Heart: what a study is made of: tasks that may run anywhere, rows beside the printed ones, plots.

A study is planned and concluded by pure functions. Between the two its tasks run one after the other or
on a hundred machines: each has its own seed and knows nothing of the others, so the numbers are the same.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple

from app.motion.basics import Floats


class Verdict(StrEnum):
    """How a figure of ours stands to the printed one."""

    REPRODUCED = "reproduced"
    CLOSE = "close"
    NOT_REPRODUCED = "not reproduced"
    NO_DATA = "no data"  # printed from measurements that were never published: compared in shape only


@dataclass(frozen=True)
class Row:
    """One printed figure and ours. ``why`` says why it is not reproduced, ``needs`` what it took if it is."""

    study: str
    item: str  # "Table 4, 50 Hz, position error"
    printed: float
    got: float
    unit: str
    verdict: Verdict
    why: str = ""
    needs: str = ""
    printed_as: str = ""  # "40.15", "< 2": with its digits


class Curve(NamedTuple):
    """One line of a plot, or its dots; ``spread`` draws a band of ± so much about it.

    Its look (colour, dashes, shape) is that of its place in the plot, or the one that ``look`` says.
    """

    label: str
    x: Floats  # [n]
    y: Floats  # [n]
    dots: bool = False
    spread: Floats | None = None  # [n]
    look: int | None = None


@dataclass(frozen=True)
class Plot:
    """What people would rather look at than read."""

    title: str
    x_label: str  # with its unit
    y_label: str
    curves: tuple[Curve, ...]
    note: str = ""  # one or two sentences on what to see
    log_x: bool = False
    log_y: bool = False
    equal: bool = False  # one metre is as long on both axes


class Table(NamedTuple):
    """Figures with nothing printed to set beside them."""

    title: str
    head: tuple[str, ...]
    lines: tuple[tuple[str | float, ...], ...]


@dataclass(frozen=True)
class Study:
    """What came out."""

    name: str
    title: str
    about: str  # what was done, in a few sentences
    config: Mapping[str, object]
    rows: tuple[Row, ...]
    plots: tuple[Plot, ...] = ()
    tables: tuple[Table, ...] = ()


class Task(NamedTuple):
    """A call that may run in another process: a function of a module, its arguments.

    A ``timed`` one runs twice, and the second time counts: the first may have had to compile.
    """

    run: Callable[..., Any]
    arguments: tuple[Any, ...] = ()
    timed: bool = False


class Done(NamedTuple):
    """A task's value, and the seconds it took. No row may depend on the seconds."""

    value: Any
    seconds: float


class Experiment(NamedTuple):
    """One study: what may be chosen, the tasks it takes, and what follows from their values, in order."""

    config: Any  # a frozen dataclass
    tasks: Callable[[Any], Sequence[Task]]
    conclude: Callable[[Any, Sequence[Done]], Study]
