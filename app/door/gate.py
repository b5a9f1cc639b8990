"""Door: who may come in: Host, Origin and token, judged before anything else happens. Pure.

A page of another site can make a browser call our address, but it cannot choose the Host and
Origin headers that the browser sends: Host is the name in that page's address (a name that was
rebound to our address stays a foreign name), Origin is the page itself.
"""

from __future__ import annotations

import hashlib
import hmac
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from app.door.access import Access, Visitor, is_ip, is_loopback

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


@dataclass(frozen=True)
class Gate:
    """The rules of one door. ``names`` are further host names it answers to, in lower case.

    Bound to loopback, Host is a loopback name with our own port. Otherwise it is any IP address,
    localhost or one of ``names``, with any port (a container's port may be mapped).
    """

    access: Access
    names: frozenset[str] = frozenset()

    @property
    def cookie_name(self) -> str:
        """Cookies don't tell ports apart, so the name does; the prefix ties it to this host and to TLS."""
        name = f"stridescope-{self.access.port}"
        return f"__Host-{name}" if self.access.certificate else name

    def cookie_value(self, visitor: Visitor) -> str:
        """Follows from the token, but doesn't tell it, and has only letters that a cookie may have.

        So a browser stays known when the program starts again with the same token, and no longer.
        """
        return hashlib.sha256(b"stridescope cookie:" + _bytes(self._token(visitor))).hexdigest()

    def check_site(self, hosts: Sequence[str], origins: Sequence[str], websocket: bool) -> Refusal | None:
        """Judge the Host and Origin headers of a request, as many as came."""
        host = split_host(hosts[0]) if len(hosts) == 1 else None
        if host is None or not self._is_ours(host):
            return Refusal(403, "host", f"403: {_shown(hosts)} is not this program's address.{self._hint()}")
        missing = not origins and not websocket
        if not missing and (len(origins) != 1 or not self._same_origin(origins[0], host)):
            return Refusal(403, "origin", f"403: the origin {_shown(origins)} is not this page's own.")
        return None

    def check_token(self, token: str) -> Visitor | Refusal:
        """Who has this token; takes the same time for every wrong one."""
        return self._judge(token, {visitor: self._token(visitor) for visitor in Visitor})

    def check_cookie(self, cookie: str | None) -> Visitor | Refusal:
        """Who has this cookie."""
        values = {visitor: self.cookie_value(visitor) if self._token(visitor) else "" for visitor in Visitor}
        return self._judge(cookie or "", values)

    def _judge(self, given: str, expected: dict[Visitor, str]) -> Visitor | Refusal:
        if self.access.operator is None:
            return Visitor.OPERATOR  # without a token the door is open
        same = {visitor: hmac.compare_digest(_bytes(given), _bytes(it)) for visitor, it in expected.items()}
        for visitor in Visitor:
            if expected[visitor] and same[visitor]:
                return visitor
        return Refusal(401, "token", "401: open the address with ?token=… that the program printed.")

    def _token(self, visitor: Visitor) -> str:
        return (self.access.operator if visitor is Visitor.OPERATOR else self.access.viewer) or ""

    def _is_ours(self, host: Address) -> bool:
        if is_loopback(self.access.host):
            port = host.port or _DEFAULT_PORTS[self.access.scheme]
            return is_loopback(host.name) and port == self.access.port
        return is_ip(host.name) or host.name == "localhost" or host.name in self.names

    def _same_origin(self, origin: str, host: Address) -> bool:
        scheme, separator, rest = origin.lower().partition("://")
        theirs = split_host(rest) if separator and scheme in self._schemes() else None
        if theirs is None:
            return False
        default = _DEFAULT_PORTS[scheme]
        return (theirs.name, theirs.port or default) == (host.name, host.port or default)

    def _schemes(self) -> Sequence[str]:
        """A proxy in front of us may speak TLS where we don't; nobody takes off what we put on."""
        return ("https",) if self.access.certificate else ("http", "https")

    def _hint(self) -> str:
        access = self.access
        return f" Open {access.scheme}://localhost:{access.port} instead." if is_loopback(access.host) else ""


def _shown(headers: Sequence[str]) -> str:
    return ascii(headers[0][:80]) if headers else "(none)"


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")  # a header may hold what is no UTF-8
