"""Heart: the last seconds of a foot, thinned for a plot."""

from __future__ import annotations

import math

import numpy as np

from app.motion.estimate import ROW_WIDTH, VELOCITY, RowColumn
from app.motion.snapshot import Graph
from app.stores import SensorStore
from app.tracks import FootTrack

#: Seconds that the graphs show, and about how many points.
GRAPH_S = 10.0
GRAPH_POINTS = 300


def graph_of(store: SensorStore, foot: FootTrack) -> Graph:
    """The newest ``GRAPH_S`` seconds, every k-th row: the same ones from one graph to the next."""
    rows = foot.tracker.rows
    begin = store.row_at(store.elapsed_s - GRAPH_S)
    stride = max(1, math.ceil((rows.end - begin) / GRAPH_POINTS))
    begin += -begin % stride  # other rows each time would make the line shimmer
    times, values = [np.empty(0)], [np.empty((0, ROW_WIDTH))]
    for piece, row in rows.pieces(begin, rows.end):
        offset = (begin - row) % stride
        block, place = store.samples.block(row)
        values.append(piece[offset::stride])
        times.append(block[place + offset : place + len(piece) : stride, 0] * 1e-9)
    table = np.concatenate(values)
    begin_s, second_s = store.shared_s(0.0), 1.0 + store.clock.line.slope
    return Graph(
        t_s=begin_s + second_s * np.concatenate(times),
        statistic=table[:, RowColumn.STATISTIC].copy(),
        threshold=table[:, RowColumn.THRESHOLD].copy(),
        swing=table[:, RowColumn.PHASE].copy(),
        speed_mps=np.linalg.norm(table[:, VELOCITY], axis=1),
        height_m=-table[:, RowColumn.DOWN],
    )
