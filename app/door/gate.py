"""Door: who may come in: Host, Origin and token, judged before anything else happens. Pure.

A page of another site can make a browser call our address, but it cannot choose the Host and
Origin headers that the browser sends: Host is the name in that page's address (a name that was
rebound to our address stays a foreign name), Origin is the page itself.
"""

from __future__ import annotations

import hashlib
import hmac
import ipaddress
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

_HOST = re.compile(r"(\[[0-9a-f:.]{2,45}\]|[a-z0-9._-]{1,253})(?::([0-9]{1,5}))?")
_DEFAULT_PORTS = {"http": 80, "https": 443}


class Address(NamedTuple):
    """A Host header taken apart: the name in lower case without brackets, the port if it has one."""

    name: str
    port: int | None


class Refusal(NamedTuple):
    """Why somebody stays outside: the HTTP status, what to count, one line for the person."""

    status: int
    what: str  # "host" | "origin" | "token"
    line: str


def split_host(header: str) -> Address | None:
    """``[::1]:8080`` → (``::1``, 8080); None for what is no host."""
    match = _HOST.fullmatch(header.lower())
    if match is None:
        return None
    port = int(match[2]) if match[2] else None
    return None if port is not None and port > 65535 else Address(match[1].strip("[]"), port)


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


@dataclass(frozen=True)
class Gate:
    """The rules of one door. ``names`` are further host names it answers to, in lower case.

    Bound to loopback, Host is a loopback name with our own port. Otherwise it is any IP address,
    localhost or one of ``names``, with any port (a container's port may be mapped).
    """

    host: str
    port: int
    token: str | None = None
    names: frozenset[str] = frozenset()

    @property
    def cookie_name(self) -> str:
        """Cookies don't tell ports apart, so the name does."""
        return f"stridescope-{self.port}"

    @property
    def cookie_value(self) -> str:
        """Follows from the token, but doesn't tell it, and has only letters that a cookie may have."""
        return hashlib.sha256(b"stridescope cookie:" + _bytes(self.token or "")).hexdigest()

    def check_site(self, hosts: Sequence[str], origins: Sequence[str], websocket: bool) -> Refusal | None:
        """Judge the Host and Origin headers of a request, as many as came."""
        host = split_host(hosts[0]) if len(hosts) == 1 else None
        if host is None or not self._is_ours(host):
            return Refusal(403, "host", f"403: {_shown(hosts)} is not this program's address.{self._hint()}")
        missing = not origins and not websocket
        if not missing and (len(origins) != 1 or not _same_origin(origins[0], host)):
            return Refusal(403, "origin", f"403: the origin {_shown(origins)} is not this page's own.")
        return None

    def check_token(self, token: str) -> Refusal | None:
        """Judge the token in an address; takes the same time for every wrong one."""
        return self._compare(token, self.token or "")

    def check_cookie(self, cookie: str | None) -> Refusal | None:
        """Judge the cookie of a request."""
        return self._compare(cookie or "", self.cookie_value)

    def _compare(self, given: str, expected: str) -> Refusal | None:
        if self.token is None or hmac.compare_digest(_bytes(given), _bytes(expected)):
            return None  # without a token the door is open
        return Refusal(401, "token", "401: open the address with ?token=… that the program printed.")

    def _is_ours(self, host: Address) -> bool:
        if is_loopback(self.host):
            return is_loopback(host.name) and (host.port or 80) == self.port
        return is_ip(host.name) or host.name == "localhost" or host.name in self.names

    def _hint(self) -> str:
        return f" Open http://localhost:{self.port} instead." if is_loopback(self.host) else ""


def _same_origin(origin: str, host: Address) -> bool:
    scheme, separator, rest = origin.lower().partition("://")
    theirs = split_host(rest) if separator and scheme in _DEFAULT_PORTS else None
    if theirs is None:
        return False
    default = _DEFAULT_PORTS[scheme]
    return (theirs.name, theirs.port or default) == (host.name, host.port or default)


def _shown(headers: Sequence[str]) -> str:
    return ascii(headers[0][:80]) if headers else "(none)"


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")  # a header may hold what is no UTF-8
