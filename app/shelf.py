"""Shell: the library: the folder of recordings as the page sees it. Everything here may block."""

from __future__ import annotations

import os
import time
from pathlib import Path

from app.formats.names import file_name, with_suffix_of
from app.motion import InputError, ShelfFile
from app.outputs.files import beside
from app.sources.files import load

#: Files listed, the newest first.
MOST = 200
RECORDINGS = (".mcap", ".csv", ".mat", ".txt")
SHARED = ".html"
_LISTED = (*RECORDINGS, SHARED)


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
        recording = load(part, shown=name)
        path = self.folder / file_name(name)
        into = beside(path, "uploaded") if path.exists() else path
        try:
            os.link(part, into)
        except OSError as error:
            raise InputError(f"{name}: cannot be kept: {error.strerror}") from None
        rows = sum(len(samples) for samples in recording.sensors)
        return f"{into.name}: {recording.format}, {rows} samples, {recording.duration_s:.1f} s"
