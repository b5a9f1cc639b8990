"""Door: where it listens and who may come in: what a person chose, before anything is opened. Pure."""

from __future__ import annotations

import ipaddress
import secrets
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote

from app.motion.basics import InputError


class Visitor(StrEnum):
    """What somebody who came in may do."""

    OPERATOR = "operator"
    VIEWER = "viewer"  # sees everything, moves nothing


class Certificate(NamedTuple):
    """Two PEM files for TLS."""

    chain: Path
    key: Path


@dataclass(frozen=True)
class Access:
    """One door's address and tokens. Without an operator's token everybody who can reach it operates."""

    host: str = "127.0.0.1"
    port: int = 8080
    operator: str | None = None  # the token that lets operate
    viewer: str | None = None  # the token that lets watch
    certificate: Certificate | None = None

    def __post_init__(self) -> None:
        if not 0 <= self.port <= 65535:
            raise InputError(f"port {self.port}: expected 0 to 65535")
        if not is_loopback(self.host) and not self.operator:
            raise InputError(
                f"host {self.host}: others on the network could come in; give a token, or stay on 127.0.0.1"
            )
        if self.viewer and not self.operator:
            raise InputError("a token for viewers alone keeps nobody out; give one for operators as well")
        if self.viewer and self.viewer == self.operator:
            raise InputError("the tokens of operators and viewers are the same; expected two")

    @property
    def scheme(self) -> str:
        """``http``, or ``https`` with a certificate."""
        return "https" if self.certificate else "http"

    def address(self, host: str, port: int, token: str | None) -> str:
        """What to open in a browser; with ``?token=…`` where there is one: never log it."""
        query = f"/?token={quote(token, safe='')}" if token else ""
        return f"{self.scheme}://{f'[{host}]' if ':' in host else host}:{port}{query}"


def made_token() -> str:
    """128 random bits, in letters that an address may have."""
    return secrets.token_urlsafe(16)


def is_ip(name: str) -> bool:
    """Whether ``name`` is a plain IP address: such a Host cannot come from a rebound name."""
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def is_loopback(name: str) -> bool:
    """Whether ``name`` can only mean this machine. A name that merely resolves to it does not count."""
    if not is_ip(name):
        return name.lower() == "localhost"
    ip = ipaddress.ip_address(name)
    inner = ip.ipv4_mapped if isinstance(ip, ipaddress.IPv6Address) else None
    return (inner or ip).is_loopback
