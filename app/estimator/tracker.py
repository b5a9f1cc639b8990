"""Heart: one sensor's walk: state, rows and strides; the same compiled run for one sample or a million."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.blocks import BLOCK, Blocks
from app.compiled import kernel
from app.estimator import state as s
from app.estimator.corrections import EVENT_WIDTH, Event, correct
from app.estimator.gait import SWING
from app.estimator.papers import Reading, step
from app.estimator.resume import resume
from app.estimator.state import Record, State
from app.estimator.strapdown import bias_of_swing
from app.estimator.strides import Contact, contact_at, lift_above_line, stride_between, turned
from app.motion import ROW_WIDTH, SAMPLE_WIDTH, Floats, Samples, Stride
from app.settings import Settings

#: Events a run may report before it pauses for them to be applied.
EVENTS = 64


@kernel
def run(
    state: Record, samples: Floats, rows: Floats, begin: int, end: int, events: Floats
) -> tuple[int, int]:
    """Step through ``samples`` [k, 10] from ``begin`` to ``end`` into ``rows`` [k, 12].

    Stops early when ``events`` [m, 16] is full. Returns the next sample's place and the events' count.
    """
    now = state[0]
    count = 0
    for i in range(begin, end):
        if count == events.shape[0]:
            return i, count
        reading = Reading(
            samples[i, 0],
            (samples[i, 1], samples[i, 2], samples[i, 3]),
            (samples[i, 4], samples[i, 5], samples[i, 6]),
            (samples[i, 7], samples[i, 8], samples[i, 9]),
        )
        happened = step(now, reading)
        # A swing's rows are what is known now; its zero-velocity update corrects them.
        rows[i, 0], rows[i, 1], rows[i, 2] = now.px + now.sx, now.py + now.sy, now.pz + now.sz
        rows[i, 3], rows[i, 4], rows[i, 5] = now.vx, now.vy, now.vz
        rows[i, 6], rows[i, 7], rows[i, 8], rows[i, 9] = now.q0, now.q1, now.q2, now.q3
        rows[i, 10], rows[i, 11] = now.phase, now.statistic
        if happened & s.REPORTED:
            write_event(events[count], now, happened)
            count += keep_event(events[count], rows[: i + 1], samples[: i + 1])
    return end, count


@kernel
def write_event(event: Floats, now: State, happened: int) -> None:
    """Which rows change, and by what, in the columns of ``Event``."""
    event[0], event[1], event[2], event[3] = happened, now.lift_row, now.end_row, now.row - 1.0
    event[4], event[5] = now.lift_ns, now.end_swing_s
    event[12], event[13], event[14] = now.px, now.py, now.pz
    event[15] = 0.0
    if happened & s.STRIDE:
        end_velocity = (now.end_vx, now.end_vy, now.end_vz)
        event[6], event[7], event[8] = bias_of_swing(end_velocity, now.end_swing_s)
        event[9], event[10], event[11] = now.from_x, now.from_y, now.from_z


@kernel
def keep_event(event: Floats, rows: Floats, samples: Floats) -> int:
    """Apply an event whose rows are all here, the last of them just made; 1 if more than that is to do."""
    first = int(event[3]) - rows.shape[0] + 1  # the number of row 0
    begin = int(event[1]) + 1 - first
    if begin < 0:
        return 1
    correct(rows[begin:], first + begin, samples[begin:], event)
    event[15] = 1.0
    return 1 if int(event[0]) & (s.STRIDE | s.SEGMENT) else 0


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

    def __init__(self, settings: Settings, start: int = 0, base: Checkpoint | None = None) -> None:
        """Begin at row ``start`` (a multiple of ``BLOCK``), from another tracker's checkpoint there."""
        self.settings = settings
        self._base = base or Checkpoint(s.new_state(settings), 0, 0.0, None)
        self.state = self._base.state.copy()
        contact, turn_rad = self._base.contact, settings.start_heading_rad - float(self.state["north_rad"][0])
        self._contact = contact and turned(contact, turn_rad)  # the last footprint of this segment
        resume(self.state, settings)
        self.rows = Blocks(ROW_WIDTH, start)
        self.strides: list[Stride] = []
        self.distance_m = self._base.distance_m
        self.segments: list[int] = []  # rows where a segment begins, but for the first
        self.checkpoints: dict[int, Checkpoint] = {}  # before each block's first row
        self._events = np.zeros((EVENTS, EVENT_WIDTH))

    @property
    def levelled(self) -> bool:
        """Whether level has been found."""
        return bool(self.state["levelled"][0])

    @property
    def settled_end(self) -> int:
        """Rows before this one will not change: those after the last quiet row of a swing under way may."""
        state = self.state[0]
        moving = state["phase"] == SWING or state["contrary_s"] > 0.0
        return min(int(state["lift_row"]) + 1, self.rows.end) if moving else self.rows.end

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
            place, events = run(self.state, block, rows, place, end, self._events)
            for k in range(events):
                self._happen(samples, self._events[k])

    def _happen(self, samples: Blocks, event: Floats) -> None:
        kind, lift, _, row, *_, applied = event.tolist()
        happened, first, last = int(kind), int(lift) + 1, int(row) + 1
        if not applied and happened & (s.SWING_FOUND | s.FLICKER | s.STRIDE):
            for rows, number in self.rows.pieces(first, last):
                piece, place = samples.block(number)
                correct(rows, number, piece[place : place + len(rows)], event)
        if happened & s.STRIDE:
            self._add_stride(event)
        if happened & s.SEGMENT:
            self.segments.append(last - 1)
            self._contact = None

    def _add_stride(self, event: Floats) -> None:
        _, lift_row, contact_row, _, lift_ns, swing_s, *_ = event.tolist()
        lift, contact, lift_s = max(int(lift_row), self.rows.start), int(contact_row), lift_ns * 1e-9
        lifts = [lift_above_line(rows, event) for rows, _ in self.rows.pieces(lift, contact + 1)]
        before = self._contact or self._lifted(event, lift, lift_s)
        self._contact = contact_at(self._row(contact), lift_s + swing_s)
        stride = stride_between(before, self._contact, event, self.stride_count + 1, max(lifts))
        self.strides.append(stride)
        self.distance_m += stride.length_m

    def _lifted(self, event: Floats, lift: int, lift_s: float) -> Contact:
        """Where a segment's first swing began."""
        north, east, down = event[Event.START : Event.START + 3].tolist()  # the row at the lift may be gone
        return contact_at(self._row(lift), lift_s)._replace(position_n=(north, east, down))

    def _row(self, number: int) -> Floats:
        block, place = self.rows.block(number)
        row: Floats = block[place]
        return row


def store(samples: Samples) -> Blocks:
    """The samples of a recording as the table a tracker reads."""
    table = Blocks(SAMPLE_WIDTH)
    table.extend(samples.matrix)
    return table


def track(samples: Samples, settings: Settings) -> Tracker:
    """A whole recording of one sensor: the same steps as live, in one go."""
    tracker = Tracker(settings)
    tracker.advance(store(samples))
    return tracker
