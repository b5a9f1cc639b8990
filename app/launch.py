"""Edge to the desktop: opens the user's browser."""

from __future__ import annotations

import contextlib
import os
import sys
import webbrowser


def open_in_browser(address: str) -> None:
    """Open the page where there is a desktop; elsewhere the printed address is enough."""
    desktop = sys.platform == "darwin" or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))
    if desktop:
        with contextlib.suppress(webbrowser.Error):
            webbrowser.open(address)
