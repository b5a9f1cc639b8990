"""Door: who asks: judges each request, and turns the token of a first visit into a cookie."""

from __future__ import annotations

from dataclasses import dataclass

from aiohttp import hdrs, web

from app.door.access import Visitor, is_loopback
from app.door.gate import Gate, Refusal, split_host
from app.door.upstream import is_websocket, say, without_token

#: Told to anybody on this machine: numbers, nothing secret.
OPEN_PATHS = frozenset({"/healthz", "/metrics"})
#: A wrong token is answered so late: who guesses gets few guesses.
GUESS_SECONDS = 0.25


@dataclass(frozen=True)
class Entrance:
    """The gate, for requests as they come."""

    gate: Gate

    def judge(self, request: web.Request) -> Visitor | Refusal:
        """Who asks, or why they stay outside."""
        headers = request.headers
        refusal = self.gate.check_site(
            headers.getall(hdrs.HOST, []), headers.getall(hdrs.ORIGIN, []), is_websocket(request)
        )
        if refusal is not None:
            return refusal
        if request.path in OPEN_PATHS and _is_local(request):
            return Visitor.VIEWER
        if self.is_first_visit(request):
            return self.gate.check_token(request.query["token"])
        if hdrs.AUTHORIZATION in headers:  # a script's way; a page of another site cannot send it
            return self.gate.check_token(headers[hdrs.AUTHORIZATION].removeprefix("Bearer "))
        return self.gate.check_cookie(request.cookies.get(self.gate.cookie_name))

    def is_first_visit(self, request: web.Request) -> bool:
        """Whether the address carries a token."""
        asks = self.gate.access.operator is not None and "token" in request.query
        return asks and request.path == "/" and not is_websocket(request)

    def welcome(self, request: web.Request, visitor: Visitor) -> web.Response:
        """The right token (judged before) becomes a cookie and leaves the address."""
        rest = without_token(request).raw_query_string
        answer = web.Response(status=303, headers={hdrs.LOCATION: f"/?{rest}" if rest else "/"})
        answer.set_cookie(
            self.gate.cookie_name,
            self.gate.cookie_value(visitor),
            path="/",
            httponly=True,
            samesite="Strict",
            secure=self.gate.access.certificate is not None,
        )
        return answer

    def turn_away(self, request: web.Request, refusal: Refusal) -> web.Response:
        """One plain line. Who followed a link of another site is sent round once: strict cookies stay
        at home on such a way, and come along from our own answer."""
        came_by_link = request.headers.get("Sec-Fetch-Site") == "cross-site" and request.path == "/"
        again = {"Refresh": "0; url=/"} if refusal.what == "token" and came_by_link else None
        return say(refusal.status, refusal.line, again)


def guesses(request: web.Request) -> bool:
    """Whether a request came with a token: a wrong one may be a guess."""
    return "token" in request.query or hdrs.AUTHORIZATION in request.headers


def _is_local(request: web.Request) -> bool:
    """Whether a program on this machine asks for itself, and not a proxy for somebody."""
    host = split_host(request.headers.get(hdrs.HOST, ""))
    return is_loopback(request.remote or "") and host is not None and is_loopback(host.name)
