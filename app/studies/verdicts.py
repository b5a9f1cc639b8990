"""Heart: whether a figure of ours is the printed one: by its digits, by chance, or by a bound."""

from __future__ import annotations

import math
from dataclasses import dataclass

from app.studies.words import Row, Verdict

#: Half a unit in the last printed place, and a hair for a tie.
ROUNDED = 0.5 + 1e-6
#: So many standard errors apart two samples of the same thing still are.
SIGMAS = 3.0
#: A spread of fifty is known to 10 %: at three standard errors one half as large again would pass.
SPREAD_SIGMAS = 2.0


def last_place(printed: str) -> float:
    """The unit of the last printed digit: 0.01 of ``40.15``, 1e-16 of ``1.705e-13``."""
    mantissa, _, exponent = printed.lower().partition("e")
    decimals = len(mantissa.partition(".")[2])
    return float(10.0 ** (int(exponent or "0") - decimals))


@dataclass(frozen=True)
class Judge:
    """Gives the verdicts of one study. ``close`` is a share of the printed figure."""

    study: str

    def digits(
        self,
        item: str,
        printed: str,
        got: float,
        unit: str,
        *,
        places: float = ROUNDED,
        close: float = 0.01,
        why: str = "",
        needs: str = "",
    ) -> Row:
        """Reproduced if it rounds to the printed digits (or is off by ``places`` units of the last)."""
        off = abs(got - float(printed)) / last_place(printed)
        near = abs(got - float(printed)) <= close * abs(float(printed))
        return self._row(item, printed, got, unit, _verdict(off <= places, near), why, needs)

    def chance(
        self,
        item: str,
        printed: str,
        got: float,
        unit: str,
        *,
        error: float,
        sigmas: float = SIGMAS,
        close: float = 0.1,
        why: str = "",
        needs: str = "",
    ) -> Row:
        """Reproduced if no further off than ``error`` (one standard error of the difference) lets it be."""
        off = abs(got - float(printed))
        allowed = sigmas * error + 0.5 * last_place(printed)
        near = off <= close * abs(float(printed))
        return self._row(item, printed, got, unit, _verdict(off <= allowed, near), why, needs)

    def bound(self, item: str, printed: str, got: float, unit: str, *, why: str = "", needs: str = "") -> Row:
        """Reproduced if it keeps what is said in words: ``< 2`` or ``> 1``; within a tenth more is close."""
        sign, number = printed[0], float(printed[1:])
        kept = got < number if sign == "<" else got > number
        near = abs(got - number) <= 0.1 * abs(number)
        return self._row(item, printed, got, unit, _verdict(kept, near), why, needs)

    def round_off(self, item: str, printed: str, got: float, unit: str, *, below: float) -> Row:
        """Both are rounding errors of something that is zero: never the same digits, close if so small."""
        small = abs(got) < below and abs(float(printed)) < below
        verdict = Verdict.CLOSE if small else Verdict.NOT_REPRODUCED
        why = "zero but for rounding, which no two programs share" if small else ""
        return self._row(item, printed, got, unit, verdict, why, "")

    def no_data(self, item: str, printed: str, got: float, unit: str, why: str) -> Row:
        """Printed from measurements nobody else has; ours is a simulation's."""
        return self._row(item, printed, got, unit, Verdict.NO_DATA, why, "")

    def _row(
        self, item: str, printed: str, got: float, unit: str, verdict: Verdict, why: str, needs: str
    ) -> Row:
        number = float(printed.lstrip("<> "))
        if verdict is Verdict.REPRODUCED:
            why = ""
        elif not why:
            why = f"off by {abs(got - number):.3g} {unit}: nothing known explains it"
        if math.isnan(got):
            verdict = Verdict.NOT_REPRODUCED
        return Row(self.study, item, number, float(got), unit, verdict, why, needs, printed)


def _verdict(reproduced: bool, near: bool) -> Verdict:
    if reproduced:
        return Verdict.REPRODUCED
    return Verdict.CLOSE if near else Verdict.NOT_REPRODUCED
