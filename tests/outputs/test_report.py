"""The report: one page that needs nothing else, and shows every row with its verdict."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from app.outputs.report import number, number_beside, report
from app.shell.study import names_of, study
from tests.studies.doubles import a_study


def test_nothing_is_fetched_and_no_script_runs() -> None:
    page = report([a_study()], {})
    for word in ("<script", "http://", "https://", "<link", "@import", "url("):
        assert word not in page


def test_words_never_become_markup() -> None:
    page = report([a_study(text="<img src=x>")], {"<img src=x>": "<img src=x>"})
    assert "<img" not in page


@pytest.mark.parametrize(("value", "text"), [
    (1.23456, "1.235"), (-0.5, "−0.5"), (123456.0, "123456"), (1.5e-13, "1.5 × 10⁻¹³"),
])  # fmt: skip
def test_numbers_for_people(value: float, text: str) -> None:
    assert number(value) == text


@pytest.mark.parametrize(("printed", "value", "text"), [
    ("2.3215", 2.3, "2.3000"), ("286", 286.0, "286"), ("0.0006", 1.234e-5, "1.234 × 10⁻⁵"),
    ("< 2", 1.0345, "1.034"), ("1.0", 12345.6, "12346"),
])  # fmt: skip
def test_ours_has_the_printed_figures_decimals(printed: str, value: float, text: str) -> None:
    assert number_beside(printed, value) == text


def test_a_reason_that_many_rows_share_is_said_once() -> None:
    made = a_study()
    page = report([replace(made, rows=made.rows[:1] * 3)], {})
    assert page.count("<td class=why") == 1
    assert 'rowspan="3"' in page
    assert page.count('<td class="v') == 3


def test_a_real_browser_shows_plots_verdicts_and_both_themes(
    browser: Browser, tmp_path: Path, build_dir: Path
) -> None:
    outcome = study(names_of("integrators"), 1, None, lambda done, of: None)
    path = tmp_path / "report.html"
    path.write_text(report(outcome.studies, {}), "utf-8")
    asked: list[str] = []
    for scheme, light in (("light", True), ("dark", False)):
        with browser.new_context(color_scheme=scheme, viewport={"width": 1280, "height": 900}) as context:  # type: ignore[arg-type]
            page = context.new_page()
            page.on("request", lambda request: asked.append(request.url))
            page.goto(path.as_uri())
            assert page.locator("figure svg[role=img]").count() == 7
            for box in page.locator("figure svg[role=img]").all():
                size = box.bounding_box()
                assert size is not None
                assert size["width"] > 300
            assert page.locator("td.v", has_text="reproduced").count() > 24
            paper = page.evaluate("getComputedStyle(document.body).backgroundColor")
            assert (int(paper.removeprefix("rgb(").split(",")[0]) > 128) is light
            wide = page.evaluate("document.documentElement.scrollWidth")
            assert wide <= 1280
            page.screenshot(path=build_dir / f"report-{scheme}.png", full_page=True)
    assert asked == [path.as_uri()] * 2
