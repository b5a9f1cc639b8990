"""Heart: a track is one named estimate of the whole walk: settings, and for each sensor rows and a trail.

The main estimate, the candidate ("ghost") and what A/B swaps to are all tracks over one sample store.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from app.blocks import BLOCK, Blocks
from app.estimator.feet import Worn, link_worn
from app.estimator.landing import landed
from app.estimator.linking import ALONE, Linking, Steps
from app.estimator.smoother import finish
from app.estimator.toes import Toes
from app.estimator.tracker import Checkpoint, Tracker
from app.estimator.turns import Turns
from app.motion.basics import Floats, GaitPhase, Quaternion, Vector
from app.motion.estimate import ATTITUDE, RowColumn, Stride, Toe
from app.motion.recording import Landing
from app.motion.samples import SAMPLE_WIDTH, GyroBias
from app.motion.snapshot import Footprint, FootView, TrackView, Trail, TrailPiece
from app.settings import Settings
from app.stores import SensorStore
from app.trail import TOLERANCES_M, Segments, TrailBuilder, coarser
from app.truth import TruePlace, error_m

Biases = Mapping[str, GyroBias]
NO_BIASES: Biases = {}
#: Footprints shown.
FOOTPRINTS = 40
#: Standing longer than this many stride durations (and 1.5 s) after a contact is not walking.
STANDING = 1.3


class FootTrack:
    """One sensor's part of a track: the tracker, and the trail of its settled rows."""

    def __init__(
        self,
        name: str,
        store: Blocks,
        settings: Settings,
        base: Checkpoint | None = None,
        known: GyroBias | None = None,
    ) -> None:
        """Begin at the oldest sample there is; ``base`` is another track's checkpoint there."""
        start = store.start
        self.tracker = Tracker(settings, start, base, known)
        self.builder = TrailBuilder(name)
        self._settled = start  # rows the builder has had
        self._segments_seen = 0
        self._footprints: tuple[Footprint, ...] = ()
        self._told: object = None  # what they were made of
        self._toes = Toes()
        self._linking: Linking | None = None
        self._name, self._sensor, self._anew = name, "", 0

    def land(self, tracker: Tracker, way: Segments) -> None:
        """Go on as ``tracker``, which comes from a saved state, by the ``way`` to it."""
        self.tracker, self._settled = tracker, tracker.rows.end - 1
        self.builder.seed((TrailPiece(f"{self.builder.name}/way", coarser(way, TOLERANCES_M[-1])),))

    def advance(self, store: Blocks) -> None:
        """Take the samples that are new."""
        self.tracker.advance(store)

    def join(self, sensor: str, linking: Linking) -> None:
        """The walk, which is this sensor's, is turned as ``linking`` says."""
        self._sensor, self._linking = sensor, linking

    @property
    def turns(self) -> Turns:
        """How the walk is turned beside the tracker's own rows."""
        return self._linking.turns(self._sensor) if self._linking else ALONE

    def table(self, begin: int, end: int) -> Floats:
        """Rows as they are drawn: a copy, float64 [k, 13]."""
        rows = self.tracker.rows
        return self.turns.from_row(max(begin, rows.start), rows.table(begin, end))

    def strides(self, newest: int) -> list[Stride]:
        """The newest strides, as they are drawn."""
        tracker = self.tracker
        both = zip(tracker.strides[-newest:], tracker.steps[-newest:], strict=True)
        return [self.turns.of_stride(stride, step.contact_row) for stride, step in both]

    def settled_strides(self, newest: int) -> list[Stride]:
        """Of the newest strides those that will stay where they are drawn."""
        steps, end = self.tracker.steps[-newest:], self._drawn_end
        return [s for s, step in zip(self.strides(newest), steps, strict=True) if step.contact_row < end]

    @property
    def _drawn_end(self) -> int:
        """Rows before this one are where they will be drawn."""
        linking = self._linking
        return linking.drawn_end(self._sensor, self.tracker) if linking else self.tracker.settled_end

    @property
    def phase(self) -> GaitPhase:
        """Of the newest row."""
        block, place = self.tracker.rows.block(self.tracker.rows.end - 1)
        return GaitPhase.SWING if block[place, RowColumn.PHASE] else GaitPhase.STANCE

    @property
    def q_nb(self) -> Quaternion:
        """Of the newest row."""
        block, place = self.tracker.rows.block(self.tracker.rows.end - 1)
        w, x, y, z = block[place, ATTITUDE].tolist()
        return (w, x, y, z)

    @property
    def position_n(self) -> Vector:
        """Of the newest row."""
        block, place = self.tracker.rows.block(self.tracker.rows.end - 1)
        north, east, down = block[place, : RowColumn.DOWN + 1].tolist()
        return (north, east, down)

    def settle(self) -> None:
        """Bring the trail up to the swing under way (when somebody looks, not for every sample)."""
        settled, linking = self._drawn_end, self._linking
        if linking is not None and linking.anew != self._anew:
            self._draw_anew(linking.anew)
        while self._settled < settled:
            breaks = self.tracker.segments[self._segments_seen :]
            stop = min(settled, breaks[0]) if breaks else settled
            for rows, number in self.tracker.rows.pieces(self._settled, stop):
                self.builder.add(self.turns.from_row(number, rows))
            self._settled = stop
            if breaks and stop == breaks[0]:
                self._segments_seen += 1
                self.builder.lift_pen()

    def _draw_anew(self, anew: int) -> None:
        """The whole walk was turned: its trail begins anew."""
        self.builder, self._anew = TrailBuilder(f"{self._name}/turned{anew}"), anew
        self._settled, self._segments_seen = self.tracker.rows.start, 0

    def trail(self) -> Trail:
        """The trail now; the swing under way is provisional."""
        self.settle()
        end = self.tracker.rows.end
        return self.builder.trail(self.table(max(self._settled, end - BLOCK), end))

    def drop_oldest(self) -> None:
        """Let the oldest block of rows go; the trail has it."""
        self.settle()
        self.tracker.drop_oldest()

    def footprints(self) -> tuple[Footprint, ...]:
        """The newest ones, made anew only when there is a new stride."""
        toe_rad = self.toe.angle_rad if self.toe else 0.0
        told = (self.tracker.stride_count, self._linking.taken if self._linking else 0, toe_rad)
        if told != self._told:
            self._told = told
            strides = self.strides(FOOTPRINTS)
            self._footprints = tuple(Footprint(s.number, s.end_n, s.heading_rad + toe_rad) for s in strides)
        return self._footprints

    @property
    def toe(self) -> Toe | None:
        """Where the toe points beside the sensor's x axis, by the strides so far."""
        return self._toes.look(self.tracker.steps, self.tracker.rows)

    def view(self, store: SensorStore, true: TruePlace | None) -> FootView:
        """This foot now. There must be a sample."""
        tracker = self.tracker
        row = self.table(tracker.rows.end - 1, tracker.rows.end)[0].tolist()
        last = tracker.strides[-1] if tracker.strides else None
        t_s = store.time_ns(tracker.rows.end - 1) * 1e-9
        walking = last is not None and t_s - last.end_s < max(1.5, STANDING * last.duration_s)
        position = (row[0], row[1], row[2])
        return FootView(
            sensor=store.sensor,
            role=store.role,
            t_s=t_s,
            position_n=position,
            q_nb=(row[6], row[7], row[8], row[9]),
            phase=GaitPhase(int(row[10])),
            levelled=tracker.levelled,
            strides=tracker.stride_count,
            distance_m=tracker.distance_m,
            speed_mps=last.length_m / last.duration_s if last and walking and last.duration_s > 0 else 0.0,
            cadence_spm=120.0 / last.duration_s if last and walking and last.duration_s > 0 else 0.0,
            height_m=-row[2],
            to_start_m=math.hypot(row[0], row[1]),
            trail=self.trail(),
            footprints=self.footprints(),
            error_m=None if true is None else error_m(true, tracker.rows, self.turns),
            trust=tracker.trust,
            compass=tracker.compass,
            toe=self.toe,
        )


class Track:
    """Settings and one ``FootTrack`` for each sensor."""

    def __init__(
        self, name: str, settings: Settings, biases: Biases = NO_BIASES, earlier: Steps | None = None
    ) -> None:
        """``biases`` are the gyro biases known before the walk, by sensor.

        ``earlier``: the strides of samples that are gone.
        """
        self.name = name
        self.settings = settings
        self.biases = biases
        self.feet: dict[str, FootTrack] = {}
        self.smoothed_s: float | None = None  # since the first sample; None: nothing is smoothed
        self.linking = Linking(settings, earlier)

    def advance(self, sensor: str, store: Blocks, base: Checkpoint | None = None) -> None:
        """Take a sensor's new samples; a sensor not seen before joins, from ``base`` if blocks are gone."""
        foot = self.feet.get(sensor)
        if foot is None:
            known = self.biases.get(sensor)
            foot = self.feet[sensor] = FootTrack(f"{self.name}.{sensor}", store, self.settings, base, known)
            foot.join(sensor, self.linking)
        foot.advance(store)

    def link(self, worn: Callable[[], Mapping[str, Worn]]) -> None:
        """Hold two feet together where there is a new stride; ``worn`` is asked only then."""
        if len(self.feet) != 2:
            return
        one, other = self.feet.values()
        if self.linking.is_due(one.tracker, other.tracker):
            self.linking.look({sensor: foot.tracker for sensor, foot in self.feet.items()}, worn())

    @property
    def linked(self) -> bool:
        """Whether two feet have one heading."""
        return self.linking.linked

    def look_back(self, stores: Mapping[str, Blocks], worn: Mapping[str, Worn]) -> None:
        """Every sensor's walk in hindsight, where the settings ask for it; two feet together."""
        for sensor, foot in self.feet.items():
            if finish(foot.tracker, stores[sensor]):
                block, place = stores[sensor].block(foot.tracker.rows.end - 1)
                self.smoothed_s = max(self.smoothed_s or 0.0, float(block[place, 0]) * 1e-9)
        if self.smoothed_s is not None and self.feet.keys() <= worn.keys():
            trackers = {sensor: foot.tracker for sensor, foot in self.feet.items()}
            linked = link_worn(trackers, worn, stores, self.settings.feet_apart_m)
            self.linking = self.linking.after_hindsight(trackers, linked)
            for sensor, foot in self.feet.items():
                foot.join(sensor, self.linking)

    def drop_before(self, sensor: str, row: int) -> None:
        """Let a sensor's rows before ``row`` go, as its samples have gone."""
        tracker = self.feet[sensor].tracker if sensor in self.feet else None
        while tracker is not None and tracker.rows.start < row:
            tracker.drop_oldest()

    def earlier(self, bases: Mapping[str, Checkpoint], turn_rad: float) -> Steps:
        """The strides before these checkpoints, in a walk that is turned clockwise about its start."""
        return {
            sensor: self.linking.first_steps(sensor, self.feet[sensor].tracker, base.strides, turn_rad)
            for sensor, base in bases.items()
        }

    def bases(self) -> dict[str, Checkpoint]:
        """For each sensor, the checkpoint at the oldest sample still here."""
        trackers = ((sensor, foot.tracker) for sensor, foot in self.feet.items())
        return {sensor: t.checkpoints[t.rows.start] for sensor, t in trackers if t.rows.start}

    def view(self, stores: Mapping[str, SensorStore], true: Mapping[str, TruePlace]) -> TrackView:
        """The whole track now."""
        feet = (foot.view(stores[sensor], true.get(sensor)) for sensor, foot in self.feet.items())
        return TrackView(self.name, self.settings, tuple(feet), self.smoothed_s, self.linked)

    @property
    def nbytes(self) -> int:
        """Memory of all rows."""
        return sum(foot.tracker.rows.nbytes for foot in self.feet.values())


def landed_track(name: str, settings: Settings, landing: Landing) -> Track | None:
    """The track whose feet go on from a landing's states; None if one is of other settings."""
    track = Track(name, settings)
    for sensor, saved in landing.saved.items():
        tracker = landed(settings, saved)
        if tracker is None:
            return None
        track.feet[sensor] = FootTrack(f"{name}.{sensor}", Blocks(SAMPLE_WIDTH), settings)
        track.feet[sensor].land(tracker, landing.ways[sensor].segments)
    return track


@dataclass(frozen=True, eq=False)
class Reestimation:
    """Work for another thread: the whole walk so far under other settings. ``run`` is pure."""

    number: int
    settings: Settings
    stores: Mapping[str, Blocks]  # shared views: rows that are there never change
    bases: Mapping[str, Checkpoint]  # where old blocks are gone, what to begin the walk with
    apply: bool  # make it the main track as soon as it is there
    who: str
    reason: str
    host_ns: int
    taken: int  # samples and orders taken when it was asked for
    before: Settings  # what an undo goes back to
    epoch: int = 0  # of the session when it was given out
    look_back: bool = False  # smooth it when it is there
    biases: Biases = field(default_factory=dict)  # known before the walk
    worn: Mapping[str, Worn] = field(default_factory=dict)  # by sensor
    earlier: Steps = field(default_factory=dict)  # strides before the bases

    def run(self) -> Track:
        """The new track over all samples that were there when the work was given out."""
        track = Track(f"track{self.number}", self.settings, self.biases, self.earlier)
        for sensor, store in self.stores.items():
            track.advance(sensor, store, self.bases.get(sensor))
        track.link(lambda: self.worn)
        if self.look_back:
            track.look_back(self.stores, self.worn)
        return track
