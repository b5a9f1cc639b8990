"""Heart: one sensor's walk: state, rows and strides; the same compiled run for one sample or a million."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.blocks import BLOCK, Blocks
from app.estimator import events as e
from app.estimator import state as s
from app.estimator.compass import CompassWatch
from app.estimator.methods import METHODS, go_on
from app.estimator.state import Record
from app.estimator.strides import Contact, Step, lift_above_line, step_of, stride_to, turned
from app.motion.basics import Floats
from app.motion.estimate import ROW_WIDTH, Compass, Stride, Trust
from app.motion.samples import SAMPLE_WIDTH, GyroBias, Samples
from app.rotation import yaw_of
from app.settings import Settings

#: The magnetic field of a footprint is that of so many rows of its stance.
STANCE_ROWS = 64


class Checkpoint(NamedTuple):
    """What a tracker needs to go on from the first row of a block."""

    state: Record
    strides: int
    distance_m: float
    contact: Contact | None  # the last footprint of this segment


class Tracker:
    """The estimate of one sensor under one settings record.

    ``rows`` has one row per sample; a later sample may correct rows behind it, but none before
    ``settled_end``.
    """

    def __init__(
        self,
        settings: Settings,
        start: int = 0,
        base: Checkpoint | None = None,
        known: GyroBias | None = None,
    ) -> None:
        """Begin at row ``start`` (a multiple of ``BLOCK``), from another tracker's checkpoint there.

        ``known`` is the sensor's gyro bias from before, for the first row.
        """
        self.settings = settings
        self.method = METHODS[settings.estimator]
        self._base = base or Checkpoint(self.method.begin(settings, known), 0, 0.0, None)
        contact = self._base.contact
        turn_rad = settings.start_heading_rad - float(self._base.state["north_rad"][0])
        self._contact = contact and turned(contact, turn_rad)  # the last footprint of this segment
        self.state = go_on(self.method, self._base.state, settings)
        self.rows = Blocks(ROW_WIDTH, start)
        self.strides: list[Stride] = []
        self.steps: list[Step] = []  # the same strides, as the other foot is told of them
        self.distance_m = self._base.distance_m
        self.segments: list[int] = []  # rows where a segment begins, but for the first
        self._gaps_s: list[float] = []  # without samples before each of them
        self._gap_s = 0.0  # … since the last stride
        self._watch = CompassWatch()
        self.checkpoints: dict[int, Checkpoint] = {}  # before each block's first row
        self._events = np.zeros((self.method.events, e.WIDTH))

    @property
    def levelled(self) -> bool:
        """Whether level has been found."""
        return bool(self.state["levelled"][0])

    @property
    def trust(self) -> Trust | None:
        """How sure the estimator is of where the foot is; None where it cannot know."""
        return self.method.trust(self.state, self.distance_m)

    @property
    def compass(self) -> Compass | None:
        """Whether the magnetic field could be believed at the last footprints; None where that is open."""
        return self._watch.view if self.method.compass is None else self.method.compass(self.state)

    @property
    def contact(self) -> Contact | None:
        """The last footprint of this segment."""
        return self._contact

    @property
    def settled_end(self) -> int:
        """Rows before this one will not change: those after the last quiet row of a swing under way may."""
        if not self.method.moves(self.state):
            return self.rows.end
        return min(int(self.state["lift_row"][0]) + 1, self.rows.end)

    @property
    def strides_before(self) -> int:
        """Strides before the first that is told."""
        return self._base.strides

    @property
    def stride_count(self) -> int:
        """Strides so far, also those whose samples are gone."""
        return self.strides[-1].number if self.strides else self._base.strides

    def advance(self, samples: Blocks) -> None:
        """Take every sample of the table that was not yet taken."""
        while self.rows.end < samples.end:
            block, place = samples.block(self.rows.end)
            if place == 0:
                self.checkpoints[self.rows.end] = Checkpoint(
                    self.state.copy(), self.stride_count, self.distance_m, self._contact
                )
            self._advance_in(samples, block, place, min(samples.end - self.rows.end, BLOCK - place))

    def drop_oldest(self) -> None:
        """Let the oldest block of rows go, and the checkpoint before it."""
        self.checkpoints.pop(self.rows.start, None)
        self.rows.drop_oldest()

    def _advance_in(self, samples: Blocks, block: Floats, place: int, count: int) -> None:
        base = self.rows.end - place
        self.rows.grow(count)
        rows, _ = self.rows.block(base + place)
        end = place + count
        while place < end:
            place, events = self.method.run(self.state, block, rows, place, end, self._events)
            for k in range(events):
                self._happen(samples, self._events[k])

    def _happen(self, samples: Blocks, event: Floats) -> None:
        kind, lift, _, row, *_ = event.tolist()
        happened, first, last = int(kind), int(lift) + 1, int(row) + 1
        if not event[e.APPLIED] and happened & (s.SWING_FOUND | s.FLICKER | s.STRIDE):
            for rows, number in self.rows.pieces(first, last):
                piece, place = samples.block(number)
                self.method.correct(rows, number, piece[place : place + len(rows)], event, self.state)
        if happened & s.STRIDE:
            self._add_stride(event)
            if self.method.compass is None:
                self._look_at_field(samples, int(event[e.CONTACT_ROW]), last)
        if happened & s.SEGMENT:
            self.segments.append(last - 1)
            self._gaps_s.append(self._since_before(samples, last - 1))
            self._gap_s += self._gaps_s[-1]
            self._contact = None
            self._watch.forget()

    def _since_before(self, samples: Blocks, row: int) -> float:
        """Seconds from the row before to this one."""
        if row <= samples.start:
            return 0.0
        (now, here), (before, there) = samples.block(row), samples.block(row - 1)
        return float(now[here, 0] - before[there, 0]) * 1e-9

    def _look_at_field(self, samples: Blocks, first: int, last: int) -> None:
        """The magnetic field while the foot stood, as far as these rows are in one block."""
        *_, (rows, number) = self.rows.pieces(max(first, last - STANCE_ROWS, self.rows.start), last)
        piece, place = samples.block(number)
        self._watch.add(piece[place : place + len(rows)], rows)

    def _add_stride(self, event: Floats) -> None:
        lift = max(int(event[e.LIFT_ROW]), self.rows.start)
        *earlier, (rows, _) = self.rows.pieces(lift, int(event[e.CONTACT_ROW]) + 1)
        risen_m = max((lift_above_line(piece, event) for piece, _ in earlier), default=0.0)
        before = self._contact or self._lifted(event, lift)
        stride = stride_to(before, rows, event, self.stride_count + 1, risen_m)
        self.steps.append(step_of(stride, event, self._gap_s, self.method.doubts(self.state)))
        self._gap_s = 0.0
        self._contact = Contact(stride.end_s, stride.end_n, stride.heading_rad)
        self.strides.append(stride)
        self.distance_m += stride.length_m

    def retell(self, events: list[Floats]) -> None:
        """Make the strides anew from these events and the rows as they are now."""
        base = self._base if self.rows.start == 0 else self.checkpoints[self.rows.start]
        self._contact, self.distance_m = base.contact, base.distance_m
        self.strides = [stride for stride in self.strides if stride.number <= base.strides]
        del self.steps[len(self.strides) :]
        both = zip(self.segments, self._gaps_s, strict=True)
        breaks = [(row, gap_s) for row, gap_s in both if row >= self.rows.start]
        self._gap_s = 0.0
        for event in events:
            while breaks and breaks[0][0] <= event[e.LIFT_ROW]:
                self._contact = None
                self._gap_s += breaks.pop(0)[1]
            for axis in range(3):
                event[e.START + axis] = self._row(max(int(event[e.LIFT_ROW]), self.rows.start))[axis]
                event[e.END + axis] = self._row(int(event[e.CONTACT_ROW]))[axis]
            self._add_stride(event)
        self._gap_s += sum(gap_s for _, gap_s in breaks)

    def stand(self) -> None:
        """The last footprint is the last stride's, which somebody else has moved."""
        if self._contact is not None and self.strides:
            last = self.strides[-1]
            self._contact = Contact(last.end_s, last.end_n, last.heading_rad)

    def _lifted(self, event: Floats, lift: int) -> Contact:
        """Where a segment's first swing began."""
        _, _, _, _, lift_ns, *_ = event.tolist()
        north, east, down = event[e.START : e.START + 3].tolist()  # the row at the lift may be gone
        return Contact(lift_ns * 1e-9, (north, east, down), yaw_of(tuple(self._row(lift)[6:10].tolist())))

    def _row(self, number: int) -> Floats:
        block, place = self.rows.block(number)
        row: Floats = block[place]
        return row


def store(samples: Samples) -> Blocks:
    """The samples of a recording as the table a tracker reads."""
    table = Blocks(SAMPLE_WIDTH)
    table.extend(samples.matrix)
    return table


def track(samples: Samples, settings: Settings, known: GyroBias | None = None) -> Tracker:
    """A whole recording of one sensor: the same steps as live, in one go."""
    tracker = Tracker(settings, known=known)
    tracker.advance(store(samples))
    return tracker
