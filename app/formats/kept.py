"""Heart: the walk in an MCAP file of ours: what ``keeping`` wrote, to the bit, however much of it is left."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.clocks import recorded_line
from app.formats import cdr, journal, keeping, mcap
from app.formats.clean import countable
from app.formats.gathering import Contents, Doubles, Gathered, gather
from app.formats.raw import RawFoot
from app.motion.basics import Floats, InputError, Ints, Role, Vector, role_of
from app.motion.commands import Order, RestartHere
from app.motion.recording import Journal, Recording
from app.motion.samples import Sample, Samples
from app.settings import Settings

FORMAT = "Stridescope recording"
#: Who begins a walk anew when a source does: the stamps start over, so what came before is another walk.
SOURCE = "replay"


@dataclass(frozen=True)
class Readings:
    """All samples of one sensor as they came, [n]: ``place`` is the message's place in the file."""

    sensor: str
    role: Role
    place: Ints
    seq: Ints
    device_ns: Ints
    host_ns: Ints
    force: Floats  # [n, 3]
    rate: Floats  # [n, 3]
    field: Floats  # [n, 3] µT
    has_field: NDArray[np.bool_]
    saturation: NDArray[np.uint16]
    q_nb: Floats  # [n, 4], NaN where the device has none

    def __len__(self) -> int:
        return len(self.place)


class _Told(NamedTuple):
    """A message about a sensor's first ``rows`` samples."""

    place: int
    rows: int
    sensor: str
    data: bytes


@dataclass(frozen=True)
class Kept:
    """Everything in a file, in the order of the log. Places are those of ``Readings``."""

    about: dict[str, Any]
    readings: tuple[Readings, ...]
    starts: tuple[tuple[int, journal.Start], ...]
    orders: tuple[tuple[int, int, Order], ...]  # place, number, order
    markers: tuple[tuple[int, str], ...]
    events: tuple[dict[str, Any], ...]
    closed: bool
    damaged: int = 0  # chunks
    states: tuple[_Told, ...] = ()
    ways: tuple[_Told, ...] = ()
    messages: dict[str, int] = field(default_factory=dict)  # by topic
    temperatures: tuple[tuple[int, str, float], ...] = ()  # place, sensor, °C


def read(name: str, data: bytes) -> Recording:
    """The last walk in the file, with the log of its orders; ``InputError`` if there is no sample."""
    return recording_of(name, kept(name, data))


def kept(name: str, data: bytes) -> Kept:
    """Everything whole in a file; ``InputError`` if it is not one of ours."""
    try:
        contents = gather(data, _want)
        if not any(channel.schema.startswith("stridescope.") for channel in contents.channels.values()):
            whose = "another program's" if contents.channels else "no whole chunk in it"
            raise InputError(f"{name}: an MCAP file, but {whose}, expected a recording of Stridescope")
        return _kept(contents)
    except InputError:
        raise
    except (ValueError, OverflowError) as error:
        raise InputError(f"{name}: {error}, expected a recording of Stridescope") from None


def _want(channel: mcap.Channel) -> Doubles | bool:
    """The numbers of the samples, the words of people; what the estimator made is only counted."""
    kind = dict(channel.metadata).get("kind")
    if kind == keeping.IMU:
        return Doubles(cdr.IMU_DOUBLES, cdr.IMU_COLUMNS)
    if kind == keeping.FIELD:
        return Doubles(cdr.MAGNETIC_DOUBLES, (0, 1, 2))
    if kind == keeping.TEMPERATURE:
        return Doubles(cdr.TEMPERATURE_DOUBLES, (0,))
    return kind not in (keeping.POSE, keeping.STRIDES)


def _kept(contents: Contents) -> Kept:
    topics = {channel.topic: contents.gathered[number] for number, channel in contents.channels.items()}

    def said(topic: str) -> list[tuple[int, bytes]]:
        found = topics.get(topic)
        return list(zip(found.place.tolist(), found.data, strict=True)) if found else []

    told = [journal.from_json(data) for _, data in said(keeping.RECORDING)]
    about = {key: value for one in told for key, value in one.items()}  # what was learnt later, too
    starts = ((place, journal.read_start(data)) for place, data in said(keeping.START))
    orders = ((place, journal.read_order(data)) for place, data in said(keeping.ORDERS))
    texts = ((place, journal.from_json(data).get("text")) for place, data in said(keeping.MARKERS))
    return Kept(
        about=about,
        readings=_all_readings(contents, _roles(about)),
        starts=tuple((place, start) for place, start in starts if start is not None),
        orders=tuple((place, *order) for place, order in orders if order is not None),
        markers=tuple((place, text) for place, text in texts if isinstance(text, str)),
        events=tuple(journal.from_json(data) for _, data in said(keeping.EVENTS)),
        closed=contents.closed,
        damaged=contents.damaged,
        states=_told(contents, keeping.STATE),
        ways=_told(contents, keeping.WAY),
        temperatures=_temperatures(contents),
        messages={topic: len(found.place) for topic, found in topics.items() if len(found.place)},
    )


def _temperatures(contents: Contents) -> tuple[tuple[int, str, float], ...]:
    """What the sensors' thermometers read, in the file's order."""
    found = []
    for number, channel in contents.channels.items():
        about, own = dict(channel.metadata), contents.gathered[number]
        if about.get("kind") == keeping.TEMPERATURE and "sensor" in about and len(own.place):
            read = zip(own.place.tolist(), own.doubles[:, 0].tolist(), strict=True)
            found += [(place, about["sensor"], celsius) for place, celsius in read if math.isfinite(celsius)]
    return tuple(sorted(found))


def _told(contents: Contents, kind: str) -> tuple[_Told, ...]:
    """All messages of a kind, of all sensors, in the file's order."""
    found = []
    for number, channel in contents.channels.items():
        about, own = dict(channel.metadata), contents.gathered[number]
        if about.get("kind") == kind and "sensor" in about:
            columns = zip(own.place.tolist(), own.sequence.tolist(), own.data, strict=True)
            found += [_Told(place, rows, about["sensor"], data) for place, rows, data in columns]
    return tuple(sorted(found))


# --- samples -------------------------------------------------------------------------------------


def _roles(about: dict[str, Any]) -> dict[str, Role]:
    """Which sensor is which foot, as it was known at the end: a sensor may be named in mid-walk."""
    said = about.get("sensors")
    pairs = said.items() if isinstance(said, dict) else ()
    return {sensor: Role(role) for sensor, role in pairs if isinstance(role, str) and role in set(Role)}


def _all_readings(contents: Contents, told: dict[str, Role]) -> tuple[Readings, ...]:
    sensors: dict[str, dict[str, Gathered]] = {}
    roles: dict[str, Role] = {}
    clocks: dict[str, str] = {}
    for number, channel in contents.channels.items():
        metadata = dict(channel.metadata)
        if {"sensor", "kind", "clock_ns"} <= set(metadata):
            sensor = metadata["sensor"]
            sensors.setdefault(sensor, {})[metadata["kind"]] = contents.gathered[number]
            role = metadata.get("role", "")
            known = Role(role) if role in set(Role) else role_of(sensor)
            roles[sensor] = told.get(sensor, known)
            clocks[sensor] = metadata["clock_ns"]
    return tuple(
        _readings(sensor, roles[sensor], int(clocks[sensor]), kinds)
        for sensor, kinds in sensors.items()
        if keeping.IMU in kinds and len(kinds[keeping.IMU].place)
    )


def _readings(sensor: str, role: Role, clock_ns: int, kinds: dict[str, Gathered]) -> Readings:
    imu = kinds[keeping.IMU]
    place = imu.place
    q_nb, rate, force = cdr.imu_columns(imu.doubles)
    field_b = np.full((len(place), 3), math.nan)
    has_field = np.zeros(len(place), np.bool_)
    saturation = np.zeros(len(place), np.uint16)
    if keeping.FIELD in kinds and len(kinds[keeping.FIELD].place):
        rows = _rows(place, kinds[keeping.FIELD].place)
        field_b[rows] = cdr.microtesla(kinds[keeping.FIELD].doubles)
        has_field[rows] = True
    if keeping.EXTRA in kinds:
        extras = kinds[keeping.EXTRA]
        said = journal.all_from_json(extras.data)
        for row, extra in zip(_rows(place, extras.place).tolist(), said, strict=True):
            saturation[row] = _whole(extra.get("saturation"))
            exact = extra.get("field_ut")
            if isinstance(exact, list) and len(exact) == 3 and all(isinstance(x, float | int) for x in exact):
                field_b[row] = exact
    return Readings(
        sensor, role, place,
        seq=imu.sequence, device_ns=imu.publish_ns, host_ns=imu.log_ns - np.int64(clock_ns),
        force=force, rate=rate, field=field_b, has_field=has_field, saturation=saturation, q_nb=q_nb,
    )  # fmt: skip


def _rows(place: Ints, before: Ints) -> Ints:
    """The samples that messages which stand before them belong to."""
    rows = np.searchsorted(place, before)
    if len(rows) and int(rows[-1]) >= len(place):
        raise ValueError("a field without its sample")
    return rows.astype(np.int64)


def _whole(value: object) -> int:
    return value if isinstance(value, int) and 0 <= value < 2**16 else 0


def samples(found: Kept) -> list[Sample]:
    """Every sample as it was taken, in that order."""
    made = [(place, sample) for readings in found.readings for place, sample in _samples(readings)]
    return [sample for _, sample in sorted(made, key=lambda item: item[0])]


def _samples(readings: Readings) -> list[tuple[int, Sample]]:
    def vectors(table: Floats) -> list[Vector]:
        return [(x, y, z) for x, y, z in table.tolist()]

    columns = zip(
        readings.place.tolist(), readings.seq.tolist(),
        readings.device_ns.tolist(), readings.host_ns.tolist(),
        vectors(readings.force), vectors(readings.rate), vectors(readings.field), readings.has_field.tolist(),
        readings.saturation.tolist(), readings.q_nb.tolist(), strict=True,
    )  # fmt: skip
    return [
        (
            place,
            Sample(
                readings.sensor, seq, device_ns, host_ns, force, rate, field_b if has_field else None,
                saturation, None if math.isnan(q_nb[0]) else (q_nb[0], q_nb[1], q_nb[2], q_nb[3]),
            ),
        )
        for place, seq, device_ns, host_ns, force, rate, field_b, has_field, saturation, q_nb in columns
    ]  # fmt: skip


# --- as a recording ------------------------------------------------------------------------------


def recording_of(name: str, found: Kept) -> Recording:
    """The last walk of a file: what came since its source last began anew."""
    begin = _last_begin(found)
    raws = [(readings, readings.place >= begin) for readings in found.readings]
    sensors, places, hosts, clocks = [], [], [], {}
    for readings, here in raws:
        rows, dropped = countable(_raw(readings, here))
        if len(rows):
            rows = np.flatnonzero(here)[rows]
            sensors.append(_columns(readings, rows, dropped))
            places.append(readings.place[rows])
            hosts.append(int(readings.host_ns[rows[0]]))
            clocks[readings.sensor] = recorded_line(readings.device_ns[rows], readings.host_ns[rows])
    if not sensors:
        raise InputError(f"{name}: a recording without one usable sample, expected samples")
    return Recording(
        name=name,
        format=FORMAT,
        sensors=tuple(sensors),
        assumed=_sentences(found),
        spec=_text(found.about.get("spec")),
        dropped_rows=sum(sum(samples.dropped.values()) for samples in sensors),
        journal=_journal(found, begin, sensors, places, hosts),
        clocks=clocks,
        serials=_serials(found),
    )


def _serials(found: Kept) -> dict[str, str]:
    said = found.about.get("serials")
    pairs = said.items() if isinstance(said, dict) else ()
    return {sensor: serial for sensor, serial in pairs if isinstance(serial, str)}


def _last_begin(found: Kept) -> int:
    """The place of the last start that samples follow; 0 where the only one is the first."""
    last = max((int(readings.place[-1]) for readings in found.readings), default=0)
    return max((place for place, _ in found.starts if place < last), default=0)


def _raw(readings: Readings, here: NDArray[np.bool_]) -> RawFoot:
    return RawFoot(readings.sensor, readings.device_ns[here], readings.force[here], readings.rate[here])


def _columns(readings: Readings, rows: Ints, dropped: dict[str, int]) -> Samples:
    stamps = readings.device_ns[rows]
    matrix = np.column_stack([
        (stamps - stamps[0]).astype(np.float64),
        readings.force[rows], readings.rate[rows], readings.field[rows],
    ])  # fmt: skip
    matrix[~(np.abs(matrix[:, 7:10]) < 1e6).all(axis=1), 7:10] = math.nan
    q_nb = readings.q_nb[rows]
    return Samples(
        readings.sensor, readings.role, int(stamps[0]), matrix, readings.saturation[rows].copy(), dropped,
        None if np.isnan(q_nb[:, 0]).all() else q_nb,
    )  # fmt: skip


def _journal(
    found: Kept, begin: int, sensors: list[Samples], places: list[Ints], hosts: list[int]
) -> Journal:
    merged = np.concatenate(places)
    order = np.argsort(merged)
    elapsed = np.concatenate([
        samples.matrix[:, 0].astype(np.int64) + (host - min(hosts))
        for samples, host in zip(sensors, hosts, strict=True)
    ])  # fmt: skip
    elapsed_ns = np.maximum.accumulate(elapsed[order])
    merged = merged[order]
    start = next((start for place, start in reversed(found.starts) if place <= begin), None)
    start = start or next((start for _, start in found.starts), None)
    start = start or journal.Start(Settings(), Settings(), False)
    orders = (
        (int(np.searchsorted(merged, place)), order)
        for place, _, order in found.orders
        if place >= begin and not (isinstance(order.command, RestartHere) and order.who == SOURCE)
    )

    def counted(told: tuple[_Told, ...]) -> tuple[tuple[int, str, bytes], ...]:
        """Those about just the samples before them: none that was dropped, left out or of an earlier walk."""
        before = {samples.sensor: own for samples, own in zip(sensors, places, strict=True)}
        return tuple(
            (int(np.searchsorted(merged, place)), sensor, data)
            for place, rows, sensor, data in told
            if place >= begin and sensor in before and np.searchsorted(before[sensor], place) == rows
        )

    marks = ((int(np.searchsorted(merged, place)), text) for place, text in found.markers if place >= begin)
    return Journal(
        settings=start.settings,
        candidate=start.candidate,
        apply_at_once=start.apply_at_once,
        arrivals=np.repeat(np.arange(len(sensors)), [len(s) for s in sensors])[order],
        elapsed_ns=elapsed_ns,
        orders=tuple(orders),
        markers=tuple((float(elapsed_ns[max(place - 1, 0)]) * 1e-9, text) for place, text in marks),
        states=counted(found.states),
        ways=counted(found.ways),
        temperatures=tuple(
            (int(np.searchsorted(merged, place)), sensor, celsius)
            for place, sensor, celsius in found.temperatures
            if place >= begin
        ),
    )


def _sentences(found: Kept) -> tuple[str, ...]:
    said = found.about.get("assumed")
    sentences = [text for text in said if isinstance(text, str)] if isinstance(said, list) else []
    source, device = _text(found.about.get("source")), _text(found.about.get("device"))
    sentences += [f"read as {device}"] if device else []
    sentences += [f"recorded from {source}"] if source else []
    sentences += [] if found.closed else ["the recording was cut short: what is whole of it is shown"]
    places = f"{found.damaged} place{'s' * (found.damaged > 1)}"
    sentences += [f"the file is damaged in {places}: what is whole of it is shown"] if found.damaged else []
    lost = sum(_whole(event.get("samples")) for event in found.events if event.get("event") == "lost")
    sentences += [f"{lost} samples were not recorded: the disk was too slow"] if lost else []
    return tuple(sentences)


def _text(value: object) -> str | None:
    return value if isinstance(value, str) and value else None


def lost_seqs(readings: Readings) -> int:
    """Samples missing between the first and the last, by their sequence numbers."""
    steps = Counter(np.diff(readings.seq).tolist())
    return sum((step - 1) * count for step, count in steps.items() if step > 1)
