"""Studies that are none, for tests."""

from __future__ import annotations

import numpy as np

from app.studies.verdicts import Judge
from app.studies.words import Curve, Plot, Study, Table


def a_study(text: str = "words") -> Study:
    """A study with one of everything, ``text`` wherever words are."""
    judge = Judge("one")
    curve = Curve(text, np.arange(3.0), np.arange(3.0), spread=np.ones(3))
    return Study(
        text,
        text,
        text,
        {text: text},
        (judge.digits(text, "1.0", 1.0, text, needs=text), judge.bound(text, "< 1", 9.0, text, why=text)),
        (Plot(text, text, text, (curve, curve._replace(dots=True)), text),),
        (Table(text, (text,), ((text,), (1.0,))),),
    )
