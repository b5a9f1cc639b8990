"""Opens the page through the real door, as a person does."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from playwright.sync_api import Browser, Page

from app.door.access import Access
from app.door.front import Door
from app.scene.page import Scene

DRAWN = """(node) => {
  const t = window.__viserTestpoints, s = window.__viserSceneTree;
  const drawn = t && t.rendererInfo.render;
  return drawn && s && node in s.getState() && drawn.triangles > 0 && drawn.frame > 2;
}"""
NO_TOASTS = ".mantine-Notifications-root{display:none!important}"
PATIENCE_MS = 180_000


@contextmanager
def door_to(scene: Scene) -> Iterator[str]:
    """A door in front of the scene; its address."""
    door = Door(Access(port=0), viser_port=scene.port, rules=scene.rules, health=dict, extra_head=scene.head)
    door.start()
    try:
        yield door.address
    finally:
        door.stop()


def open_page(
    browser: Browser,
    address: str,
    size: tuple[int, int] = (1280, 800),
    node: str = "/ned/foot",
    coarse: bool = False,
) -> Page:
    """A page on which ``node`` has been drawn; ``coarse`` is quicker where only words matter."""
    page = browser.new_page(viewport={"width": size[0], "height": size[1]})
    page.set_default_timeout(PATIENCE_MS)
    page.goto(f"{address}?fixedDpr={0.25 if coarse else 1}")
    page.wait_for_function(DRAWN, arg=node, timeout=PATIENCE_MS)
    page.add_style_tag(content=NO_TOASTS)
    return page


def pixels(page: Page) -> list[list[int]]:
    """Every fourth pixel of the scene's canvas in both directions, as [r, g, b]."""
    data = page.evaluate("""() => {
      const from = window.__viserMutable.canvas, to = document.createElement("canvas");
      to.width = Math.floor(from.width / 4); to.height = Math.floor(from.height / 4);
      const draw = to.getContext("2d");
      draw.drawImage(from, 0, 0, to.width, to.height);
      return Array.from(draw.getImageData(0, 0, to.width, to.height).data);
    }""")
    return [data[i : i + 3] for i in range(0, len(data), 4)]
