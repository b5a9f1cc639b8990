"""Edge, scene: how a phone becomes the sensor: the code to scan, which the door draws for operators only."""

from __future__ import annotations

from app.motion.status import Status

PHONE = "phone"  # the source's name
_CODE = (
    '<div class="ss-phone"><img src="/phone-code.svg" alt="the address for phones, as a code">'
    "<div>Scan this with the phone that goes on the shoe. Its browser warns once of a certificate made "
    "here: compare the fingerprint that the program printed.</div></div>"
)


def code(status: Status) -> str:
    """The code and what to do with it; nothing for other sources."""
    return _CODE if status.source.name == PHONE else ""
