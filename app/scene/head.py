"""Edge, scene: what is added to the head of viser's page: title, style, keys."""

from __future__ import annotations

import json
from pathlib import Path

from app.scene import private, ribbon
from app.scene.colours import css, theme

HERE = Path(__file__).parent


def head(keys: dict[str, tuple[str, str]], resets: list[str]) -> str:
    """HTML for the page's ``<head>``; only our own files and viser's uuids go into it."""
    presses = {key: private.press(control, value) for key, (control, value) in keys.items()}
    script = (HERE / "page.js").read_text(encoding="utf-8").replace("KEY_PRESSES", json.dumps(presses))
    for name in ("present.js", "watching.js", "library.js"):
        script += (HERE / name).read_text(encoding="utf-8")
    script += marks(resets) + ribbon.script()
    return f"<title>Stridescope</title><style>{style()}</style><script>{script}</script>"


def marks(resets: list[str]) -> str:
    """The script that marks what the style sheet speaks of; ``resets`` are the ids of the reset buttons."""
    return (HERE / "marks.js").read_text(encoding="utf-8").replace("RESETS", json.dumps(resets))


def style() -> str:
    """Our style sheet."""
    text = (HERE / "page.css").read_text(encoding="utf-8")
    for name, dark in (("dark", True), ("light", False)):
        sky, horizon = css(theme(dark).sky), css(theme(dark).horizon)
        text = text.replace(f"sky-{name}", f"linear-gradient({sky}, {horizon} 65%)")
    return text
