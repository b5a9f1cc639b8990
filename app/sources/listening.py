"""Edge: where to listen: ``9000`` for this machine, ``0.0.0.0:9000`` for the network; and with what token."""

from __future__ import annotations

import errno
import ipaddress
import os
import socket
from collections.abc import Mapping
from pathlib import Path

from app.formats.options import KEYS, Options, parse_options
from app.motion.basics import InputError
from app.sources.spec import Spec

LOOPBACK = "127.0.0.1"


def place_of(spec: Spec) -> tuple[str, int]:
    """Host and port of ``ws:9000``, ``ws:0.0.0.0:9000`` or ``ws:[::1]:9000``."""
    host, colon, port = spec.target.rpartition(":")
    host = host.strip("[]") if colon else LOOPBACK
    if not port.isascii() or not port.isdigit() or not 0 <= int(port) <= 65535 or len(port) > 5 or not host:
        raise InputError(
            f"{spec.kind}:{spec.target}: expected a port as {spec.kind}:9000, or host and port as "
            f"{spec.kind}:0.0.0.0:9000"
        )
    return ("127.0.0.1" if host.lower() == "localhost" else host), int(port)


def options_of(spec: Spec, more: tuple[str, ...] = ()) -> tuple[Options, Mapping[str, str]]:
    """What the SPEC says of the samples, and its link's own options (of ``more``)."""
    expected = (*KEYS, *more)
    for key in spec.options:
        if key not in expected:
            shown = f"{spec.kind}:{spec.target}"
            raise InputError(f"{shown}: unknown option {key!r}, expected one of {', '.join(expected)}")
    own = {key: value for key, value in spec.options.items() if key in more}
    return parse_options({key: value for key, value in spec.options.items() if key in KEYS}), own


def is_loopback(host: str) -> bool:
    """Whether only this machine can reach what listens on ``host``."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def token_for(spec: Spec, host: str, file: str | None) -> str | None:
    """The token that senders must bring: of ``token-file``; off loopback else of $STRIDESCOPE_TOKEN."""
    if file is None and is_loopback(host):
        return None
    try:
        path = None if file is None else Path(file).expanduser()
        token = (path.read_text("utf-8") if path else os.environ.get("STRIDESCOPE_TOKEN", "")).strip()
    except (OSError, ValueError, RuntimeError) as error:
        raise InputError(f"token-file={file}: cannot be read ({error}), expected a token") from None
    if not token:
        raise InputError(
            f"{spec.kind}:{spec.target}: others on the network could send: give a token, by "
            f"?token-file=FILE or $STRIDESCOPE_TOKEN, or listen on {LOOPBACK}"
        )
    return token


def bind(spec: Spec, host: str, port: int, kind: socket.SocketKind) -> socket.socket:
    """A socket on that place; ``InputError`` where it cannot be had."""
    shown = f"{spec.kind}:{spec.target}"
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=kind, flags=socket.AI_PASSIVE)[0]
        made = socket.socket(family, kind)
    except OSError:
        raise InputError(f"{shown}: {host} is no address of this machine, expected e.g. 0.0.0.0") from None
    try:
        if kind is socket.SOCK_STREAM:
            made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if family == socket.AF_INET6:
            made.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 0)
        made.bind(address)
    except OSError as error:
        made.close()
        raise InputError(f"{shown}: {_reason(error, port)}") from None
    return made


def _reason(error: OSError, port: int) -> str:
    if error.errno == errno.EADDRINUSE:
        return f"port {port} is taken: another program listens there; give another"
    if error.errno in (errno.EACCES, errno.EPERM):
        return f"port {port} is not allowed to this user: give one from 1024 on"
    return f"cannot listen there ({error.strerror or error}), expected an address of this machine"
