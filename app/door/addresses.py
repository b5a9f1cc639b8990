"""Door: the names and addresses by which this machine is reached."""

from __future__ import annotations

import contextlib
import socket
from collections.abc import Iterator

# Nothing is sent there: it only asks which of our addresses would be used (documentation prefixes).
_ELSEWHERE = ((socket.AF_INET, "192.0.2.1"), (socket.AF_INET6, "2001:db8::1"))


def numeric(host: str) -> str:
    """Browsers try 127.0.0.1 for ``localhost`` as well, so one listener will do."""
    return "127.0.0.1" if host.lower() == "localhost" else host


def own_names(host: str) -> frozenset[str]:
    """The names a server at ``host`` answers to, in lower case."""
    name = socket.gethostname().lower()
    return frozenset({host.lower(), name, f"{name.partition('.')[0]}.local"})


def reachable(host: str) -> str:
    """The host to print: of a server that listens everywhere, the address others reach it by."""
    if host not in ("", "0.0.0.0", "::"):
        return numeric(host)
    return next(_outward(), "127.0.0.1")


def everything(host: str) -> frozenset[str]:
    """All names and addresses that a certificate for ``host`` should hold."""
    fixed = {"localhost", "127.0.0.1", "::1", numeric(host)} - {"", "0.0.0.0", "::"}
    return frozenset(fixed | set(_outward()) | (own_names(host) - {"", "0.0.0.0", "::"}))


def _outward() -> Iterator[str]:
    for family, address in _ELSEWHERE:
        with contextlib.suppress(OSError), socket.socket(family, socket.SOCK_DGRAM) as probe:
            probe.connect((address, 9))
            yield str(probe.getsockname()[0])
