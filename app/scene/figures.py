"""Edge, scene: what the panel says, as HTML: pure functions of snapshot and status."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import fields

from app.limits import Limit, Value
from app.motion.basics import GaitPhase, Role
from app.motion.snapshot import FootView, OwnView, Snapshot
from app.motion.source import Link
from app.motion.status import Status
from app.scene import words
from app.scene.guard import drawable
from app.settings import LIMITS, Settings

STALE_AFTER_S = 0.5
FEET = {Role.LEFT: "Left foot", Role.RIGHT: "Right foot", Role.FOOT: "Foot", Role.OTHER: "Sensor"}
LINKS = {
    Link.WAITING: "waiting for samples", Link.LIVE: "live", Link.PAUSED: "paused", Link.ENDED: "ended",
    Link.LOST: "connection lost",
}  # fmt: skip
Compared = tuple[tuple[str, Callable[[FootView], float], int, str], ...]
"""What a candidate is held against the main track by: name, figure, digits, unit."""
COMPARED: Compared = (
    ("To start", lambda foot: foot.to_start_m, 2, "m"),
    ("Distance", lambda foot: foot.distance_m, 2, "m"),
    ("Strides", lambda foot: foot.strides, 0, ""),
)
LINKED = '<div class="ss-note">Feet linked: one heading, by how far apart they can be.</div>'
UNLINKED = '<div class="ss-note">Feet not linked: each has its own origin and start heading.</div>'


def is_stale(status: Status) -> bool:
    """Whether what is shown is older than a person would think."""
    return status.stale_s > STALE_AFTER_S and status.link is not Link.ENDED


def header(status: Status) -> str:
    """Source, its state, and the big sign when data stopped."""
    name = words.plain(status.source.name, 60)
    link = f'<span class="ss-link ss-{status.link.value}">{LINKS[status.link]}</span>'
    age = words.number(status.stale_s, 1)
    stale = f'<div class="ss-stale">STALE <b>{age} s</b></div>' if is_stale(status) else ""
    detail = f'<div class="ss-note">{words.plain(status.detail)}</div>' if status.detail else ""
    return f'<div class="ss-head"><span class="ss-source">{name}</span>{link}</div>{detail}{stale}'


def message(snapshot: Snapshot, status: Status) -> str:
    """One clear line, if there is something to say."""
    lost = [FEET[f.role].lower() for f in snapshot.main.feet if not drawable(f)]
    if lost:
        text = f"The estimate of the {' and '.join(lost)} is not a finite number: shown at its last place."
        return f'<div class="ss-message ss-bad">{text}</div>'
    if status.message:
        return f'<div class="ss-message">{words.plain(status.message)}</div>'
    return ""


def feet(snapshot: Snapshot, own: bool = False, warmth: Mapping[str, float] | None = None) -> str:
    """A card per foot; ``own``: the walks by the sensors' own orientations are seen; ``warmth``: their °C."""
    cards = "".join(_card(foot, sensor(snapshot, foot.sensor, warmth or {})) for foot in snapshot.main.feet)
    note = ""
    if len(snapshot.main.feet) > 1:
        note = LINKED if snapshot.main.linked else UNLINKED
    return (
        cards + note + hindsight(snapshot) + legend(snapshot, own)
        if cards
        else '<div class="ss-note">No foot yet.</div>'
    )


def hindsight(snapshot: Snapshot) -> str:
    """What a walk whose settings ask for hindsight shows: its live estimate, or the smoothed one."""
    track = snapshot.main
    if not track.settings.looks_back:
        return ""
    if track.smoothed_s is None:
        return '<div class="ss-note">Hindsight: live until the walk is paused or over, then smoothed.</div>'
    now = "" if snapshot.t_s <= track.smoothed_s else ", live since"
    return f'<div class="ss-note">Hindsight: smoothed up to {words.clock(track.smoothed_s)}{now}.</div>'


def legend(snapshot: Snapshot, own: bool = False) -> str:
    """Which line is which."""
    lines = [("walk", "walk"), ("newest", "newest stride, provisional")]
    lines += [("candidate", "candidate")] if snapshot.candidate else []
    lines += [("truth", "truth")] if snapshot.truth else []
    lines += [("own", "by the sensor's own orientation")] if own and snapshot.own else []
    keys = "".join(f'<span><i class="ss-{name}"></i>{label}</span>' for name, label in lines)
    return f'<div class="ss-legend">{keys}</div>'


def _card(foot: FootView, of_sensor: str) -> str:
    error = foot.error_m
    known = ("Error to truth", *words.metres(error)) if error is not None else None
    tiles = [
        ("Strides", f"{foot.strides}", ""),
        ("Distance", *words.metres(foot.distance_m)),
        ("Speed", words.number(foot.speed_mps), "m/s"),
        ("Cadence", words.number(foot.cadence_spm, 0), "steps/min"),
        ("Height", words.number(foot.height_m), "m"),
        ("To start", *words.metres(foot.to_start_m)),
        ("of distance", words.percent(_closure_m(foot), foot.distance_m), ""),
        known or ("Walked", words.clock(foot.t_s), ""),
    ]
    grid = "".join(tile(*one) for one in tiles)
    return (
        f'<div class="ss-card ss-{foot.role.value}"><div class="ss-card-head"><span class="ss-dot"></span>'
        f'{FEET[foot.role]}{trust(foot)}{badge(foot)}</div><div class="ss-tiles">{grid}</div>'
        f"{toe(foot)}{compass(foot)}{of_sensor}</div>"
    )


def toe(foot: FootView) -> str:
    """How the sensor sits on the shoe, where the first strides told that it looks elsewhere."""
    if foot.toe is None:
        return ""
    degrees = round(math.degrees(foot.toe.angle_rad))
    side = "left" if degrees > 0 else "right"
    how = (
        f"the sensor is mounted {abs(degrees)}° to the {side}"
        if abs(degrees) < 170
        else "the sensor looks backward"
    )
    return f'<div class="ss-note">Toe direction found from {foot.toe.strides} strides: {how}.</div>'


def compass(foot: FootView) -> str:
    """Whether a magnetometer could be believed at the last footprints, and why not."""
    if foot.compass is None:
        return ""
    word = f"not to be trusted: {words.plain(foot.compass.why)}; the gyro alone holds the heading"
    if foot.compass.steady:
        word = "steady: it holds the heading" if foot.compass.holds else "steady"
    return f'<div class="ss-note">Magnetic field {word}.</div>'


def sensor(snapshot: Snapshot, name: str, warmth: Mapping[str, float]) -> str:
    """How warm it is, and how warm it was when the gyro bias was found that the walk began with."""
    found, now = snapshot.remembered.get(name), warmth.get(name)
    degrees = f"{words.number(now, 0)} °C"
    if found is None:
        return "" if now is None else f'<div class="ss-note">Sensor at {degrees}.</div>'
    told = "" if now is None else f"; now {degrees}"
    return f'<div class="ss-note">Gyro bias remembered {words.plain(found, 60)}{told}.</div>'


def trust(foot: FootView) -> str:
    """How sure the estimator is: half the long axis of the 95 % ellipse, and a word with its reason."""
    if foot.trust is None:
        return ""
    sure = foot.trust
    away = " ".join(words.metres(sure.major_m))
    why = f": {words.plain(sure.why)}" if sure.why else ""
    return f'<small title="95 times of 100 within this">&nbsp;± {away}, {words.plain(sure.word)}{why}</small>'


def badge(foot: FootView) -> str:
    """The gait phase: colour, shape and word."""
    if not foot.levelled:
        return '<span class="ss-phase ss-levelling">STAND STILL…</span>'
    stance = foot.phase is GaitPhase.STANCE
    mark, name = ("▬", "stance") if stance else ("▲", "swing")
    return f'<span class="ss-phase ss-{name}"><i>{mark}</i>{name.upper()}</span>'


def tile(label: str, value: str, unit: str) -> str:
    """One figure of a card."""
    small = f" <small>{unit}</small>" if unit else ""
    return f'<div class="ss-tile"><label>{label}</label><b>{value}</b>{small}</div>'


def source(snapshot: Snapshot, status: Status) -> str:
    """Format, rate, what was dropped, what was assumed."""
    info = status.source
    rows = [("Source", words.plain(info.name, 80)), ("Format", words.plain(info.format, 80))]
    if info.rate_hz > 0:
        rows.append(("Nominal rate", f"{words.number(info.rate_hz, 1)} Hz"))
    if info.dropped:
        rows.append(("Dropped on import", words.counts(dict(info.dropped))))
    if info.line:
        rows.append(("Line", ", ".join(f"{count} {words.plain(what)}" for what, count in info.line.items())))
    for sensor, health in snapshot.health.items():
        rows.append((words.plain(sensor, 40), _health(health.rate_hz, health.taken, health.segments)))
        rows.append(("· dropped", words.counts(dict(health.dropped))))
        rows.append(("· saturated", f"{health.saturated} samples"))
    rows += [(f"· its own walk ({words.plain(name, 40)})", _own(own)) for name, own in snapshot.own.items()]
    stored, budget = words.megabytes(snapshot.stored_bytes), words.megabytes(snapshot.budget_bytes)
    rows.append(("Memory", f"{stored} of {budget}"))
    rows.append(("Hindsight from", words.clock(snapshot.hindsight_from_s)))
    rows.append(("Frame", _frame(snapshot)))
    body = "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows)
    return f'<table class="ss-table">{body}</table>{_assumed(info.assumed)}'


def _health(rate_hz: float, taken: int, segments: int) -> str:
    plural = "" if segments == 1 else "s"
    return f"{words.number(rate_hz, 1)} Hz, {taken} samples, {segments} segment{plural}"


def _closure_m(foot: FootView) -> float:
    """From the start to the last footprint, which is as far as ``distance_m`` counts, also in a swing."""
    north, east, _ = foot.footprints[-1].position_n if foot.footprints else foot.position_n
    return math.hypot(north, east)


def _own(own: OwnView) -> str:
    """The walk by the sensor's own orientation, beside ours."""
    tilt, heading = (words.number(math.degrees(angle), 1) for angle in (own.tilt_rad, abs(own.heading_rad)))
    walked, back = (" ".join(words.metres(length)) for length in (own.distance_m, own.to_start_m))
    return f"{walked}, {back} to start; tilt {tilt}° and heading {heading}° from ours"


def _frame(snapshot: Snapshot) -> str:
    north = "magnetic north" if snapshot.main.settings.magnetometer else "the start heading"
    return f"north–east–down; N on the floor is {north}"


def _assumed(sentences: tuple[str, ...]) -> str:
    if not sentences:
        return '<div class="ss-note">Nothing assumed: the source says its rate, units and mounting.</div>'
    items = "".join(f"<li>{words.plain(s)}</li>" for s in sentences)
    return f'<div class="ss-assumed"><b>Assumed</b><ul>{items}</ul></div>'


def log(snapshot: Snapshot, rate_hz: float) -> str:
    """The newest changes: when, what, who."""
    if not snapshot.changes:
        return '<div class="ss-note">No change applied yet.</div>'
    rows = "".join(
        f"<tr><th>{_when(change.number, rate_hz)}</th><td>{words.plain(change.what, 160)}"
        f"<small>{words.plain(change.who, 40)}</small></td></tr>"
        for change in snapshot.changes[:-9:-1]
    )
    return f'<table class="ss-table ss-log">{rows}</table>'


def _when(number: int, rate_hz: float) -> str:
    return words.clock(number / rate_hz) if rate_hz > 0 else f"sample {number}"


def position(status: Status) -> str:
    """Where a replay is."""
    length = status.source.duration_s
    whole = f" of {words.clock(length)}" if length is not None else ""
    pace = "as fast as possible" if status.speed == 0 else f"{words.number(status.speed, 1)}× pace"
    return (
        f'<div class="ss-position"><span>{words.clock(status.position_s)}{whole}</span>'
        f"<span>{LINKS[status.link]} · {pace}</span></div>"
    )


def _undo(depth: int) -> str:
    return f"{depth} change{'' if depth == 1 else 's'} to undo"


def differences(one: Settings, other: Settings) -> str:
    """What differs, by symbol and unit: ``k_s 1.05 → 1.6 1/s``."""
    names = [f.name for f in fields(Settings) if getattr(one, f.name) != getattr(other, f.name)]
    told = [_difference(LIMITS[n], getattr(one, n), getattr(other, n)) for n in names]
    return ", ".join(told) or "same settings"


def _difference(limit: Limit, before: Value, after: Value) -> str:
    if isinstance(before, bool):
        return f"{limit.label} {'on' if after else 'off'}"
    if isinstance(before, float) and isinstance(after, float):
        k, unit = (math.degrees(1.0), "°") if limit.unit == "rad" else (1.0, limit.unit)
        return f"{limit.symbol or limit.label} {before * k:.4g} → {after * k:.4g} {unit}"
    return f"{limit.label} {before} → {after}"


def comparison(snapshot: Snapshot, by: Compared = COMPARED) -> str:
    """The candidate beside the main track, ``by`` these figures.

    As tall without a candidate as with one: the slider under a hand must not move away.
    """
    others = {f.sensor: f for f in snapshot.candidate.feet} if snapshot.candidate else {}
    feet = snapshot.main.feet
    body = "".join(_compared(main, others.get(main.sensor), by, len(feet) > 1) for main in feet)
    pending = '<span class="ss-pending">re-estimating…</span>' if snapshot.pending else ""
    return (
        '<div class="ss-candidate"><div class="ss-card-head"><span class="ss-dot"></span>Candidate'
        f'{pending}</div><div class="ss-what">{_what(snapshot)}</div><table class="ss-compare">'
        f"<tr><td></td><th>main</th><th>candidate</th><th>change</th></tr>{body}</table></div>"
    )


def _what(snapshot: Snapshot) -> str:
    if snapshot.candidate is None:
        return "none: move a slider to make one"
    return words.plain(differences(snapshot.main.settings, snapshot.candidate.settings), 200)


def _compared(main: FootView, other: FootView | None, by: Compared, named: bool) -> str:
    head = f'<tr><th class="ss-who" colspan="4">{FEET[main.role]}</th></tr>' if named else ""
    return head + "".join(
        f"<tr><td>{name}</td>{_cells(figure(main), figure(other) if other else None, digits, unit)}</tr>"
        for name, figure, digits, unit in by
    )


def _cells(main: float, other: float | None, digits: int, unit: str) -> str:
    if other is None:
        return f"<td>{words.number(main, digits)} {unit}</td><td>{words.DASH}</td><td>{words.DASH}</td>"
    texts = (words.number(main, digits), words.number(other, digits), words.signed(other - main, digits))
    return "".join(f"<td>{text} {unit}</td>" for text in texts)


def slots(snapshot: Snapshot) -> str:
    """What A and B hold, and which is on."""
    marks = []
    for slot in ("A", "B"):
        kept = snapshot.slots.get(slot)
        state = "on" if snapshot.slot_now == slot else "kept" if kept is not None else "empty"
        marks.append(f'<span class="ss-slot ss-{state}">{slot} {state}</span>')
    return f'<div class="ss-slots">{"".join(marks)}<span>{_undo(snapshot.undo_depth)}</span></div>'
