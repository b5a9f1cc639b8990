"""The library's tab: what is chosen is what is asked for; other people's file names are only text."""

from __future__ import annotations

from app.motion.commands import Order, Play, Rename, Share
from app.motion.status import ShelfFile
from app.scene.library import table
from app.scene.page import Scene
from tests.scene import fakes
from tests.scene.browsers import client, until
from tests.scene.test_controls import control

FILES = (
    ShelfFile("walk.mcap", 2_000_000, "2026-11-22 02:09"),
    ShelfFile("page.html", 900_000, "2026-11-21 01:00"),
)


def test_a_recording_is_opened_and_renamed(scene: Scene, orders: list[Order]) -> None:
    scene.draw(fakes.snapshot(5.0), fakes.status(shelf=FILES))
    chosen = control(scene, "From the library")
    assert scene.rules()[chosen].choices == ("choose…", "walk.mcap")
    with client(scene.port) as browser:
        browser.write(control(scene, "Open"), "Open")  # nothing is chosen: nothing is asked
        browser.write(chosen, "walk.mcap")
        browser.write(control(scene, "Open"), "Open")
        until(lambda: orders)
        browser.write(control(scene, "Share"), "Share")
        until(lambda: len(orders) == 2)
        browser.write(control(scene, "New name"), " stairs ")
        browser.write(control(scene, "Rename"), "Rename")
        until(lambda: len(orders) == 3)
    asked = [Play("walk.mcap"), Share("walk.mcap"), Rename("walk.mcap", "stairs")]
    assert [order.command for order in orders] == asked


def test_names_are_text_and_links_stay_in_the_library() -> None:
    found = table(
        (ShelfFile('<img src=x onerror="alert(1)">.csv', 5, "<b>"), ShelfFile("a b?.csv", 5, "now"))
    )
    assert "<img" not in found
    assert "<b>" not in found
    assert 'href="/files/%3Cimg%20src%3Dx' in found
    assert 'href="/files/a%20b%3F.csv"' in found


def test_an_empty_library_says_what_to_do() -> None:
    assert "Space" in table(())
