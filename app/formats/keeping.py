"""Heart: a walk into the chunks of an MCAP file: samples as ROS 2 messages, the rest as JSON.

What the ROS messages cannot say of a sample (saturation, a field whose microtesla do not survive
tesla) stands before it in a message of ours, ``/NAME/extra``, only where there is something to say.
The sensor's clock is the message's publish time (modulo 2⁶⁴), the host's its log time less ``clock_ns``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from app.formats import cdr, journal, states
from app.formats.mcap import Writer
from app.motion.basics import Quaternion, Role, Vector
from app.motion.commands import Order
from app.motion.estimate import Saved, Stride, Way
from app.motion.samples import Sample

RECORDING = "/stridescope/recording"
START = "/stridescope/start"
ORDERS = "/stridescope/orders"
MARKERS = "/stridescope/markers"
EVENTS = "/stridescope/events"
IMU, FIELD, EXTRA, POSE, STRIDES = "imu", "magnetic_field", "extra", "pose", "strides"
TEMPERATURE = "temperature"
STATE, WAY = "state", "trail"
FRAME_N = "ned"

_OURS = {
    RECORDING: ("Recording", "About the recording: versions, source, sensors, mounting."),
    START: ("Start", "Settings of the main track and of the sliders where the log begins."),
    ORDERS: ("Order", "What a person asked for: who, when, and after how many samples and orders."),
    MARKERS: ("Marker", "A moment that a person marked."),
    EVENTS: ("Event", "What happened to the recording itself."),
}


class _Channels(NamedTuple):
    imu: int
    field: int
    extra: int
    temperature: int
    pose: int
    strides: int
    state: int
    way: int


class Keeper:
    """Takes a walk piece by piece; ``chunk`` gives the bytes of what came since the last one.

    ``clock_ns`` is what turns a host stamp into nanoseconds since 1970. Who holds ``key`` believes states.
    """

    def __init__(
        self, about: Mapping[str, object], roles: Mapping[str, Role], clock_ns: int, key: bytes = b""
    ) -> None:
        self.mcap = Writer()
        self._key = key
        self._clock_ns = clock_ns
        self._roles = roles
        self._sensors: dict[str, _Channels] = {}
        self._ours = {topic: self._json(topic, *words) for topic, words in _OURS.items()}
        self._about = {**about, "clock_ns": clock_ns}

    def begin(self, host_ns: int) -> bytes:
        """The first bytes of the file; the first chunk will tell about the recording."""
        self._say(RECORDING, host_ns, journal.to_json(self._about))
        return self.mcap.begin()

    def learnt(self, host_ns: int, more: Mapping[str, object]) -> None:
        """What became known of the source since."""
        self._about |= more
        self._say(RECORDING, host_ns, journal.to_json(self._about))

    def sample(self, sample: Sample) -> None:
        """One sample, as it was taken: unusable ones too."""
        channels = self._sensors.get(sample.sensor) or self._sensor(sample.sensor)
        name, device_ns = sample.sensor, sample.device_ns
        stamps = (sample.seq, sample.host_ns + self._clock_ns, device_ns)
        extra: dict[str, object] = {"saturation": sample.saturation} if sample.saturation else {}
        if sample.field_b is not None:
            field_t = cdr.tesla(sample.field_b)
            if not cdr.comes_back(sample.field_b, field_t):
                extra["field_ut"] = sample.field_b
            self.mcap.add(channels.field, *stamps, cdr.magnetic_field(device_ns, name, field_t))
        if extra:
            self.mcap.add(channels.extra, *stamps, journal.to_json(extra))
        force, rate = sample.specific_force_b, sample.angular_rate_b
        imu = cdr.imu(device_ns, name, sample.device_q_nb, rate, force)
        self.mcap.add(channels.imu, *stamps, imu)

    def order(self, number: int, order: Order) -> None:
        """An order, after the samples that came before it."""
        self._say(ORDERS, order.host_ns, journal.write_order(number, order))

    def start(self, host_ns: int, start: journal.Start) -> None:
        """What the session holds now, after a source has begun anew too."""
        self._say(START, host_ns, journal.write_start(start))

    def marker(self, host_ns: int, who: str, text: str) -> None:
        """A moment that somebody marked."""
        self._say(MARKERS, host_ns, journal.to_json({"text": text, "who": who}))

    def event(self, host_ns: int, what: str, **figures: object) -> None:
        """Something that happened to the recording: samples that could not be kept, its end."""
        self._say(EVENTS, host_ns, journal.to_json({"event": what, **figures}))

    def temperature(self, sensor: str, host_ns: int, celsius: float) -> None:
        """What a sensor's thermometer reads by now."""
        channels = self._sensors.get(sensor) or self._sensor(sensor)
        log_ns = host_ns + self._clock_ns
        data = cdr.temperature(log_ns, sensor, celsius)
        self.mcap.add(channels.temperature, 0, log_ns, log_ns, data)

    def pose(self, sensor: str, host_ns: int, position_n: Vector, q_nb: Quaternion) -> None:
        """Where the main track has a foot, as drawn."""
        channels = self._sensors.get(sensor)
        if channels is not None:
            log_ns = host_ns + self._clock_ns
            data = cdr.pose(log_ns, FRAME_N, position_n, q_nb)
            self.mcap.add(channels.pose, 0, log_ns, log_ns, data)

    def stride(self, sensor: str, host_ns: int, stride: Stride) -> None:
        """A stride that ended: an initial contact, and the terminal contact before it."""
        channels = self._sensors.get(sensor)
        if channels is not None:
            log_ns = host_ns + self._clock_ns
            self.mcap.add(channels.strides, stride.number, log_ns, log_ns, journal.to_json(stride._asdict()))

    def estimate(self, sensor: str, host_ns: int, saved: Saved, way: Callable[[], Way]) -> None:
        """A foot's estimate after the samples that came before it, and the way it has come since the last."""
        channels = self._sensors.get(sensor)
        if channels is not None:
            log_ns, made = host_ns + self._clock_ns, way()
            self.mcap.add(channels.way, made.last, log_ns, log_ns, states.write_way(made))
            self.mcap.add(channels.state, saved.row, log_ns, log_ns, states.write_state(saved, self._key))

    def chunk(self) -> bytes:
        """The bytes of what came since the last chunk."""
        return self.mcap.chunk()

    def end(self) -> bytes:
        """The last chunk and the file's summary."""
        return self.mcap.chunk() + self.mcap.end()

    def _say(self, topic: str, host_ns: int, data: bytes) -> None:
        log_ns = host_ns + self._clock_ns
        self.mcap.add(self._ours[topic], 0, log_ns, log_ns, data)

    def _json(self, topic: str, name: str, sentence: str, **metadata: str) -> int:
        schema: dict[str, Any] = {"type": "object", "title": name, "description": sentence}
        text = journal.to_json(schema).decode()
        return self.mcap.channel(topic, "json", f"stridescope.{name}", text, tuple(metadata.items()))

    def _ros(self, topic: str, kind: str, metadata: dict[str, str]) -> int:
        return self.mcap.channel(topic, "cdr", kind, cdr.DEFINITIONS[kind], tuple(metadata.items()))

    def _sensor(self, sensor: str) -> _Channels:
        role = self._roles.get(sensor)
        about = {"sensor": sensor, "clock_ns": str(self._clock_ns)} | ({"role": role.value} if role else {})

        def topic(kind: str) -> str:
            return f"/{sensor}/{kind}"

        made = _Channels(
            imu=self._ros(topic(IMU), cdr.IMU, about | {"kind": IMU}),
            field=self._ros(topic(FIELD), cdr.MAGNETIC_FIELD, about | {"kind": FIELD}),
            extra=self._json(topic(EXTRA), "Extra", "Of a sample, what the others cannot say.",
                             **about, kind=EXTRA),
            temperature=self._ros(topic(TEMPERATURE), cdr.TEMPERATURE, about | {"kind": TEMPERATURE}),
            pose=self._ros(topic(POSE), cdr.POSE, about | {"kind": POSE}),
            strides=self._json(topic(STRIDES), "Stride", "From one initial contact to the next.",
                               **about, kind=STRIDES),
            state=self._json(topic(STATE), "State", "The estimator between two swings, to go on from.",
                             **about, kind=STATE),
            way=self._json(topic(WAY), "Trail", "The way since the last, decimated: lines, metres.",
                           **about, kind=WAY),
        )  # fmt: skip
        self._sensors[sensor] = made
        return made
