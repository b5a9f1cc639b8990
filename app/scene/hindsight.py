"""Edge, scene: the candidate beside the main track, A and B, and the search for the best gains."""

from __future__ import annotations

from app.motion.commands import ApplyCandidate, DropCandidate, FindGains, KeepAs, SetApplyAtOnce, SwapAB, Undo
from app.motion.estimate import Sweep
from app.motion.snapshot import Snapshot
from app.motion.status import Status
from app.scene import figures, private, surface, swinging
from app.scene.controls import Controls, Input


class CandidateBox:
    """Difference, apply, drop, undo, A and B."""

    def __init__(self, controls: Controls) -> None:
        self._compared = controls.html()
        self.buttons = controls.choice(
            "", {"Apply": ApplyCandidate, "Drop": DropCandidate, "Undo": Undo},
            "Apply makes the candidate the walk, past and present; drop takes it away.",
        )  # fmt: skip
        self._at_once: Input = controls.checkbox(
            "Apply at once", SetApplyAtOnce, False, "A moved slider changes the walk itself, without a ghost."
        )
        self.slots = controls.choice(
            "A / B", {"Keep as A": lambda: KeepAs("A"), "Keep as B": lambda: KeepAs("B"), "Swap": SwapAB},
            "Keep two settings and swap them (key B).",
        )  # fmt: skip
        self._kept = controls.html()

    def show(self, snapshot: Snapshot) -> None:
        """As the session is."""
        by = swinging.compared(snapshot.pendulum) if snapshot.pendulum else figures.COMPARED
        self._compared.show(figures.comparison(snapshot, by))
        self._kept.show(figures.slots(snapshot))
        self._at_once.show(snapshot.apply_at_once)


NO_GAINS = (
    '<div class="ss-note">This walk is estimated by the Kalman filter, which has no gains to find: choose the'
    " estimator <b>papers</b> under <b>Tune</b>, apply it, and search then.</div>"
)


class GainSearch:
    """ "Find gains": the button, its progress, the surface."""

    def __init__(self, controls: Controls) -> None:
        controls.gui.add_html(
            '<div class="ss-note">Estimates the walk so far at every pair of gains and offers the pair that'
            " ends nearest to the start: walk a loop and stop where you began.</div>"
        )
        self.button = controls.button("Find gains", FindGains)
        self._why_not = controls.html()
        self._progress = controls.gui.add_progress_bar(0.0, visible=False, animated=True)
        self._picture = controls.html()
        self._drawn: Sweep | None = None

    def show(self, snapshot: Snapshot, status: Status) -> None:
        """As the sweep is; there is none where the estimator has no gains."""
        running, none = status.sweep_progress is not None, snapshot.main.settings.estimator != "papers"
        self._progress.visible = running
        self.button.handle.disabled = running or none
        self._why_not.show(NO_GAINS if none else "")
        if status.sweep_progress is not None:
            private.set_progress(self._progress, status.sweep_progress)
        if status.sweep is not self._drawn:
            self._drawn = status.sweep
            self._picture.show(surface.picture(status.sweep) if status.sweep is not None else "")
