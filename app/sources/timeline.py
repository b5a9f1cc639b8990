"""Edge: a recording's samples in the order of time, made into ``Sample`` records piece by piece."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from app.blocks import BLOCK
from app.motion.basics import Ints, Quaternion
from app.motion.recording import Recording, Stretch
from app.motion.samples import Rows, Sample, Samples


class Timeline:
    """All sensors of a recording merged by their stamps; the order among equal stamps is the recording's.

    A recording of ours says itself in which order its samples came.
    """

    def __init__(self, recording: Recording) -> None:
        self._sensors = recording.sensors
        if recording.journal is not None:
            self._elapsed_ns = recording.journal.elapsed_ns
            self._which = recording.journal.arrivals
        else:
            self._elapsed_ns, self._which = _merged(recording)
        self._row = np.empty(len(self._which), np.int64)
        for index, samples in enumerate(recording.sensors):
            self._row[self._which == index] = np.arange(len(samples))
        self._begins = np.flatnonzero(self._row % BLOCK == 0)

    def __len__(self) -> int:
        return len(self._elapsed_ns)

    def sensors(self) -> list[str]:
        """In the order in which they come first."""
        found, at = np.unique(self._which, return_index=True)
        return [self._sensors[index].sensor for index in found[np.argsort(at)].tolist()]

    @property
    def duration_ns(self) -> int:
        """From the first stamp to the last."""
        return int(self._elapsed_ns[-1])

    @property
    def interval_ns(self) -> int:
        """A usual step from one sample of a sensor to its next; a tenth of a second where there is none."""
        rate_hz = max(samples.rate_hz for samples in self._sensors)
        return int(1e9 / rate_hz) if rate_hz > 0.0 else 100_000_000

    def elapsed_ns(self, index: int) -> int:
        """When sample ``index`` was taken, from the first."""
        return int(self._elapsed_ns[index])

    def due(self, elapsed_ns: int) -> int:
        """How many samples had been taken by then."""
        return int(np.searchsorted(self._elapsed_ns, elapsed_ns, side="right"))

    def block_end(self, first: int) -> int:
        """Where a stretch from ``first`` on ends at the latest: behind the next first row of a block."""
        place = int(np.searchsorted(self._begins, first))
        return int(self._begins[place]) + 1 if place < len(self._begins) else len(self)

    def stretch(self, first: int, last: int, host_ns: int) -> Stretch:
        """The same samples as ``cut`` gives, in columns."""
        which, rows = self._which[first:last], self._row[first:last]
        found, at = np.unique(which, return_index=True)
        pieces = []
        for index in found[np.argsort(at)].tolist():
            own = rows[which == index]
            pieces.append(Rows(self._sensors[index], int(own[0]), int(own[-1]) + 1))
        return Stretch(tuple(pieces), host_ns, lambda: self.cut(first, last, host_ns))

    def cut(self, first: int, last: int, host_ns: int) -> list[Sample]:
        """Samples ``first`` to ``last`` (exclusive), all said to arrive at ``host_ns``."""
        which, rows = self._which[first:last], self._row[first:last]
        if len(self._sensors) == 1:
            return list(_samples(self._sensors[0], first, last, host_ns))
        streams = []
        for index, samples in enumerate(self._sensors):
            own = rows[which == index]
            streams.append(
                _samples(samples, int(own[0]), int(own[-1]) + 1, host_ns) if len(own) else iter(())
            )
        return [next(streams[index]) for index in which.tolist()]


def _merged(recording: Recording) -> tuple[Ints, Ints]:
    """When each sample was taken, from the first, and which sensor's it is, in the order of their stamps."""
    stamps = [samples.device_ns + samples.matrix[:, 0].astype(np.int64) for samples in recording.sensors]
    merged = np.concatenate(stamps)
    order = np.argsort(merged, kind="stable")
    which = np.repeat(np.arange(len(stamps)), [len(s) for s in stamps])
    return merged[order] - merged[order[0]], which[order]


def _samples(samples: Samples, first: int, last: int, host_ns: int) -> Iterator[Sample]:
    """Rows ``first`` to ``last`` of one sensor."""
    sensor, start_ns = samples.sensor, samples.device_ns
    rows = samples.matrix[first:last].tolist()
    flags = samples.saturation[first:last].tolist()
    told = _orientations(samples, first, last)
    for seq, ((elapsed_ns, fx, fy, fz, wx, wy, wz, mx, my, mz), saturation, q_nb) in enumerate(
        zip(rows, flags, told, strict=True), start=first
    ):
        yield Sample(
            sensor,
            seq,
            start_ns + int(elapsed_ns),
            host_ns,
            (fx, fy, fz),
            (wx, wy, wz),
            (mx, my, mz) if mx == mx else None,  # NaN: no magnetometer
            saturation,
            q_nb,
        )


def _orientations(samples: Samples, first: int, last: int) -> list[Quaternion | None]:
    """What the sensor itself computed, row by row."""
    if samples.device_q_nb is None:
        return [None] * (last - first)
    return [(w, x, y, z) if w == w else None for w, x, y, z in samples.device_q_nb[first:last].tolist()]
