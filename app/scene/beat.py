"""Edge, scene: a sign of life within the page, by which it knows how old what it shows is."""

from __future__ import annotations


def beat(clock_s: float) -> str:
    """Nothing to see: the program's wall clock in whole seconds, new each second.

    present.js compares it with the browser's own clock, so that a page that nothing reaches any more
    says so, also while the walk stands still and there is nothing else to send.
    """
    return f'<i hidden data-ss-beat="{int(clock_s)}"></i>'
