"""Door: viser's page made ours: our script and style in its head, and a strict content policy. Pure."""

from __future__ import annotations

from app.door.access import Visitor

#: Sent with every answer.
SAFE_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
    "Server": "Stridescope",
}
NOTHING_POLICY = "default-src 'none'; frame-ancestors 'none'"

# viser's page unpacks its program and starts it as an inline module that it makes itself.
_MODULE = 'e.type="module";'


def dress(html: str, extra_head: str, nonce: str, visitor: Visitor = Visitor.OPERATOR) -> str:
    """viser's index.html with ``extra_head`` first in its head, all scripts marked with ``nonce``.

    Its root says who looks, ``<html data-visitor="viewer">``, so that style and script can show it.
    ``extra_head`` is our own ``<script>`` and ``<style>``. ``nonce`` (letters and digits) is new
    for each answer: scripts that got into the page any other way don't run.
    """
    with_ours = html.replace("<html", f'<html data-visitor="{visitor}"', 1).replace(
        "<head>", f"<head>{extra_head}", 1
    )
    marked = with_ours.replace("<script", f'<script nonce="{nonce}"')
    return marked.replace(_MODULE, f'{_MODULE}e.nonce="{nonce}";')


def policy(nonce: str, host: str) -> str:
    """The Content-Security-Policy of the page. ``host`` is the Host header it was asked by.

    viser needs WebAssembly, workers made from blobs, inline styles, and ``eval`` (the glue of its
    splat sorter, which it loads always). What cannot run is script in markup: a ``<script>``, an
    ``onerror=`` or a ``javascript:`` link that a text smuggled in has no nonce. ``connect-src``
    names the websocket because not every browser counts it as ``'self'``.
    """
    return "; ".join((
        "default-src 'none'",
        f"script-src 'nonce-{nonce}' 'unsafe-eval'",
        "worker-src blob:",
        "style-src 'unsafe-inline'",
        "img-src 'self' data: blob:",
        "media-src data: blob:",
        "font-src data:",
        f"connect-src 'self' ws://{host} wss://{host} data: blob:",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    ))  # fmt: skip
