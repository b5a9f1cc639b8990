"""Heart: which settings the walk is estimated under: main track, candidate, apply, undo, A and B.

Work that may take long (re-estimating the walk under other settings) is handed out as a pure job,
``wanted``; whoever runs it, on whatever thread, brings the result back with ``adopt``. The result does not
depend on when.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from app.estimator.feet import Worn
from app.memory import Memory
from app.motion.basics import InputError
from app.motion.commands import (
    ApplyCandidate,
    DropCandidate,
    KeepAs,
    LookBack,
    Order,
    ReplaceCandidate,
    ResetHeading,
    SetApplyAtOnce,
    SetCandidate,
    SwapAB,
    Undo,
)
from app.motion.estimate import ATTITUDE
from app.motion.samples import GyroBias
from app.motion.snapshot import Change
from app.rotation import yaw_of
from app.settings import Settings
from app.stores import SensorStore
from app.tracks import Reestimation, Track

#: Applied changes kept for the page.
CHANGES = 200
#: A slider moved again by the same person within this time is the same drag.
DRAG_NS = 2_000_000_000
SLIDER = "moved"
LOOKED_BACK = "smoothed in hindsight"


class Asked(NamedTuple):
    """An order with the number it was taken under."""

    number: int
    order: Order


class Applying:
    """The main track and what is about to become of it."""

    def __init__(
        self,
        settings: Settings,
        stores: dict[str, SensorStore],
        biases: dict[str, GyroBias],
        memory: Memory,
        epoch: int,
    ) -> None:
        """``stores`` and ``biases`` are the session's own, by sensor: what it puts in is seen here."""
        self.main = Track(f"main{epoch}", settings, biases)
        self.candidate: Track | None = None
        self.wanted: Reestimation | None = None
        self.filling: Reestimation | None = None  # after a landing
        self.at_once = False
        self.changes: list[Change] = []
        self.undo: list[Settings] = []
        self.slots: dict[str, Settings] = {}
        self.slot_now: str | None = None
        self._stores, self._biases, self._memory, self._epoch = stores, biases, memory, epoch
        self._landed: Track | None = None
        self._next: Reestimation | None = None  # a candidate moved while an apply was under way
        self._last_apply = ("", "", 0)  # who, why, when
        self._jobs = 0

    @property
    def settings(self) -> Settings:
        """What the sliders show: the wanted, else the candidate's, else the main track's settings."""
        wanted = None if self.wanted is not None and self.wanted.look_back else self.wanted
        return (self._next or wanted or self.candidate or self.main).settings

    @property
    def _coming(self) -> Reestimation | None:
        """An apply whose track is not there yet: in the order of the log it has happened already."""
        return self.wanted if self.wanted is not None and self.wanted.apply else None

    # --- what a person asks for ----------------------------------------------------------------------

    def take(self, asked: Asked) -> bool:
        """Obey, if the order is about settings; say whether it is."""
        match asked.order.command:
            case SetCandidate(changes):
                settings = self.settings.with_changes(dict(changes))
                moved = " ".join([SLIDER, *sorted(key for key, _ in changes)])
                self._want(asked, settings, self.at_once, moved)
            case ReplaceCandidate(settings, reason):
                self._want(asked, settings, self.at_once, reason)
            case ApplyCandidate():
                self._apply_candidate(asked)
            case DropCandidate():
                self.wanted, self._next, self.candidate = self._coming, None, None
            case Undo():
                self._undo_last(asked)
            case SetApplyAtOnce(on):
                self.at_once = on
                if on and self.settings != self.main.settings:
                    self._apply_candidate(asked)
            case KeepAs(slot):
                if slot not in ("A", "B"):
                    raise InputError(f"keep as {slot!r}: expected A or B")
                self.slots[slot], self.slot_now = (self._coming or self.main).settings, slot
            case SwapAB():
                other = "A" if self.slot_now == "B" else "B"
                if other in self.slots:
                    self.slot_now = other
                    self._want(asked, self.slots[other], True, f"swapped to {other}")
            case ResetHeading():
                self._reset_heading(asked)
            case LookBack():
                self._look_back(asked)
            case _:
                return False
        return True

    def note(self, asked: Asked, what: str) -> None:
        """Keep a line for the log on the page."""
        self._note(Change(asked.number, asked.order.host_ns, asked.order.who, what))

    def begin_anew(self, asked: Asked, epoch: int) -> None:
        """Another walk under the same settings; an apply under way has happened, the sliders stay."""
        coming, shown, settings = self._coming, self.settings, self.main.settings
        self.note(asked, "restarted here")
        self._epoch = epoch
        self.wanted, self._next, self.candidate, self.filling = None, None, None, None
        self.main = Track(f"main{epoch}", settings, self._biases)
        if coming is not None:
            self._make_main(Track(f"main{epoch}", coming.settings, self._biases), coming)
        if shown != self.main.settings:
            self.candidate = Track(f"candidate{epoch}", shown, self._biases)

    # --- jobs, there and back ------------------------------------------------------------------------

    def adopt(self, job: Reestimation, track: Track) -> None:
        """Bring back the result of a job.

        One that is no longer wanted is let go, but while something newer is awaited it is shown
        meanwhile, so that the ghost follows a slider that is being dragged.
        """
        wanted = self.wanted
        if wanted is None or job.epoch != self._epoch:
            return
        newest = job.number == wanted.number
        caught_up = self._catch_up(track)
        if not newest:
            self.candidate = track if caught_up else self.candidate
            return
        if not caught_up:
            self.wanted = self._fresh(wanted)
            return
        self.wanted = None
        if wanted.apply:
            self._make_main(track, wanted)
        else:
            self.candidate = track
        if self._next is not None:
            self.wanted, self._next = self._fresh(self._next), None

    def land(self, track: Track) -> None:
        """Go on as ``track``, which comes from saved states."""
        self.main, track.biases = track, self._biases
        self._landed = track

    def fill_in(self, number: int) -> None:
        """Want the walk before a landing."""
        settings = self.main.settings
        self.filling = self._fresh(Reestimation(0, settings, {}, {}, True, "", "", 0, number, settings))

    def filled(self, job: Reestimation, track: Track) -> None:
        """The whole walk up to where the session has landed, unless its estimate is another by now."""
        if self.filling is None or job.number != self.filling.number:
            return
        landed, self._landed, self.filling = self._landed, None, None
        if self.main is landed and self._catch_up(track):
            self.main = track

    def _catch_up(self, track: Track) -> bool:
        """Take the samples that came meanwhile; False where the store has moved past the track."""
        if any(
            foot.tracker.rows.end < self._stores[sensor].samples.start for sensor, foot in track.feet.items()
        ):
            return False
        bases, track.biases = self.main.bases(), self._biases
        for sensor, store in self._stores.items():
            if store.samples:
                track.drop_before(sensor, store.samples.start)
                track.advance(sensor, store.samples, bases.get(sensor))
        track.link(self.worn)
        return True

    def worn(self) -> dict[str, Worn]:
        """What is known of where each sensor is worn, and of its clock."""
        return {sensor: store.worn for sensor, store in self._stores.items()}

    # --- inside --------------------------------------------------------------------------------------

    def _want(self, asked: Asked, settings: Settings, apply: bool, reason: str) -> None:
        coming = self._coming
        if settings == self.main.settings and (apply or coming is None):
            if coming is not None and reason != "undo" and self._pass_over():
                self.undo.append(coming.settings)
            self.wanted, self._next, self.candidate = None, None, None
            return
        job = self._job(asked, settings, apply, reason)
        if coming is None or apply:
            self._pass_over()
            self.wanted, self._next = self._fresh(job), None
        else:
            self._next = job if settings != coming.settings else None

    def _job(self, asked: Asked, settings: Settings, apply: bool, reason: str) -> Reestimation:
        (number, order), before = asked, (self._coming or self.main).settings
        return Reestimation(0, settings, {}, {}, apply, order.who, reason, order.host_ns, number, before)

    def _pass_over(self) -> bool:
        """An apply that the next one overtakes has happened all the same: an undo goes back to it."""
        coming = self._coming
        if coming is None or coming.reason == "undo" or coming.look_back:
            return False
        self.undo.append(coming.before)
        return True

    def _fresh(self, job: Reestimation) -> Reestimation:
        """The same job, for the samples that are here now."""
        self._jobs += 1
        stores = {sensor: store.samples.share() for sensor, store in self._stores.items() if store.samples}
        bases = self.main.bases()
        earlier = self.main.earlier(
            bases, job.settings.start_heading_rad - self.main.settings.start_heading_rad
        )
        job = replace(job, number=self._jobs, epoch=self._epoch, biases=dict(self._biases), worn=self.worn())
        return replace(job, stores=stores, bases=bases, earlier=earlier)

    def _apply_candidate(self, asked: Asked) -> None:
        why = self._job(asked, self.settings, True, "applied")
        if self._next is not None:
            self._pass_over()
            self.wanted, self._next = self._fresh(why), None
        elif self.wanted is not None and not self.wanted.apply:
            self.wanted = replace(
                self.wanted, apply=True, who=why.who, reason=why.reason,
                host_ns=why.host_ns, taken=why.taken, before=why.before,
            )  # fmt: skip
        elif self.wanted is None and self.candidate is not None:
            self._make_main(self.candidate, why)

    def _undo_last(self, asked: Asked) -> None:
        coming = self._coming
        if coming is not None and coming.reason != "undo" and not coming.look_back:
            # given up: nothing to go back to but what was before
            self.wanted = replace(coming, reason="undo")
            self._want(asked, coming.before, True, "undo")
        elif self.undo:
            self._want(asked, self.undo.pop(), True, "undo")

    def _make_main(self, track: Track, why: Reestimation) -> None:
        if not self._same_drag(why) and why.reason != "undo" and not why.look_back:
            self.undo.append(why.before)
        reason = "slider" if why.reason.startswith(SLIDER) else why.reason
        what = f"{reason}: {why.before.differences(track.settings)}".removesuffix(": ")
        self._note(Change(why.taken, why.host_ns, why.who, what))
        turn_rad = track.settings.start_heading_rad - self.main.settings.start_heading_rad
        self._memory.seed(track, turn_rad, f"{self._epoch}t{self._jobs}")
        if self.slot_now in self.slots and self.slots[self.slot_now] != track.settings:
            self.slot_now = None
        self.main, self.candidate = track, self.candidate if why.look_back else None

    def _same_drag(self, why: Reestimation) -> bool:
        """Whether this goes on with the slider that the last apply moved: one drag is one step to undo."""
        last, self._last_apply = self._last_apply, (why.who, why.reason, why.host_ns)
        who, reason, host_ns = last
        return (
            why.reason.startswith(SLIDER)
            and (who, reason) == (why.who, why.reason)
            and 0 <= why.host_ns - host_ns < DRAG_NS
        )

    def _note(self, change: Change) -> None:
        self.changes.append(change)
        del self.changes[:-CHANGES]

    def _look_back(self, asked: Asked) -> None:
        """Smooth the main track, unless it is about to change anyway or has been smoothed up to now."""
        settings, now_s = self.main.settings, max((s.elapsed_s for s in self._stores.values()), default=0.0)
        done = self.main.smoothed_s is not None and self.main.smoothed_s >= now_s
        if settings.looks_back and self._coming is None and not done:
            self._next = self._next or self.wanted
            job = self._job(asked, settings, True, LOOKED_BACK)
            self.wanted = self._fresh(replace(job, look_back=True))

    def _reset_heading(self, asked: Asked) -> None:
        """Turn the walk so that the first foot's toe now points to the reference."""
        if self._coming is not None:  # the heading is that of the walk as applied: it cannot wait
            self.adopt(self._coming, self._coming.run())
        foot = next(iter(self.main.feet.values()), None)
        if foot is not None:
            settings, end = self.main.settings, foot.tracker.rows.end
            yaw = yaw_of(tuple(foot.table(end - 1, end)[0, ATTITUDE].tolist()))
            yaw += foot.toe.angle_rad if foot.toe else 0.0
            heading = math.remainder(settings.start_heading_rad - yaw, math.tau)
            changed = settings.with_changes({"start_heading_rad": heading})
            self._want(asked, changed, True, "heading reset")
