"""The house's rules, read from the imports (docs/architecture.md)."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

APP = Path(__file__).parent.parent / "app"
HEART = {
    "session",
    "applying",
    "beside",
    "memory",
    "stores",
    "tracks",
    "trail",
    "saving",
    "truth",
    "own",
    "graphs",
    "clocks",
    "hanging",
    "health",
    "preflight",
    "damage",
    "blocks",
    "warm",
    "limits",
    "motion",
    "settings",
    "rotation",
    "world",
    "visit",
    "hearing",
    "visiting",
}
HEART |= {"calibration", "estimator", "gestures", "simulate", "formats", "studies"}
EDGES = {"sources", "outputs", "scene", "door", "home", "compiled", "compressed", "workers", "measures"}
EDGES |= {"opinions", "launch"}
SHELL = {"shell", "commands", "__main__", "__init__"}
#: Files of shell/ that others of it wire in.
WIRED = {
    "measuring": {"doctor"},
    "run": {"annexe", "aside", "hand_in", "librarian", "serving", "taping", "walk", "work"},
    "walk": {"before", "early", "remembering", "taping"},
    "record": {"aside", "early"},
    "mover": {"aside", "serving"},
    "librarian": {"aside", "shelf"},
}
CLOCKS_AND_FILES = {"asyncio", "concurrent", "glob", "http", "multiprocessing", "os", "pathlib", "selectors"}
CLOCKS_AND_FILES |= {"shutil", "socket", "ssl", "subprocess", "tempfile", "threading", "time", "urllib"}
ONLY_IN = {"viser": "scene", "numba": "compiled", "serial": "sources", "zstandard": "compressed"}
#: Edges to tools that change how fast or how large, not what: everyone may use them.
OPEN = {"compiled", "compressed"}
CORE = {"session", "applying", "memory", "beside", "stores", "tracks", "estimator", "gestures"}
STRANGERS = {frozenset({"estimator", "gestures"}), frozenset({"estimator", "simulate"})}


def imports(tree: ast.Module) -> Iterator[str]:
    """Every imported name in full: ``app.motion.Sample``, ``numpy``; a relative one starts with a dot."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{'.' * node.level}{node.module or ''}.{alias.name}" for alias in node.names)


def refused_by_the_heart(name: str) -> bool:
    top = name.split(".")[0]
    return top in CLOCKS_AND_FILES or top not in {"numpy", "scipy", "app", *sys.stdlib_module_names}


def faults(room: str, source: str, file: str = "") -> list[str]:
    """What ``file`` of ``room`` does against the rules, in words."""
    tree = ast.parse(source)
    found = [] if room in HEART | EDGES | SHELL else [f"{room}: no such room"]
    for name in imports(tree):
        top, other, part = (
            (*name.split("."), "", "")[:3] if name.startswith("app.") else (name.split(".")[0], "", "")
        )
        rules = {
            "relative import": name.startswith("."),
            "import from another room's own": room != ONLY_IN.get(top, room),
            "heart to the outside": room in HEART and refused_by_the_heart(name),
            "heart to an edge": room in HEART and other in EDGES - OPEN,
            "edge to edge": room in EDGES and other in EDGES - OPEN - {room},
            "edge to the core": room in EDGES and other in CORE,
            "strangers": frozenset({room, other}) in STRANGERS,
            "to the shell": other in SHELL and room not in {"shell", "commands", "__main__"},
            "shell to its own": room == other == "shell" and part not in WIRED.get(file, set()),
            "shell to the command line": room == "shell" and other in {"commands", "__main__"},
        }
        found += [f"{room} imports {name}: {rule}" for rule, broken in rules.items() if broken]
    calls = {n.func.id for n in ast.walk(tree) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)}
    return found + [f"{room} calls {name}()" for name in calls & {"open", "print", "input"} if room in HEART]


FILES = sorted(path.relative_to(APP) for path in APP.rglob("*.py"))


@pytest.mark.parametrize("path", FILES, ids=str)
def test_every_file_keeps_the_rules(path: Path) -> None:
    assert faults(path.parts[0].removesuffix(".py"), (APP / path).read_text("utf-8"), path.stem) == []


@pytest.mark.parametrize(
    ("room", "source"),
    [
        ("cellar", ""),
        ("formats", "from . import clean"),
        ("session", "import asyncio"),
        ("estimator", "def f():\n    from time import monotonic"),
        ("formats", "import msgspec"),
        ("formats", "open('walk.csv')"),
        ("simulate", "from app.estimator import papers"),
        ("estimator", "from app.gestures.steering import steer"),
        ("settings", "from app.home import profiles"),
        ("estimator", "import numba"),
        ("door", "import viser"),
        ("scene", "from app.door import front"),
        ("sources", "from app.session import Session"),
        ("door", "import app.estimator.papers"),
        ("scene", "from app.shell.run import walk"),
        ("home", "from app.shell import batch"),
        ("shell", "from app.shell import batch"),
        ("shell", "from app.commands import walk"),
    ],
)
def test_a_broken_rule_is_seen(room: str, source: str) -> None:
    assert faults(room, source)
