"""Heart: the studies `walk-noise` and `walk-bias`: fifty straight walks with the sensors' errors (IV-E)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from app.motion.basics import Floats, Vector
from app.studies.late_start import SHORT, shortfall_plot
from app.studies.monte_carlo import BLOCK, Errors, WalkConfig, ideal, walk_many
from app.studies.verdicts import SPREAD_SIGMAS, Judge
from app.studies.words import Curve, Done, Plot, Row, Study, Table, Task

SCALES = (0.0, 0.1, 1.0, 10.0)
#: How far Figs. 86 and 87 go.
LONG = 1000
NORTH, EAST = 0, 1
#: Streams of random numbers: one for each case, so that a case more changes no other.
_NOISE, _BIAS, _LONG_NOISE, _LONG_BIAS = 0, 10, 20, 30


@dataclass(frozen=True)
class BiasConfig(WalkConfig):
    """The same walk, and which way each axis errs: the papers give the size of a bias, not its sign."""

    force_signs: Vector = (-1.0, 1.0, 1.0)
    rate_signs: Vector = (1.0, 1.0, 1.0)
    field_signs: Vector = (1.0, -1.0, 1.0)

    def biased(self, which: str) -> Errors:
        """Noise at scale 1, and the biases of one sensor or of ``all``."""
        errors = self.noise(1.0)
        if which in ("force", "all"):
            errors = errors._replace(force_bias=_times(self.force_bias_mps2, self.force_signs))
        if which in ("rate", "all"):
            errors = errors._replace(rate_bias=_times(self.rate_bias_radps, self.rate_signs))
        if which in ("field", "all"):
            errors = errors._replace(field_bias=_times(self.field_bias_gauss, self.field_signs))
        return errors


def _times(size: float, signs: Vector) -> Vector:
    return (size * signs[0], size * signs[1], size * signs[2])


CASES = {
    "force": "accelerometer bias",
    "rate": "gyro bias",
    "field": "magnetometer bias",
    "all": "all biases",
}
#: One sign for all axes, for the table that shows what the signs do.
ONE_SIGN = (1.0, 1.0, 1.0), (-1.0, -1.0, -1.0)
_TABLE_10 = (
    ("no sensor error", ("0", ""), ("3.33", "")),
    ("scale 0.1", ("0.00041", "0.0035"), ("1.75", "0.011")),
    ("scale 1", ("-0.0040", "0.041"), ("1.76", "0.012")),
    ("scale 10", ("-0.094", "0.35"), ("1.79", "0.05")),
)
_TABLE_11 = {
    "force": (("-2.18", "0.036"), ("-1.83", "0.012")),
    "rate": (("-0.0006", "0.035"), ("-1.75", "0.012")),
    "field": (("1.17", "0.044"), ("-1.76", "0.012")),
    "all": (("-0.97", "0.036"), ("-1.82", "0.011")),
}
_NORTH = (
    "most likely the printed walks are cut short: integration that begins 0.14 to 0.16 s after heel-off loses"
    f" {SHORT}, and noise lets it begin a sample sooner; ours is dated back to heel-off"
)
_NORTH_SPREAD = (
    "the printed spread hardly follows the noise, as a start that jumps by whole samples would make it;"
    " back-dated, ours is proportional to it"
)
_SIGNS = (
    "the papers print the biases' size, not their signs: here x and y of each sensor err in opposite ways;"
    " with one sign for all axes it comes out up to 5 % smaller (table)"
)


def _blocks(config: WalkConfig, errors: Errors, strides: int, stream: int) -> list[Task]:
    return [
        Task(walk_many, (config, errors, strides, stream, range(first, min(first + BLOCK, config.walks))))
        for first in range(0, config.walks, BLOCK)
    ]


def _gather(config: WalkConfig, done: Sequence[Done], cases: int) -> list[Floats]:
    """The cases' walks [walks, strides, 3], each from its blocks."""
    each = len(range(0, config.walks, BLOCK))
    return [np.concatenate([d.value for d in done[k * each : (k + 1) * each]]) for k in range(cases)]


def noise_tasks(config: WalkConfig) -> Sequence[Task]:
    """Four scales of noise over 100 strides; one over 1000."""
    tasks = [
        task
        for k, scale in enumerate(SCALES)
        for task in _blocks(config, config.noise(scale), config.strides, _NOISE + k)
    ]
    return tasks + _blocks(config, config.noise(1.0), LONG, _LONG_NOISE)


def bias_tasks(config: BiasConfig) -> Sequence[Task]:
    """Each sensor's bias and all together; the same with one sign for all axes; all over 1000 strides."""
    plain = one_sign(config)
    tasks = [
        task
        for k, which in enumerate(CASES)
        for task in _blocks(config, config.biased(which), config.strides, _BIAS + k)
    ]
    tasks += [
        task
        for k, which in enumerate(CASES)
        for task in _blocks(plain, plain.biased(which), config.strides, _BIAS + k)
    ]
    tasks += _blocks(config, config.biased("all"), LONG, _LONG_BIAS)
    return tasks + _blocks(replace(config, walks=1), config.noise(0.0), LONG, _LONG_BIAS)


def one_sign(config: BiasConfig) -> BiasConfig:
    """The same with the accelerometer's biases positive and the magnetometer's negative on every axis."""
    return replace(config, force_signs=ONE_SIGN[0], field_signs=ONE_SIGN[1])


def noise_study(config: WalkConfig, done: Sequence[Done]) -> Study:
    """Figs. 83, 84, 86, 87, Table 10; Fig. 12 of the 2012 paper."""
    judge = Judge("walk-noise")
    *cases, long = _gather(config, done, len(SCALES) + 1)
    _, truth = ideal(config, config.strides)
    errors = [truth - case[:, -1] for case in cases]
    rows = [
        row for table, error in zip(_TABLE_10, errors, strict=True) for row in table_10(judge, table, error)
    ]
    return Study(
        "walk-noise",
        "Fifty walks with noisy sensors",
        f"A straight walk of {config.strides} strides north with the papers' foot, {config.walks} times at"
        " each of four scales of the 3DM-GX1's noise; the adaptive-gain estimator of the 2012 paper. Errors"
        " are truth less estimate, as in Table 10; truth is the integral of the very acceleration that the"
        " sensors are given.",
        asdict(config),
        (*rows, *_in_words(judge, config, errors, long)),
        (_ends_plot("Fig. 84 (and 12): where the walks end", errors[1:], _names(_TABLE_10)[1:]),
         _growth_plot(long), shortfall_plot()),
    )  # fmt: skip


def _names(table: Sequence[tuple[str, object, object]]) -> list[str]:
    return [name for name, *_ in table]


def table_10(judge: Judge, printed: tuple[str, tuple[str, str], tuple[str, str]], error: Floats) -> list[Row]:
    """One line of it; ``error`` [walks, 3] is truth less estimate, m."""
    name, east, north = printed
    item = f"Table 10, {name}"
    rows = [_mean(judge, f"{item}, east mean", east, error[:, EAST])]
    rows.append(_mean(judge, f"{item}, north mean", north, error[:, NORTH], why=_NORTH))
    if east[1]:
        rows.append(_spread(judge, f"{item}, east spread", east[1], error[:, EAST]))
        rows.append(_spread(judge, f"{item}, north spread", north[1], error[:, NORTH], why=_NORTH_SPREAD))
    return rows


def _mean(judge: Judge, item: str, printed: tuple[str, str], got: Floats, why: str = "") -> Row:
    """Means of two samples of the same size: what chance lets them differ."""
    spread = float(printed[1] or "0") ** 2 + float(np.std(got, ddof=1)) ** 2
    error = float(np.sqrt(spread / len(got)))
    return judge.chance(item, printed[0], float(np.mean(got)), "m", error=error, why=why)


def _spread(judge: Judge, item: str, printed: str, got: Floats, why: str = "") -> Row:
    """Standard deviations of two samples of n: each is known to 1/√(2(n − 1))."""
    sigma = float(np.std(got, ddof=1))
    error = float(np.hypot(float(printed), sigma) / np.sqrt(2 * (len(got) - 1)))
    return judge.chance(item, printed, sigma, "m", error=error, sigmas=SPREAD_SIGMAS, why=why)


def _in_words(judge: Judge, config: WalkConfig, errors: Sequence[Floats], long: Floats) -> list[Row]:
    """What the 2012 paper says of its Fig. 12, and the dissertation of Figs. 86 and 87."""
    distance = config.strides * config.stride_m
    horizontal = np.hypot(errors[2][:, NORTH], errors[2][:, EAST])
    spread = np.std(long[:, :, EAST], axis=0, ddof=1)
    return [
        judge.bound(
            "2012 paper, Fig. 12(c): mean position error at scale 1", "< 0.1",
            100 * float(np.mean(horizontal)) / distance, "%",
        ),
        judge.chance(
            "2012 paper, Fig. 12(d): largest east/west error at scale 10", "1",
            float(np.abs(errors[3][:, EAST]).max()), "m", error=0.15,
            needs="“about 1 m”; the largest of fifty is known to 15 %",
        ),
        judge.bound(
            "Fig. 86: east/west spread after 1000 strides over that after 100", "> 1",
            float(spread[-1] / spread[99]), "×",
        ),
    ]  # fmt: skip


def _ends_plot(title: str, errors: Sequence[Floats], names: Sequence[str]) -> Plot:
    curves = tuple(
        Curve(name, error[:, EAST], error[:, NORTH], dots=True)
        for name, error in zip(names, errors, strict=True)
    )
    note = "Each dot is one walk of 120 m. The two axes differ in scale."
    return Plot(title, "east error, m", "north error, m", curves, note)


def _growth_plot(long: Floats) -> Plot:
    strides = np.arange(1.0, LONG + 1)
    spread = np.std(long[:, :, EAST], axis=0, ddof=1)
    root = spread[99] * np.sqrt(strides / 100.0)
    note = (
        "The heading is pulled to the magnetometer's in each stance, so its errors are short-lived and the"
        " position wanders like a random walk: with the square root of the strides."
    )
    curves = (Curve("east/west spread", strides, spread), Curve("∝ √strides", strides, root))
    return Plot("Spread against the number of strides, scale 1", "strides", "spread, m", curves, note)


def bias_study(config: BiasConfig, done: Sequence[Done]) -> Study:
    """Fig. 85, Table 11, Figs. 86, 87; Figs. 13 and 17 of the 2012 paper."""
    judge = Judge("walk-bias")
    found = _gather(config, done[:-1], 2 * len(CASES) + 1)
    _, truth = ideal(config, config.strides)
    errors = [case[:, -1] - truth for case in found[:-1]]
    chosen, plain = errors[: len(CASES)], errors[len(CASES) :]
    rows = [row for which, error in zip(CASES, chosen, strict=True) for row in table_11(judge, which, error)]
    return Study(
        "walk-bias",
        "Fifty walks with biased sensors",
        f"The same {config.walks} walks with noise at scale 1 and a constant error of 0.1 % of the span"
        " (accelerometer 0.0981 m/s², magnetometer 2.4 mG) on every axis; the gyro's as measured. Errors are"
        " estimate less truth, as in Table 11.",
        asdict(config),
        (*rows, *_bias_in_words(judge, chosen, found[-1])),
        (_ends_plot("Fig. 85 (and 13): where the walks end", chosen, list(CASES.values())),
         *_long_plots(config, found[-1], done[-1].value[0])),
        (_signs_table(chosen, plain),),
    )  # fmt: skip


def table_11(judge: Judge, which: str, error: Floats) -> list[Row]:
    """One line of it; ``error`` [walks, 3] is estimate less truth, m."""
    east, north = _TABLE_11[which]
    item = f"Table 11, {CASES[which]}"
    return [
        judge.chance(
            f"{item}, east mean", east[0], float(np.mean(error[:, EAST])), "m", needs=_SIGNS,
            error=float(np.hypot(float(east[1]), np.std(error[:, EAST], ddof=1)) / np.sqrt(len(error))),
            why=_SIGNS,
        ),
        _spread(judge, f"{item}, east spread", east[1], error[:, EAST]),
        _mean(judge, f"{item}, north mean", north, error[:, NORTH], why=_NORTH),
        _spread(judge, f"{item}, north spread", north[1], error[:, NORTH], why=_NORTH_SPREAD),
    ]  # fmt: skip


def _bias_in_words(judge: Judge, errors: Sequence[Floats], long: Floats) -> list[Row]:
    east = errors[-1][:, EAST]
    drift = np.mean(long[:, :, EAST], axis=0)
    return [
        judge.bound(
            "2012 paper, III-C: drift by all biases over the spread by noise", "> 1",
            float(abs(np.mean(east)) / np.std(east, ddof=1)), "×",
        ),
        judge.chance(
            "2012 paper, Fig. 17: drift after 1000 strides over that after 100 (a straight line)", "10",
            float(drift[-1] / drift[99]), "×", error=0.2,
        ),
    ]  # fmt: skip


def _signs_table(chosen: Sequence[Floats], plain: Sequence[Floats]) -> Table:
    lines = [
        (CASES[which], float(_TABLE_11[which][0][0]), float(np.mean(a[:, EAST])), float(np.mean(b[:, EAST])))
        for which, a, b in zip(CASES, chosen, plain, strict=True)
    ]
    head = ("", "printed", "as configured", "accelerometer + and magnetometer − on every axis")
    return Table("Mean east error, m, by the signs of the biases", head, tuple(lines))


def _long_plots(config: BiasConfig, long: Floats, clean: Floats) -> list[Plot]:
    """Figs. 86, 87 and 17: error against the number of strides."""
    strides = np.arange(1.0, LONG + 1)
    truth = np.outer(strides, ideal(config, 1)[1])
    plots = []
    for axis, name, number in ((EAST, "East/west", "86 (and 17)"), (NORTH, "North/south", "87")):
        error = long[:, :, axis] - truth[:, axis]
        curves = (
            Curve("no sensor error", strides, clean[:, axis] - truth[:, axis]),
            Curve("noise and bias", strides, np.mean(error, axis=0), spread=np.std(error, axis=0, ddof=1)),
        )
        note = "The band is one standard deviation of fifty walks."
        title = f"Fig. {number}: {name} error against strides"
        plots.append(Plot(title, "strides", "estimate less truth, m", curves, note))
    return plots
