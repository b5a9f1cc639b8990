"""Edge: from a SPEC to a source: a file, a simulator (and its truth), or a live link."""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial

import numpy as np

from app.motion.basics import InputError
from app.motion.recording import Recording
from app.motion.source import Truth
from app.simulate.calibration import make_calibration
from app.simulate.gestures import make_gestures
from app.simulate.hanging import make_pendulum
from app.simulate.walk import make_walk
from app.sources.files import load
from app.sources.laboratory import Laboratory
from app.sources.lsl import LslSource
from app.sources.phone import PhoneSource
from app.sources.replay import Replay
from app.sources.serial_spec import open_serial
from app.sources.source import Source
from app.sources.spec import LIVE, Spec, parse_spec
from app.sources.udp import UdpSource
from app.sources.ws import WsSource

_log = logging.getLogger(__name__)

_SAME = 1e-6  # m/s², rad/s: another machine's sines differ in the last digits


def open_source(
    spec_text: str,
    *,
    finish: bool = False,
    changes: bool = True,
    stretches: bool = False,
    key: bytes = b"",
) -> Source:
    """The source a SPEC names, at the pace it asks for; ``InputError`` if there is none.

    ``finish``: the source ends after the last sample instead of waiting for a seek. ``changes``: a
    recording of ours repeats the changes made to its walk, if the SPEC does not say otherwise.
    ``stretches``: a long seek gives its samples as ``Stretch``; ``key``: or as ``Landing``, by states that
    were saved with the same key.
    """
    spec = parse_spec(spec_text)
    if spec.kind in LIVE:
        return open_live(spec)
    recording, truth = open_recording(spec)
    kind = partial(Laboratory, seed=int(spec.options.get("seed", 0))) if spec.kind == "sim" else Replay
    return kind(
        recording, speed=spec.speed, loop=spec.loop, finish=finish, changes=changes and spec.changes,
        truth=truth, stretches=stretches, key=key,
    )  # fmt: skip


def open_live(spec: Spec) -> Source:
    """The live source of each kind."""
    kinds: dict[str, Callable[[Spec], Source]] = {
        "serial": open_serial,
        "ws": WsSource,
        "udp": UdpSource,
        "phone": PhoneSource,
        "lsl": LslSource,
    }
    return kinds[spec.kind](spec)


def open_recording(spec: Spec) -> tuple[Recording, Truth | None]:
    """All samples of a file or of a simulated walk, and the simulator's truth if it made them."""
    if spec.kind == "sim":
        return _simulated(spec)
    if spec.kind in LIVE:
        raise InputError(f"{spec.kind}:{spec.target}: a live source, expected a recording or sim:walk")
    recording = load(spec.target, spec.options)
    return recording, _truth_of(recording)


def _simulated(spec: Spec) -> tuple[Recording, Truth | None]:
    if spec.target == "gestures":
        gestures = make_gestures(spec.options)
        return gestures.recording, gestures.truth
    if spec.target == "calibration":
        return make_calibration(spec.options).recording, None
    if spec.target == "pendulum":
        hanging = make_pendulum(spec.options)
        return hanging.recording, hanging.truth
    if spec.target != "walk":
        raise InputError(
            f"sim:{spec.target}: expected sim:walk, sim:gestures, sim:pendulum or sim:calibration"
        )
    walk = make_walk(spec.options)
    return walk.recording, walk.truth


def _truth_of(recording: Recording) -> Truth | None:
    """The truth behind a simulator's recording, if the rows are still those its SPEC makes."""
    if recording.spec is None:
        return None
    try:
        spec = parse_spec(recording.spec)
        made, truth = _simulated(spec) if spec.kind == "sim" else (None, None)
    except InputError as error:
        _log.warning("%s: no truth: its SPEC is of another version (%s)", recording.name, error)
        return None
    if made is None or not _same(recording, made):
        level = logging.INFO if recording.journal else logging.WARNING  # a part of a walk is nothing wrong
        _log.log(level, "%s: no truth: its rows are not those of %s", recording.name, recording.spec)
        return None
    return truth


def _same(recording: Recording, made: Recording) -> bool:
    """Whether every sensor of the recording has the samples the simulator made for it."""
    by_name = {samples.sensor: samples for samples in made.sensors}
    return all(
        samples.sensor in by_name
        and by_name[samples.sensor].matrix.shape == samples.matrix.shape
        and np.allclose(samples.matrix[:, :7], by_name[samples.sensor].matrix[:, :7], rtol=0.0, atol=_SAME)
        for samples in recording.sensors
    )
