"""The file to hand in: for operators, as an attachment; what is missing is said in one line."""

from __future__ import annotations

import http.client
from collections.abc import Callable

from app.door.access import Access
from app.door.front import Door
from app.door.hand_in import HandIn
from app.motion.basics import InputError
from app.motion.door import HAND_IN

OPERATOR, VIEWER = "o" * 22, "v" * 22


def asked(
    make: Callable[[], tuple[str, bytes]], token: str = OPERATOR
) -> tuple[http.client.HTTPResponse, bytes]:
    access = Access(port=0, operator=OPERATOR, viewer=VIEWER)
    door = Door(access, viser_port=9, rules=dict, health=dict, hand_in=HandIn(make))
    door.start()
    try:
        connection = http.client.HTTPConnection(f"127.0.0.1:{door.access.port}", timeout=60)
        headers = {"Authorization": f"Bearer {token}"}
        connection.request("GET", HAND_IN, headers=headers)
        answer = connection.getresponse()
        return answer, answer.read()
    finally:
        door.stop()


def test_it_is_saved_and_never_shown_as_a_page_of_ours() -> None:
    answer, body = asked(lambda: ("Gyro bias ½.html", b"<html>"))
    assert (answer.status, body) == (200, b"<html>")
    assert answer.getheader("Content-Disposition") == "attachment; filename*=UTF-8''Gyro%20bias%20%C2%BD.html"
    assert answer.getheader("Content-Type") == "application/octet-stream"


def test_a_viewer_only_watches() -> None:
    def never() -> tuple[str, bytes]:
        raise AssertionError("made for a viewer")

    assert asked(never, VIEWER)[0].status == 403


def test_what_is_missing_is_one_line() -> None:
    def nothing() -> tuple[str, bytes]:
        raise InputError("no samples yet")

    answer, body = asked(nothing)
    assert (answer.status, body) == (409, b"409: no samples yet\n")
