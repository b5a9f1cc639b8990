"""Heart: the study `integrators`: what double integration makes of one step (dissertation IV-B, IV-C)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass

import numpy as np

from app.motion.basics import Floats
from app.studies import steps
from app.studies.steps import METHODS, Profile, even_grid, stretched_grid, trapezoid
from app.studies.verdicts import ROUNDED, Judge
from app.studies.words import Curve, Done, Plot, Row, Study, Table, Task

RATES_HZ = (20, 50, 100, 200, 500, 1000)
_STRETCHED = "the swing sampled at both its ends: τ·f_s samples, τ/(N − 1) apart, on a grid of 1/f_s"
_EVEN = (
    "one even grid, the last instant of the swing already at rest; amplitude L·π²/(2τ²): (4.6) as printed,"
    " L/2, covers 1.5 cm"
)
_TIE = "one unit in the last place is allowed here: 0.92579 is printed 0.9257, cut off instead of rounded"


@dataclass(frozen=True)
class Config:
    """``grids``: as the tables need them; ``even`` or ``stretched`` for all shows what a wrong one does."""

    step_m: float = 1.8
    lift_m: float = 0.25
    grids: str = "as printed"


@dataclass(frozen=True)
class Printed:
    """One of Tables 4 to 7: velocity errors in cm/s and position errors in % by rate."""

    table: int
    model: str
    profile: Profile
    even: bool
    velocity: tuple[str, ...]
    position: tuple[str, ...]


TABLES = (
    Printed(
        4, "linear", steps.linear, False,
        ("1.705e-13", "0", "7.105e-14", "-1.421e-14", "-2.789e-13", "-3.73e-14"),
        ("40.15", "15.47", "7.622", "3.781", "1.505", "0.7512"),
    ),
    Printed(
        5, "sinusoid", steps.sinusoid, True,
        ("277.6", "111", "55.52", "27.76", "11.1", "5.552"),
        ("47.56", "18.71", "9.304", "4.639", "1.853", "0.9257"),
    ),
    Printed(
        6, "Gaussian", steps.gaussian, False,
        ("-2.253e-13", "6.122e-13", "-6.908e-13", "8.377e-13", "-2.419e-13", "1.793e-13"),
        ("-0.04155", "-0.04978", "-0.07585", "-0.09327", "-0.105", "-0.1092"),
    ),
    Printed(
        7, "Bézier", steps.bezier, False,
        ("-3.695e-13", "-4.832e-13", "-2.398e-13", "-5.893e-13", "-4.569e-14", "-5.287e-14"),
        ("-10.04", "-1.382", "-0.3286", "-0.08011", "-0.01263", "-0.003141"),
    ),
)  # fmt: skip


def tasks(config: Config) -> Sequence[Task]:
    """None: it takes milliseconds."""
    return ()


def conclude(config: Config, done: Sequence[Done]) -> Study:
    """Tables 4–7, Figs. 61–67 and 76."""
    judge = Judge("integrators")
    rows = [row for printed in TABLES for row in _table_rows(judge, config, printed)]
    rows += _fig_76(judge, config)
    rows += _figs_63_67(judge)
    return Study(
        "integrators",
        "Integrating one step",
        "Four models of the foot's acceleration over one step of 1.8 m in 0.4 s are integrated twice. The"
        " trapezoid rule makes Tables 4 to 7; the other three rules are set beside it in Figs. 61 to 67.",
        asdict(config),
        tuple(rows),
        (_convergence(config), *_figures()),
        (_methods_table(),),
    )


def _grid(config: Config, printed: Printed) -> Callable[[float, Profile], tuple[Floats, Floats]]:
    even = printed.even if config.grids == "as printed" else config.grids == "even"
    return even_grid if even else stretched_grid


def errors(config: Config, printed: Printed, rate_hz: float) -> tuple[float, float]:
    """Velocity error in cm/s and position error in % after the trapezoid rule twice."""
    t, acceleration = _grid(config, printed)(rate_hz, printed.profile)
    velocity = trapezoid(t, acceleration)[1]
    position = trapezoid(t, velocity)[1]
    return 100.0 * config.step_m * float(velocity[-1]), 100.0 * (float(position[-1]) - 1.0)


def _table_rows(judge: Judge, config: Config, printed: Printed) -> list[Row]:
    needs = _EVEN if printed.even else _STRETCHED
    rows = []
    for rate, velocity, position in zip(RATES_HZ, printed.velocity, printed.position, strict=True):
        v_error, p_error = errors(config, printed, rate)
        named = f"Table {printed.table}, {rate} Hz"
        allowed, tie = (1.0, f"; {_TIE}") if (printed.table, rate) == (5, 1000) else (ROUNDED, "")
        rows.append(
            judge.digits(
                f"{named}, position error", position, p_error, "%", places=allowed, needs=needs + tie
            )
        )
        if printed.even:
            rows.append(judge.digits(f"{named}, velocity error", velocity, v_error, "cm/s", needs=needs))
        else:
            rows.append(judge.round_off(f"{named}, velocity error", velocity, v_error, "cm/s", below=1e-9))
    return rows


def _fig_76(judge: Judge, config: Config) -> list[Row]:
    t, forward = stretched_grid(50, steps.gaussian)
    _, upward = stretched_grid(50, steps.lift)
    ends = [float(trapezoid(t, trapezoid(t, a)[1])[1][-1]) for a in (forward, upward)]
    needs = f"{_STRETCHED}; without its sign: (4.17) itself ends below the floor"
    return [
        judge.digits(
            "Fig. 76, S_x at the end", "179.91", 100 * config.step_m * ends[0], "cm", needs=_STRETCHED
        ),
        judge.digits(
            "Fig. 76, |S_z| at the end", "0.176", abs(100 * config.lift_m * ends[1]), "cm", needs=needs
        ),
    ]


def end_errors(profile: Profile, rate_hz: float) -> dict[str, float]:
    """The position error in % that each method ends with."""
    found = {}
    for name, method in METHODS.items():
        stamps, velocity = method(*stretched_grid(rate_hz, profile))
        _, position = method(stamps, velocity)
        found[name] = 100.0 * (float(position[-1]) - 1.0)
    return found


def _figs_63_67(judge: Judge) -> list[Row]:
    """What the text says of the figures, which have no numbers."""
    gaussian, bezier = end_errors(steps.gaussian, 20), end_errors(steps.bezier, 20)
    simple = max(abs(gaussian[m]) for m in ("Euler", "trapezoid"))
    higher = min(abs(gaussian[m]) for m in ("Simpson 1/3", "modified Simpson"))
    return [
        judge.bound(
            "Fig. 63, 20 Hz Gaussian: error of Simpson's rules over that of Euler and trapezoid", "> 1",
            higher / simple, "×",
        ),
        judge.bound(
            "Fig. 67, 20 Hz Bézier: least error of any method (all are unsatisfactory)", "> 1",
            min(abs(e) for e in bezier.values()), "%",
        ),
    ]  # fmt: skip


def _methods_table() -> Table:
    lines: list[tuple[str | float, ...]] = []
    for model, profile in (("Gaussian", steps.gaussian), ("Bézier", steps.bezier)):
        for rate in (100, 50, 20):
            found = end_errors(profile, rate)
            lines.append((model, f"{rate} Hz", *(found[m] for m in METHODS)))
    title = "Position error at the end, %, by method (Figs. 61–63, 65–67)"
    return Table(title, ("model", "rate", *METHODS), tuple(lines))


def _convergence(config: Config) -> Plot:
    curves = tuple(
        Curve(
            f"{printed.model} (Table {printed.table})",
            np.array(RATES_HZ, dtype=np.float64),
            np.array([abs(errors(config, printed, rate)[1]) for rate in RATES_HZ]),
        )
        for printed in TABLES
    )
    note = (
        "Jumps in the acceleration cost the first two models an error that only falls with the rate; the"
        " Gaussian ends at its own −0.11 %, which is the part of the bell that was cut off."
    )
    return Plot(
        "Position error against sample rate", "sample rate, Hz", "|position error|, %", curves, note,
        log_x=True, log_y=True,
    )  # fmt: skip


def _figures() -> list[Plot]:
    models = (
        (steps.gaussian, steps.gaussian_position, "Gaussian", (61, 62, 63)),
        (steps.bezier, steps.bezier_position, "Bézier", (65, 66, 67)),
    )
    return [
        _figure(profile, position, f"Fig. {number}: {name} model at {rate} Hz", rate)
        for profile, position, name, numbers in models
        for number, rate in zip(numbers, (100, 50, 20), strict=True)
    ]


def _figure(profile: Profile, position: Profile, title: str, rate_hz: float) -> Plot:
    exact = np.linspace(steps.LIFT_S - 0.05, steps.END_S, 200)
    curves = [Curve("exact", exact, 1.8 * position(exact - steps.LIFT_S))]
    for name, method in METHODS.items():
        stamps, velocity = method(*stretched_grid(rate_hz, profile))
        t, found = method(stamps, velocity)
        late = t >= steps.LIFT_S - 0.05
        curves.append(Curve(name, t[late], 1.8 * found[late], dots=True))
    return Plot(title, "time, s", "position, m", tuple(curves))
