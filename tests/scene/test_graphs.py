from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.scene import graphs, private
from app.scene.page import Scene
from tests.scene import fakes


def test_times_are_the_last_ten_seconds() -> None:
    t_s = graphs.times([fakes.graph(31.4)])
    assert (t_s[0], t_s[-1]) == pytest.approx((21.4, 31.4))
    assert (np.diff(t_s) > 0).all()
    assert len(t_s) == graphs.POINTS


def test_two_feet_share_one_axis() -> None:
    late = fakes.graph(12.0)
    t_s = graphs.times([fakes.graph(11.5), late])
    assert t_s[-1] == 12.0
    assert np.allclose(graphs.on_axis(late.t_s, late, "speed_mps"), late.speed_mps)


def test_the_phase_stays_nought_or_one() -> None:
    graph = fakes.graph(31.4)
    assert set(graphs.on_axis(np.linspace(20.0, 33.0, 997), graph, "swing")) == {0.0, 1.0}


def test_no_samples_yet() -> None:
    nothing = fakes.graph(1.0)._replace(
        **dict.fromkeys(("t_s", "statistic", "threshold", "swing", "speed_mps", "height_m"), np.zeros(0))
    )
    t_s = graphs.times([nothing])
    assert (np.diff(t_s) > 0).all()
    assert not graphs.on_axis(t_s, nothing, "statistic").any()


def plots(scene: Scene) -> list[object]:
    return [m for m in private.broadcast_messages(scene._server) if type(m).__name__ == "GuiUplotMessage"]


def test_graphs_are_made_anew_for_other_feet(scene: Scene) -> None:
    scene.draw(fakes.snapshot(5.0), fakes.status())
    drawn = [plot for plot, _ in scene.panel._graphs._plots]
    assert [len(plot.data) for plot in drawn] == [4, 2, 2]
    scene._next_graph = 0.0
    scene.draw(fakes.snapshot(5.0, two=True), fakes.status())
    assert [len(plot.data) for plot, _ in scene.panel._graphs._plots] == [7, 3, 3]
    assert all(plot._impl.removed for plot in drawn)


def test_another_walks_foot_has_its_graphs_whatever_its_sensor_is_called(scene: Scene) -> None:
    one = fakes.snapshot(5.0)
    (foot,), (graph,) = one.main.feet, one.graphs.values()
    other = one.main._replace(feet=(foot._replace(sensor="other"),))
    scene.panel.show_graphs(one)
    scene.panel.show_graphs(replace(one, main=other, graphs={"other": graph}))
    assert [len(plot.data) for plot, _ in scene.panel._graphs._plots] == [4, 2, 2]


def test_the_threshold_is_drawn_as_it_was(scene: Scene) -> None:
    scene.draw(fakes.snapshot(5.0), fakes.status())
    judged = scene.panel._graphs._plots[0][0]
    assert set(judged.data[-1]) == set(fakes.graph(5.0).threshold)


def test_the_first_graph_says_what_its_estimator_judges_by(scene: Scene) -> None:
    """Ω_th is the papers' threshold: under another method neither its line nor its name is shown."""
    papers = fakes.snapshot(3.0)
    settings = papers.main.settings.with_changes({"estimator": "kalman"})
    kalman = replace(papers, main=papers.main._replace(settings=settings), graphs=dict(papers.graphs))
    scene.panel.show_graphs(papers)
    assert any("Ω_th" in str(m) for m in plots(scene))
    scene.panel.show_graphs(kalman)
    shown = [str(m) for m in plots(scene)]
    assert any("√T" in m for m in shown)
    assert not any("Ω_th" in m for m in shown)
