"""Edge, scene: how sound each sensor's stream is: one light with a word and its reason, and the figures."""

from __future__ import annotations

from app.motion.health import Health, Light, Recent
from app.motion.snapshot import Snapshot
from app.motion.status import Status
from app.scene import words
from app.scene.controls import Controls
from app.scene.figures import FEET, is_stale

#: Shape, colour and word together: nobody has to tell green from red.
SHAPES = {Light.GREEN: "●", Light.AMBER: "▲", Light.RED: "■"}
WORDS = {Light.GREEN: "GOOD", Light.AMBER: "CHECK", Light.RED: "BAD"}


class Soundness:
    """A line for each sensor under the header."""

    def __init__(self, controls: Controls) -> None:
        self._lights = controls.html()

    def show(self, snapshot: Snapshot, status: Status) -> None:
        """As it is now."""
        self._lights.show(lights(snapshot, status))


def lights(snapshot: Snapshot, status: Status) -> str:
    """The light of each sensor; what is stale is not called good."""
    roles = {foot.sensor: foot.role for foot in snapshot.main.feet}
    lines = []
    for sensor, health in snapshot.health.items():
        if health.recent is None or sensor not in roles:
            continue
        light = Light.RED if is_stale(status) else health.light
        reason = health.reason or FEET[roles[sensor]].lower() + _steady(health.recent)
        told = (
            f"no samples for {words.number(status.stale_s, 1)} s" if is_stale(status) else words.plain(reason)
        )
        lines.append(
            f'<div class="ss-light ss-{light.value}"><b><i>{SHAPES[light]}</i>{WORDS[light]}</b>'
            f"<span>{told}</span></div>"
        )
    return "".join(lines)


def _steady(recent: Recent) -> str:
    lost = "nothing lost" if not recent.lost else f"{recent.lost} lost"
    return f": {words.number(recent.rate_hz, 0)} Hz, {lost} in 10 s" if recent.rate_hz else ": counting…"


def tables(snapshot: Snapshot) -> str:
    """The last ten seconds of every sensor."""
    return "".join(
        f'<div class="ss-note">{words.plain(sensor, 40)}, the last ten seconds</div><table class="ss-table">'
        + "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in table(health))
        + "</table>"
        for sensor, health in snapshot.health.items()
        if health.recent is not None
    )


def table(health: Health) -> list[tuple[str, str]]:
    """The figures of the last ten seconds, as names and values."""
    r = health.recent
    if r is None:
        return []
    all_of = r.samples + r.lost
    rows = [
        ("lost", f"{r.lost} of {all_of} ({words.percent(r.lost, all_of)})"),
        ("twice, rejected", f"{r.duplicated}, {r.rejected}"),
        ("saturated", f"{r.saturated} ({words.percent(r.saturated, r.samples)})"),
    ]
    if r.damaged:
        rows.append(("damaged packets", f"{words.number(100 * r.damaged, 1)} %"))
    if r.jitter_ms is not None:
        rows.append(("jitter, latest", f"{words.number(r.jitter_ms, 1)} ms, {words.number(r.late_ms, 0)} ms"))
    if r.stance_mps2 is not None:
        scatter, gravity = words.number(r.stance_mps2, 2), words.number(r.gravity_mps2, 2)
        rows.append(("force at stance", f"{gravity} ± {scatter} m/s²"))
    if r.disturbance is not None:
        rows.append(("field strays by", f"{words.number(100 * r.disturbance, 0)} %"))
    if r.drift_ppm is not None:
        rows.append(("clock drift", f"{words.signed(r.drift_ppm, 1)} ppm"))
    return rows
