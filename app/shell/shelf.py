"""Shell: the library: the folder of recordings as the page sees it. Everything here may block."""

from __future__ import annotations

import math
import os
import time
from pathlib import Path

from app.formats import gpx
from app.formats.names import file_name, with_suffix_of
from app.motion.basics import InputError
from app.motion.status import Reference, ShelfFile
from app.outputs.files import beside
from app.sources.files import load, read_bytes

#: Files listed, the newest first.
MOST = 200
RECORDINGS = (".mcap", ".csv", ".mat", ".txt")
SHARED = ".html"
TRACK = ".gpx"
_LISTED = (*RECORDINGS, TRACK, SHARED)


class Shelf:
    """One folder; no name leads out of it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def files(self) -> tuple[ShelfFile, ...]:
        """What there is, the newest first; a folder that is not there yet is empty."""
        found = []
        try:
            entries = list(os.scandir(self.folder))
        except OSError:
            return ()
        for entry in entries:
            if not entry.name.startswith(".") and Path(entry.name).suffix.lower() in _LISTED:
                try:
                    told = entry.stat(follow_symlinks=False)
                    if entry.is_file(follow_symlinks=False) and file_name(entry.name) == entry.name:
                        found.append((told.st_mtime, entry.name, told.st_size))
                except (OSError, InputError):  # gone meanwhile, or a name that a page cannot say
                    continue
        return tuple(
            ShelfFile(name, size, time.strftime("%Y-%m-%d %H:%M", time.localtime(changed)))
            for changed, name, size in sorted(found, reverse=True)[:MOST]
        )

    def path(self, name: str) -> Path:
        """A file's path; ``InputError`` if there is none of that name."""
        path = self.folder / file_name(name)
        if path.is_symlink() or not path.is_file():
            raise InputError(f"{file_name(name)}: no such recording in the library")
        return path

    def rename(self, name: str, to: str) -> str:
        """Give a file another name, never another's; the name it has then."""
        path = self.path(name)
        new = with_suffix_of(to, path.name)
        try:
            os.link(path, self.folder / new)  # unlike a rename it never takes the place of another file
            path.unlink()
        except FileExistsError:
            raise InputError(f"{new}: there is a file of that name already, expected another") from None
        except OSError as error:
            raise InputError(f"{name}: cannot be renamed: {error.strerror}") from None
        return new

    def receive(self, part: Path, name: str) -> str:
        """Keep an uploaded file if it is a recording; what became of it, for the person."""
        told = self._told(part, name)
        path = self.folder / file_name(name)
        into = beside(path, "uploaded") if path.exists() else path
        try:
            os.link(part, into)
        except OSError as error:
            raise InputError(f"{name}: cannot be kept: {error.strerror}") from None
        return f"{into.name}: {told}"

    def _told(self, part: Path, name: str) -> str:
        """What an uploaded file is, in words; ``InputError`` if it is nothing to open."""
        if Path(name).suffix.lower() == TRACK:
            return f"GPX track, {gpx.read(name, read_bytes(part)).length_m:.0f} m"
        recording = load(part, shown=name)
        rows = sum(len(samples) for samples in recording.sensors)
        return f"{recording.format}, {rows} samples, {recording.duration_s:.1f} s"


def track(path: Path, declination_deg: float) -> Reference:
    """A GPX file as a track to show; ``declination_deg``: magnetic north east of true north."""
    if not abs(declination_deg) <= 180.0:
        raise InputError(f"--declination {declination_deg:g}: expected degrees east, −180 to 180")
    return gpx.turned(gpx.reference_of(gpx.read(path.name, read_bytes(path))), math.radians(declination_deg))
