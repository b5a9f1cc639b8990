"""Tables 4 to 7: all 24 position errors to the printed digits, and no other way to sample gives them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.studies import integrators
from app.studies.words import Row, Verdict


def rows(grids: str = "as printed") -> list[Row]:
    return list(integrators.conclude(replace(integrators.Config(), grids=grids), []).rows)


def positions(found: list[Row]) -> list[Row]:
    return [row for row in found if row.item.startswith("Table") and row.item.endswith("position error")]


def test_24_of_24_position_errors() -> None:
    found = positions(rows())
    assert len(found) == 24
    assert {row.verdict for row in found} == {Verdict.REPRODUCED}


def test_only_the_last_row_of_table_5_is_a_unit_off() -> None:
    for row in positions(rows()):
        digits = len(row.printed_as.partition(".")[2])
        off = abs(row.got - row.printed) * 10**digits
        assert off <= (1.0 if row.item.startswith("Table 5, 1000 Hz") else 0.5 + 1e-6), row.item


@pytest.mark.parametrize(("grids", "spoilt"), [("even", {"4", "6", "7"}), ("stretched", {"5"})])
def test_a_wrong_grid_turns_its_tables_to_not_reproduced(grids: str, spoilt: set[str]) -> None:
    for row in positions(rows(grids)):
        wrong = row.verdict is Verdict.NOT_REPRODUCED
        table = row.item.removeprefix("Table ")[0]
        assert wrong or table not in spoilt or row.verdict is Verdict.CLOSE, row.item
        if table not in spoilt:
            assert row.verdict is Verdict.REPRODUCED, row.item
    counts = [row.verdict for row in positions(rows(grids)) if row.item[6] in spoilt]
    assert Verdict.REPRODUCED not in counts
    assert counts.count(Verdict.NOT_REPRODUCED) >= 0.8 * len(counts)


def test_everything_else_is_reproduced_or_rounding() -> None:
    for row in rows():
        if row.verdict is not Verdict.REPRODUCED:
            assert row.verdict is Verdict.CLOSE
            assert "rounding" in row.why
            assert abs(row.got) < 1e-9


def test_a_convention_that_was_needed_is_named() -> None:
    assert all(row.needs for row in positions(rows()))
