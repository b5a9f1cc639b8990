"""viser's own page behind the door in a real Chromium: under our policy it works, markup does not."""

from __future__ import annotations

import http.server
import threading
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
import viser
from playwright.sync_api import Browser, BrowserContext, Page
from viser import uplot

from app.motion.door import GuiRule
from tests.conftest import PATIENCE_MS

DRAWN = """() => {
    const points = window.__viserTestpoints, tree = window.__viserSceneTree;
    return points && tree && '/ned/foot' in tree.getState()
        && points.rendererInfo.render.triangles > 0 && points.rendererInfo.render.frame > 2;
}"""
ORANGE_PIXELS = """() => {
    const from = window.__viserMutable.canvas, to = document.createElement('canvas');
    to.width = from.width; to.height = from.height;
    const pen = to.getContext('2d');
    pen.drawImage(from, 0, 0);
    const data = pen.getImageData(0, 0, to.width, to.height).data;
    let found = 0;
    for (let i = 0; i < data.length; i += 4) found += data[i] > data[i + 2] + 60;
    return found;
}"""
KNOCK = """([url, protocol]) => new Promise(done => {
    const socket = new WebSocket(url, [protocol]);
    socket.onopen = () => done('open');
    socket.onerror = () => done('refused');
})"""
HOSTILE = (
    "<img src=x onerror='window.ran=1'><script>window.ran=2</script>"
    "<b onclick='window.ran=3'>here</b> [link](javascript:window.ran=4)"
)


@pytest.fixture
def context(browser: Browser) -> Iterator[BrowserContext]:
    made = browser.new_context(viewport={"width": 640, "height": 360})
    made.set_default_timeout(PATIENCE_MS)
    yield made
    made.close()


def furnish(server: viser.ViserServer) -> None:
    """What our page uses of viser: each kind asks something else of the policy."""
    server.scene.add_icosphere("/ned/foot", radius=1.0, color=(255, 140, 0))
    server.scene.add_label("/ned/label", "N")
    server.scene.add_grid("/ned/grid")
    server.scene.configure_environment_map("sunset")
    line = np.arange(10.0)
    series = (uplot.Series(label="t"), uplot.Series(label="rate", stroke="orange"))
    server.gui.add_uplot((line, line**2), series=series)
    server.gui.add_image(np.full((4, 4, 3), 200, np.uint8))
    server.gui.add_markdown("**bold**")
    server.gui.add_html("<style>.ours{color:red}</style><span class=ours>html</span>")


def visit(context: BrowserContext, house: Any) -> tuple[Page, list[str]]:
    """The page when its scene is drawn, and whatever it complained of."""
    complaints: list[str] = []
    page = context.new_page()
    page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: complaints.append(error.message))
    page.on("requestfailed", lambda request: complaints.append(request.url[:100]))
    page.goto(house.door.address + ("&" if "?" in house.door.address else "/?") + "fixedDpr=1")
    page.wait_for_function(DRAWN)
    return page, complaints


def test_the_page_works_through_the_door(
    context: BrowserContext, open_house: Callable[..., Any], wait: Callable[..., None]
) -> None:
    head = "<style>body{--ours:1}</style><script>window.ours = 1</script>"
    house = open_house(operator="a token", extra_head=head)
    furnish(house.viser)
    pressed: list[str] = []
    hotkey = house.viser.gui.add_command("Reset heading", hotkey="R")
    hotkey.on_trigger(lambda event: pressed.append("hotkey"))
    button = house.viser.gui.add_button("press me")
    button.on_click(lambda event: pressed.append("button"))
    house.rules.update({handle._impl.uuid: GuiRule("button") for handle in (hotkey, button)})

    page, complaints = visit(context, house)
    assert page.url == f"{house.origin}/?fixedDpr=1"  # the token has left the address
    assert page.evaluate("window.ours") == 1
    wait(lambda: page.evaluate(ORANGE_PIXELS) > 1000)
    page.get_by_text("press me").dispatch_event("click")
    wait(lambda: pressed == ["button"])
    page.keyboard.press("r")
    wait(lambda: pressed == ["button", "hotkey"])
    page.get_by_role("slider").first.focus()
    page.keyboard.press("End")
    wait(lambda: house.slider.value == 2.0)
    assert complaints == []
    assert house.door.counters.dropped_messages == {}
    assert house.door.counters.connections == 1


def test_script_in_markup_does_not_run(context: BrowserContext, open_house: Callable[..., Any]) -> None:
    house = open_house()
    furnish(house.viser)
    house.viser.gui.add_markdown(HOSTILE)
    house.viser.gui.add_html(HOSTILE)
    page, complaints = visit(context, house)
    for here in page.get_by_text("here", exact=True).all():
        here.dispatch_event("click")
    assert page.evaluate("window.ran") is None
    assert any("Content Security Policy" in complaint for complaint in complaints)


@pytest.fixture
def elsewhere() -> Iterator[str]:
    """The address of an empty page on another port of this machine."""

    class Empty(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Length", "0")
            self.end_headers()

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Empty)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()
    server.server_close()


def test_a_page_from_elsewhere_gets_no_websocket(context: BrowserContext, house: Any, elsewhere: str) -> None:
    page = context.new_page()
    page.goto(elsewhere)
    answer = page.evaluate(KNOCK, [f"ws://127.0.0.1:{house.port}/", f"viser-v{viser.__version__}"])
    assert answer == "refused"
    assert house.door.counters.refused_origin == 1
    page.goto(f"{house.origin}/healthz")  # the same words from our own origin
    answer = page.evaluate(KNOCK, [f"ws://127.0.0.1:{house.port}/", f"viser-v{viser.__version__}"])
    assert answer == "refused"  # by the policy of that page
    assert house.door.counters.connections_total == 0
