"""Shell: what this machine lacks for a walk, from ports to versions; each finding with its remedy.

Everything is looked at under a root and with an identity that a test may make up.
"""

from __future__ import annotations

import contextlib
import importlib.metadata
import os
import platform
import shutil
import socket
import stat
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import platformdirs

PORTS = ("ttyUSB*", "ttyACM*", "ttyAMA*", "rfcomm*", "cu.usb*", "cu.wch*")
PACKAGES = ("numpy", "scipy", "numba", "viser", "aiohttp", "websockets", "pyserial", "zstandard")
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "firefox", "microsoft-edge", "open")
PYTHON = ((3, 11), (3, 14))
#: Two feet at 400 Hz fill so much disk in an hour (a minute of sim:walk filled 5.8 MB).
HOUR_BYTES = 350e6
LATE_MS = 20.0
SYNC_S = 0.5


class Finding(NamedTuple):
    """One thing looked at. ``state``: ``ok``, ``advice`` (it works, could be better) or ``problem``."""

    what: str
    state: str
    told: str
    remedy: str = ""


@dataclass(frozen=True)
class Machine:
    """What is examined."""

    root: Path = Path("/")
    uid: int = field(default_factory=os.getuid)
    groups: frozenset[int] = field(default_factory=lambda: frozenset((os.getgid(), *os.getgroups())))
    config: Path = field(
        default_factory=lambda: Path(platformdirs.user_config_dir("stridescope", appauthor=False))
    )
    cache: Path = field(
        default_factory=lambda: Path(platformdirs.user_cache_dir("stridescope", appauthor=False))
    )
    recordings: Path = Path("recordings")
    search: str | None = None  # PATH, for browsers
    port: int = 8080
    python: tuple[int, int] = sys.version_info[:2]


def examine(machine: Machine) -> list[Finding]:
    """Everything, in the order in which it would stop a walk."""
    return [
        *_versions(machine),
        *_serial(machine),
        _network(machine),
        _browser(machine),
        _folder("configuration", machine.config, "profiles and calibrations"),
        _folder("compiled kernels", machine.cache, "else every start takes a minute"),
        *_disk(machine),
        _timers(),
    ]


# --- one by one ----------------------------------------------------------------------------------


def _versions(machine: Machine) -> Iterator[Finding]:
    major, minor = machine.python
    text = f"Python {major}.{minor} on {platform.system()} {platform.machine()}, {os.cpu_count()} cores"
    good = PYTHON[0] <= machine.python <= PYTHON[1]
    remedy = "" if good else "install Python 3.11 to 3.14 and run make setup again"
    yield Finding("Python", "ok" if good else "problem", text, remedy)
    missing = []
    told = []
    for name in PACKAGES:
        try:
            told.append(f"{name} {importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            missing.append(name)
    yield Finding("packages", "ok" if told else "problem", ", ".join(told))
    if missing:
        yield Finding("packages missing", "problem", ", ".join(missing), "run make setup")


def _serial(machine: Machine) -> Iterator[Finding]:
    there = ports(machine)
    if not there:
        yield Finding(
            "serial ports",
            "advice",
            "none found",
            "plug the sensor in; in a container or WSL pass the port through",
        )
    for path in there:
        yield _rights(machine, path)
        yield from _latency(machine, path)


def ports(machine: Machine) -> list[Path]:
    """The serial ports that sensors are on."""
    return sorted(path for pattern in PORTS for path in (machine.root / "dev").glob(pattern))


def usable(machine: Machine, port: Path) -> bool:
    """Whether this user may open it."""
    return _rights(machine, port).state == "ok"


def _rights(machine: Machine, path: Path) -> Finding:
    shown = _shown(machine, path)
    try:
        state = path.stat()
    except OSError as error:
        return Finding(
            shown, "problem", f"cannot be looked at: {error.strerror}", "unplug it and plug it in again"
        )
    mode = state.st_mode
    if machine.uid in (0, state.st_uid):
        good = machine.uid == 0 or _both(mode, stat.S_IRUSR, stat.S_IWUSR)
    elif state.st_gid in machine.groups:
        good = _both(mode, stat.S_IRGRP, stat.S_IWGRP)
    else:
        good = _both(mode, stat.S_IROTH, stat.S_IWOTH)
    if good:
        return Finding(shown, "ok", "may be read and written")
    group = _group_name(machine, state.st_gid)
    if _both(mode, stat.S_IRGRP, stat.S_IWGRP):
        remedy = f"sudo usermod -aG {group} $USER, then log out and in again"
    else:
        remedy = f"sudo chmod a+rw {shown}, or a udev rule that does so"
    return Finding(shown, "problem", f"belongs to group {group}, of which this user is not", remedy)


def _both(mode: int, read: int, write: int) -> bool:
    return bool(mode & read and mode & write)


def _group_name(machine: Machine, gid: int) -> str:
    with contextlib.suppress(OSError, ValueError):
        for line in (machine.root / "etc/group").read_text("utf-8", "replace").splitlines():
            name, _, number = (line.split(":") + ["", ""])[:3]
            if number == str(gid):
                return name
    return str(gid)


def _latency(machine: Machine, path: Path) -> Iterator[Finding]:
    """An FTDI chip hands over what it has every so many milliseconds; 16 unless told."""
    timer = machine.root / "sys/bus/usb-serial/devices" / path.name / "latency_timer"
    with contextlib.suppress(OSError, ValueError):
        waits_ms = int(timer.read_text().strip())
        what = f"{_shown(machine, path)} driver timer"
        if waits_ms <= 2:
            yield Finding(what, "ok", f"{waits_ms} ms")
        else:
            told = f"{waits_ms} ms: samples come in bursts of that length"
            remedy = f"echo 1 | sudo tee {_shown(machine, timer)}"
            yield Finding(what, "advice", told, remedy)


def _shown(machine: Machine, path: Path) -> str:
    return f"/{path.relative_to(machine.root)}"


def _network(machine: Machine) -> Finding:
    what = f"port {machine.port}"
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", machine.port))
        except OSError:
            return Finding(what, "advice", "taken: another program listens there", "give another with --port")
    return Finding(what, "ok", "free")


def _browser(machine: Machine) -> Finding:
    found = next((name for name in BROWSERS if shutil.which(name, path=machine.search)), None)
    if found:
        return Finding("browser", "ok", found if found != "open" else "of this desktop")
    return Finding(
        "browser",
        "advice",
        "none found here",
        "install Chromium or Firefox, or open the page from another machine",
    )


def _folder(what: str, path: Path, used_for: str) -> Finding:
    name = f"{what} folder"
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            return Finding(name, "ok", f"{path} can be written ({used_for})")
    except OSError as error:
        remedy = f"make it writable: sudo chown -R $USER {path}"
        return Finding(name, "problem", f"{path}: {error.strerror} ({used_for})", remedy)


def _disk(machine: Machine) -> Iterator[Finding]:
    """Where recordings go: room, and how long a write takes until it is safe."""
    folder = machine.recordings
    while not folder.exists():
        folder = folder.absolute().parent
    free = shutil.disk_usage(folder).free
    told = f"{free / 1e9:.1f} GB free, {free / HOUR_BYTES:.0f} hours of two feet at 400 Hz"
    remedy = "" if free > 2 * HOUR_BYTES else "make room, or record elsewhere with --record DIR"
    yield Finding("disk for recordings", "problem" if remedy else "ok", told, remedy)
    try:
        began = time.monotonic()
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(bytes(1_000_000))
            file.flush()
            os.fsync(file.fileno())
        took_s = time.monotonic() - began
    except OSError as error:
        yield Finding(
            "recordings folder",
            "problem",
            f"{folder}: {error.strerror}",
            "record elsewhere with --record DIR",
        )
        return
    slow = took_s > SYNC_S
    remedy = "record to another disk: a power cut loses what is not written yet" if slow else ""
    yield Finding(
        "disk's speed", "advice" if slow else "ok", f"1 MB is safe after {took_s * 1e3:.0f} ms", remedy
    )


def _timers() -> Finding:
    """How late this machine wakes: what a sample waits at worst when nothing else is slow."""
    late_ms = []
    for _ in range(20):
        began = time.monotonic()
        time.sleep(0.005)
        late_ms.append((time.monotonic() - began) * 1e3 - 5.0)
    worst = max(late_ms)
    told = f"wakes up to {worst:.1f} ms late"
    remedy = "close other programs, or switch the power saving off" if worst > LATE_MS else ""
    return Finding("timers", "advice" if remedy else "ok", told, remedy)
