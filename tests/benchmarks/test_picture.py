"""The picture of the accuracy: well-formed, a pair of bars for each estimator measured."""

from __future__ import annotations

import xml.etree.ElementTree as ET

from benchmarks.figures import Figure
from benchmarks.picture import drawn


def test_every_estimator_with_figures_has_its_bars_and_dots() -> None:
    figures = [
        Figure(f"{name}: {walks}: RMSE / path, {spread}", got, "%")
        for name in ("default", "peer <b>")
        for walks in ("Vicon room", "corridor")
        for spread, got in (("median", 0.3), ("worst", 250.0))
    ]
    svg = drawn([*figures, Figure("gone: corridor: RMSE / path, median", None), Figure("other", 1.0)])
    root = ET.fromstring(svg)
    kinds = [element.tag.rpartition("}")[2] for element in root]
    assert kinds.count("circle") == 4
    assert kinds.count("rect") == 1 + 2 + 4
    assert "peer &lt;b&gt;" in svg
    assert "gone" not in svg
