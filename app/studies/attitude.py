"""Heart: the study `attitude`: TRIAD, QUEST, FQA and two filters side by side (III-B; 2001 report)."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import NamedTuple

import numpy as np

from app.motion.basics import G_MPS2, Floats, Quaternion
from app.simulate.foot import rotate_to_body
from app.simulate.sensors import FIELD_N_UT
from app.studies.attitudes import criterion, fqa, gauss_newton, quest, triad
from app.studies.filters import exact_filter
from app.studies.motions import MOTIONS, Motion, Sensor, perfect, tilt_table
from app.studies.verdicts import Judge
from app.studies.words import Curve, Done, Plot, Row, Study, Table, Task

GAINS = (1.0, 4.0, 8.0, 16.0, 32.0)
START: Quaternion = (1.0, 0.0, 0.0, 0.0)
_TABLE = "measured on a rotary tilt table whose data was never published; ours is simulated"
_QUEST = (
    "true only of readings without error: QUEST shares an error between both vectors, TRIAD leaves gravity"
    " whole (with all weight on gravity they would agree)"
)
_LAW = "“printed”: 1/(2k), which is linear theory; from 30° it takes up to 3 % longer"


_NOTES = {
    "tilt table": "Turned and held, going nowhere: only noise is left, and the gyro takes most of it.",
    "tilt table by iron": "From 10 to 40 s iron bends the field, and every heading with it. Who lets it bend"
    " level too, the table of the vertical alone shows.",
    "pendulum": "The swing's own acceleration passes for gravity, most where each sample is taken by itself.",
    "foot": "A foot around a square: in each swing TRIAD, QUEST and FQA are lost, and back with each stance.",
}


@dataclass(frozen=True)
class Config:
    """``gain``: of both filters on the motions; ``weight``: ρ of the magnetometer where it is weighted."""

    gain: float = 1.0
    weight: float = 0.25
    every: int = 4
    error_deg: float = 30.0
    sensor: Sensor = Sensor()  # noqa: RUF009  (frozen)


class Found(NamedTuple):
    """One method on one motion: orientation q_nb [n, 4]."""

    method: str
    motion: str
    q_nb: Floats


Method = Callable[[Config, Floats, Floats], None]


def _newton(weighted: bool = False, seldom: bool = False) -> Method:
    def run(config: Config, samples: Floats, out: Floats) -> None:
        weight, every = config.weight if weighted else 1.0, config.every if seldom else 1
        gauss_newton(samples, FIELD_N_UT, START, config.gain, weight, every, out)

    return run


METHODS: Mapping[str, Method] = {
    "TRIAD": lambda config, samples, out: triad(samples, FIELD_N_UT, out),
    "QUEST": lambda config, samples, out: quest(samples, FIELD_N_UT, out),
    "FQA": lambda config, samples, out: fqa(samples, out),
    "Gauss–Newton": _newton(),
    "Gauss–Newton, ρ": _newton(weighted=True),
    "Gauss–Newton, every 4th": _newton(seldom=True),
    "complementary": lambda config, samples, out: exact_filter(samples, config.gain, START, out),
}


def run_method(config: Config, method: str, motion: str, samples: Floats) -> Found:
    """One method over one motion's samples [n, 10]."""
    out = np.empty((len(samples), 4))
    METHODS[method](config, samples, out)
    return Found(method, motion, out)


def tasks(config: Config) -> Sequence[Task]:
    """Every method on every motion; timed, for what a sample costs."""
    motions = {name: make(config.sensor) for name, make in MOTIONS.items()}
    return [
        Task(run_method, (config, method, name, motion.samples), timed=True)
        for name, motion in motions.items()
        for method in METHODS
    ]


def conclude(config: Config, done: Sequence[Done]) -> Study:
    """The 2001 report's convergence and Fig. 8; what the dissertation says of TRIAD, QUEST and FQA."""
    judge = Judge("attitude")
    motions = {name: make(config.sensor) for name, make in MOTIONS.items()}
    found = {(d.value.method, d.value.motion): d.value.q_nb for d in done}
    return Study(
        "attitude",
        "Attitude from gravity and north",
        "TRIAD, QUEST and FQA take each sample by itself; the Gauss–Newton filter of the 2001 report and the"
        " complementary filter add the gyro. All see the same motions through the same sensor. Errors are the"
        " angle of the turn between estimate and truth.",
        asdict(config),
        (*_convergence_rows(judge, config), *_claims(judge, config, motions, found)),
        (_convergence_plot(config), *_motion_plots(motions, found)),
        _tables(motions, done),
    )


# --- convergence: eq. (12) ---------------------------------------------------------------------------


def decay(config: Config, gain: float) -> tuple[Floats, Floats]:
    """Seconds, and φ of (19) after an error of 30° in a resting sensor."""
    rate_hz = 1000.0
    t = np.arange(round(3.0 / gain * rate_hz) + 1) / rate_hz
    level = np.zeros((len(t), 10))
    level[:, 0] = np.rint(t * 1e9)
    level[:, 3] = -G_MPS2
    level[:, 7:] = FIELD_N_UT
    axis = np.array([1.0, 1.0, 1.0]) / math.sqrt(3.0)
    half = 0.5 * math.radians(config.error_deg)
    x, y, z = (math.sin(half) * axis).tolist()
    out = np.empty((len(t), 4))
    gauss_newton(level, FIELD_N_UT, (math.cos(half), x, y, z), gain, 1.0, 1, out)
    force = (0.0, 0.0, -G_MPS2)
    phi = [criterion((a, b, c, d), force, FIELD_N_UT, FIELD_N_UT) for a, b, c, d in out.tolist()]
    return t, np.array(phi)


def _convergence_rows(judge: Judge, config: Config) -> list[Row]:
    rows = []
    for gain in GAINS:
        t, phi = decay(config, gain)
        seconds = float(np.interp(1.0, -np.log(phi / phi[0]), t))
        law = 1.0 / (2.0 * gain)
        rows.append(
            judge.chance(
                f"Eq. (12), k = {gain:g}: squared error falls to 37 % after", f"{law:.5g}", seconds, "s",
                error=0.01 * law, close=0.05, needs=_LAW,
            )
        )  # fmt: skip
    return rows


def _convergence_plot(config: Config) -> Plot:
    curves = []
    for gain in GAINS:
        t, phi = decay(config, gain)
        curves.append(Curve(f"k = {gain:g}", t[::10], phi[::10] / phi[0]))
    note = "Fig. 7 of the 2001 report: whatever the gain, the error dies as e^(−2kt)."
    return Plot("Criterion φ after an error of 30°", "time, s", "φ / φ(0)", tuple(curves), note, log_y=True)


# --- the motions -------------------------------------------------------------------------------------


def errors_deg(motion: Motion, q_nb: Floats) -> tuple[Floats, Floats]:
    """The whole error and that of the vertical alone, degrees [n], from the first scored sample on."""
    true, got = motion.q_nb[motion.scored :], q_nb[motion.scored :]
    cosine = np.abs(np.sum(true * got, axis=1))
    down = np.array([0.0, 0.0, 1.0])
    between = np.sum(rotate_to_body(true, down) * rotate_to_body(got, down), axis=1)
    return np.degrees(2.0 * np.arccos(np.minimum(cosine, 1.0))), np.degrees(
        np.arccos(np.clip(between, -1, 1))
    )


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _claims(
    judge: Judge, config: Config, motions: Mapping[str, Motion], found: Mapping[tuple[str, str], Floats]
) -> list[Row]:
    table, iron = motions["tilt table"], motions["tilt table by iron"]
    tilt = {m: _rms(errors_deg(iron, found[m, "tilt table by iron"])[1]) for m in METHODS}
    plain = _rms(errors_deg(table, found["FQA", "tilt table"])[1])
    apart = _largest_apart(found["QUEST", "tilt table"], found["TRIAD", "tilt table"])
    perfect = _perfect_apart(config)
    rolled = errors_deg(table, found["Gauss–Newton", "tilt table"])[0]
    return [
        judge.digits(
            "III-B: tilt error of FQA that a bent field adds", "0.00", tilt["FQA"] - plain, "deg"
        ),
        judge.digits("III-B: angle from QUEST to TRIAD, two perfect vectors", "0.00", perfect, "deg"),
        judge.digits("III-B: angle from QUEST to TRIAD, two noisy vectors", "0.00", apart, "deg", why=_QUEST),
        judge.bound(
            "2001 report, (17): tilt error by a bent field, ρ = 1 over ρ = 0.25", "> 1",
            tilt["Gauss–Newton"] / tilt["Gauss–Newton, ρ"], "×",
        ),
        judge.no_data(
            "2001 report, Fig. 8: largest error on the tilt table", "< 1", float(rolled.max()), "deg", _TABLE
        ),
    ]  # fmt: skip


def _largest_apart(a: Floats, b: Floats) -> float:
    cosine = np.abs(np.sum(a * b, axis=1))
    sine = np.linalg.norm(a * np.sign(np.sum(a * b, axis=1))[:, None] - b, axis=1)  # exact where it is small
    return float(
        np.degrees(np.where(cosine > 0.99, 2.0 * sine, 2.0 * np.arccos(np.minimum(cosine, 1.0)))).max()
    )


def _perfect_apart(config: Config) -> float:
    motion = tilt_table(perfect(config.sensor))
    pair = [run_method(config, name, "", motion.samples).q_nb for name in ("QUEST", "TRIAD")]
    return _largest_apart(*pair)


def _tables(motions: Mapping[str, Motion], done: Sequence[Done]) -> tuple[Table, ...]:
    names = list(dict.fromkeys(d.value.method for d in done))
    found = {(d.value.method, d.value.motion): d for d in done}
    tables = []
    for which, title in ((0, "RMS error, degrees"), (1, "RMS error of the vertical alone, degrees")):
        lines = [
            (name, *(_rms(errors_deg(motions[m], found[name, m].value.q_nb)[which]) for m in motions))
            for name in names
        ]
        tables.append(Table(title, ("method", *motions), tuple(lines)))
    cost = [
        (name, 1e6 * float(np.median([found[name, m].seconds / len(motions[m].q_nb) for m in motions])))
        for name in names
    ]
    return (*tables, Table("Cost of a sample, µs, on the machine of this run", ("method", "µs"), tuple(cost)))


def _motion_plots(motions: Mapping[str, Motion], found: Mapping[tuple[str, str], Floats]) -> list[Plot]:
    plots = []
    for name, motion in motions.items():
        t = motion.samples[motion.scored :, 0] * 1e-9
        curves = []
        for method in METHODS:
            whole, _ = errors_deg(motion, found[method, name])
            coarse = np.array([_rms(part) for part in np.array_split(whole, 120)])
            curves.append(Curve(method, np.array([part.mean() for part in np.array_split(t, 120)]), coarse))
        plots.append(Plot(f"Error: {name}", "time, s", "error, deg", tuple(curves), _NOTES[name], log_y=True))
    return plots
