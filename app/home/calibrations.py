"""Edge: the user's configuration folder: one calibration for each sensor, as JSON."""

from __future__ import annotations

import hashlib
import logging
from collections.abc import Callable
from pathlib import Path

from app.calibration.words import Calibration, from_json, to_json
from app.home import small
from app.motion.basics import InputError
from app.motion.samples import Sample
from app.motion.source import SourceInfo

log = logging.getLogger(__name__)

MOST_BYTES = 64 * 1024


def folder() -> Path:
    """Where calibrations live; it need not exist."""
    return small.folder("calibrations")


def key_of(info: SourceInfo, sensor: str) -> str:
    """What names a sensor: its serial number, else where it is read and what it is called there."""
    return info.serials.get(sensor) or f"{info.places.get(sensor, info.name)} {sensor}"


def meant_for(info: SourceInfo) -> bool:
    """Whether calibrations are applied to a source: a recording has had its own, if it needed one."""
    return info.duration_s is None or info.format == "simulator"


class Corrections:
    """The calibrations of one source's sensors, each looked up with its first sample."""

    def __init__(self, info: Callable[[], SourceInfo]) -> None:
        self._info = info
        self.used: dict[str, Calibration | None] = {}
        self.undone: set[str] = set()
        self.damaged = ""  # one line: a file that cannot be used

    def apply(self, sample: Sample) -> Sample:
        """The sample, corrected if its sensor was calibrated."""
        if sample.sensor not in self.used:
            self.look(sample.sensor)
        calibration = self.used[sample.sensor]
        return sample if calibration is None else calibration.apply(sample)

    def look(self, sensor: str) -> None:
        """Look a sensor's calibration up, again."""
        self.used[sensor] = self.find(sensor)
        if (used := self.used[sensor]) is not None:
            log.info("%s is corrected: calibrated %s", sensor, used.made)

    def find(self, sensor: str) -> Calibration | None:
        """What is kept for a sensor, if it is to be applied; a damaged one is told and left."""
        info = self._info()
        if not meant_for(info):
            return None
        key = key_of(info, sensor)
        (self.undone.add if was_undone(key) else self.undone.discard)(sensor)
        try:
            return load(key)
        except InputError as error:
            self.damaged = str(error)
            log.warning("%s", error)
            return None


def path_of(key: str) -> Path:
    """The file for a sensor: a readable name, and enough of a digest that no two share one."""
    plain = "".join(c if c.isascii() and c.isalnum() else "-" for c in key).strip("-")[:60]
    return folder() / f"{plain}-{hashlib.sha256(key.encode()).hexdigest()[:8]}.json"


def load(key: str) -> Calibration | None:
    """The sensor's calibration; None where there is none. A damaged file is ``InputError``."""
    path = path_of(key)
    text = small.read(f"calibration {path}", path, MOST_BYTES, "one of ours")
    if text is None:
        return None
    found = from_json(path.name, text)
    if found.sensor != key:
        raise InputError(f"calibration {path}: it is of {found.sensor!r}, expected {key!r}")
    return found


def save(calibration: Calibration) -> Path:
    """Keep a calibration; the one before it stays beside it as ``.before``."""
    path = path_of(calibration.sensor)
    small.write("calibration", path, to_json(calibration), before=path.with_suffix(".before"))
    try:
        path.with_suffix(".undone").unlink(missing_ok=True)
    except OSError as error:
        raise InputError(
            f"calibration {path}: saved, but the one undone stays beside it: {error.strerror}"
        ) from None
    return path


def undo(key: str) -> bool:
    """Use it no more: the file is kept as ``.undone``. Whether there was one."""
    return _move(path_of(key), path_of(key).with_suffix(".undone"))


def redo(key: str) -> bool:
    """Use the one that was undone. Whether there was one."""
    return _move(path_of(key).with_suffix(".undone"), path_of(key))


def was_undone(key: str) -> bool:
    """Whether there is one to go back to."""
    return path_of(key).with_suffix(".undone").is_file()


def _move(old: Path, new: Path) -> bool:
    try:
        old.replace(new)
    except FileNotFoundError:
        return False
    except OSError as error:
        raise InputError(f"calibration {old}: cannot be moved: {error.strerror}") from None
    return True
