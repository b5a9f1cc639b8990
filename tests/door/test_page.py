"""The page: viser's own, with our head and a policy under which only marked scripts run."""

from __future__ import annotations

from pathlib import Path

import pytest
import viser

from app.door.access import Visitor
from app.door.page import dress, policy


@pytest.fixture(scope="module")
def index() -> str:
    return (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text("utf-8")


def test_every_script_of_viser_s_page_is_marked(index: str) -> None:
    dressed = dress(index, "<style>b{}</style><script>ours()</script>", "n0nce")
    assert dressed.count("<script") == dressed.count('<script nonce="n0nce"') == 2
    assert dressed.count('e.type="module";e.nonce="n0nce";') == 1  # the program that the page starts itself
    assert dressed.index("ours()") < dressed.index("data-p=")


def test_nothing_else_of_the_page_changes(index: str) -> None:
    dressed = dress(index, "<i>ours</i>", "n0nce")
    for ours in (' data-visitor="operator"', "<i>ours</i>", ' nonce="n0nce"', 'e.nonce="n0nce";'):
        dressed = dressed.replace(ours, "")
    assert dressed == index


def test_the_policy_names_the_nonce_and_no_inline_script() -> None:
    directives = dict(part.split(" ", 1) for part in policy("n0nce", "127.0.0.1:8080").split("; "))
    assert "'nonce-n0nce'" in directives["script-src"]
    assert "'unsafe-inline'" not in directives["script-src"]
    assert directives["default-src"] == directives["frame-ancestors"] == directives["base-uri"] == "'none'"
    assert "ws://127.0.0.1:8080" in directives["connect-src"]


def test_the_root_says_who_looks(index: str) -> None:
    assert dress(index, "", "n0nce", Visitor.VIEWER).count('<html data-visitor="viewer"') == 1
