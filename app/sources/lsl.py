"""Edge: ``lsl:NAME``: streams of the Lab Streaming Layer, each a sensor. An optional extra."""

from __future__ import annotations

import logging
import threading
import time
from typing import Any

from app.formats.wire.lsl import TYPE, Channel, StreamReader, sensor_of
from app.motion.basics import InputError
from app.sources.inbox import Inbox
from app.sources.listening import options_of
from app.sources.spec import Spec

_log = logging.getLogger(__name__)

LOOK_S = 1.0  # between looks for streams
_PULL_S = 0.005
_BUFFER_S = 60
_MOST_STREAMS = 32


def library() -> Any:
    """pylsl; ``InputError`` says how to have it."""
    try:
        import pylsl  # optional, and it loads a library of the system
    except (ImportError, RuntimeError, OSError) as error:
        raise InputError(
            f"lsl: the Lab Streaming Layer is not installed ({str(error).splitlines()[0]}): "
            "pip install -e '.[lsl]', and liblsl where that brings none"
        ) from None
    return pylsl


class LslSource(Inbox):
    """All streams whose name begins with NAME, or of type IMU where none is given; later ones too."""

    def __init__(self, spec: Spec) -> None:
        self._pylsl = library()
        self._options, _ = options_of(spec)
        self._wanted = spec.target
        self._readers: dict[str, tuple[Any, StreamReader]] = {}  # by the stream's identity
        self._unusable: set[str] = set()
        self._notes: list[str] = []
        super().__init__(f"lsl:{spec.target}", "Lab Streaming Layer", lambda: self._notes, self._lost)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="lsl", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Leave the streams."""
        self._ending.set()
        self._thread.join(2.0)

    def _lost(self) -> dict[str, int]:
        return {"unusable readings": sum(reader.rejected for _, reader in list(self._readers.values()))}

    def _run(self) -> None:
        resolver = self._resolver()
        look_at = 0.0
        while not self._ending.is_set():
            if time.monotonic() >= look_at:
                look_at = time.monotonic() + LOOK_S
                for info in resolver.results():
                    self._open(info)
            for inlet, reader in self._readers.values():
                self._pull(inlet, reader)
            self._ending.wait(_PULL_S)
        for inlet, _ in self._readers.values():
            inlet.close_stream()

    def _resolver(self) -> Any:
        """Looks all the time; quotes in a name would end it in the query."""
        if not self._wanted:
            return self._pylsl.ContinuousResolver("type", TYPE)
        safe = self._wanted.replace("'", "").replace('"', "")
        return self._pylsl.ContinuousResolver(pred=f"starts-with(name,'{safe}')")

    def _open(self, found: Any) -> None:
        identity = found.source_id() or found.uid()
        if identity in self._readers or identity in self._unusable or len(self._readers) >= _MOST_STREAMS:
            return
        flags = self._pylsl.proc_clocksync
        try:
            inlet = self._pylsl.StreamInlet(found, max_buflen=_BUFFER_S, recover=True, processing_flags=flags)
            info = inlet.info(timeout=2.0)
            inlet.open_stream(timeout=2.0)
        except (TimeoutError, RuntimeError, ValueError) as error:  # gone meanwhile
            _log.info("lsl: a stream could not be opened: %s", error)
            return
        description = info.desc()
        sensor = self._as_told(sensor_of(description.child_value("foot"), info.name()))
        reader = StreamReader(sensor, _channels(info), description.child_value("axes"), self._options.axes)
        if not reader.usable:
            self._unusable.add(identity)
            self._notes = [
                *self._notes,
                f"{info.name()}: no channels acc_x… and gyr_x… by their labels: left out",
            ]
            return
        self._notes = [
            *self._notes,
            f"{sensor}: the stream {info.name()} of {info.hostname()}",
            *reader.notes,
        ]
        self._readers = {**self._readers, identity: (inlet, reader)}

    def _as_told(self, sensor: str) -> str:
        """As the person says; two that say the same are told apart by a number."""
        sensor = self._options.foot if self._options.foot and not self._readers else sensor
        taken = set(self.info.sensors)
        return next(n for n in (sensor, *(f"{sensor}-{i}" for i in range(2, 99))) if n not in taken)

    def _pull(self, inlet: Any, reader: StreamReader) -> None:
        try:
            rows, stamps = inlet.pull_chunk(timeout=0.0, max_samples=1024)
        except self._pylsl.LostError:
            return
        host_ns = time.monotonic_ns()
        made = (reader.read(t, row, host_ns) for row, t in zip(rows, stamps, strict=True))
        self.put([sample for sample in made if sample is not None])


def _channels(info: Any) -> list[Channel]:
    """The channels that the meta-data describe, as many as the stream has."""
    found = []
    channel = info.desc().child("channels").child("channel")
    for _ in range(info.channel_count()):
        told = [channel.child_value(key) for key in ("label", "unit", "type")]
        found.append(Channel(*told))
        channel = channel.next_sibling("channel")
    return found
