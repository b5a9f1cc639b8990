"""The library behind the door: for operators, in the folder, bounded, and nothing is left of what failed."""

from __future__ import annotations

import http.client
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import quote

import pytest

from app.door.access import Access
from app.door.files import Files
from app.door.front import Door
from app.motion.basics import InputError

OPERATOR, VIEWER = "o" * 22, "v" * 22
BYTES = "application/octet-stream"


def receive(part: Path, name: str) -> str:
    if part.read_bytes().startswith(b"bad"):
        raise InputError(f"{name}: no <recording>")
    part.rename(part.parent / name)
    return f"{name}: kept"


@contextmanager
def a_door(folder: Path, access: Access | None = None, most: int = 100_000) -> Iterator[Door]:
    files = Files(folder, receive, most)
    door = Door(access or Access(port=0), viser_port=9, rules=dict, health=dict, files=files)
    door.start()
    try:
        yield door
    finally:
        door.stop()


def ask(door: Door, method: str, path: str, body: bytes | None = None, **headers: str) -> tuple[int, bytes]:
    host = f"127.0.0.1:{door.access.port}"
    connection = http.client.HTTPConnection(host, timeout=60)
    named = {"Content-Type": BYTES, **{name.replace("_", "-"): value for name, value in headers.items()}}
    connection.request(method, path, body, named)
    answer = connection.getresponse()
    found = answer.status, answer.read()
    connection.close()
    return found


def left(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_a_file_goes_in_and_comes_out(tmp_path: Path) -> None:
    data = bytes(range(256)) * 300
    with a_door(tmp_path / "new") as door:
        assert ask(door, "POST", f"/files?name={quote('Gang (1).mcap')}", data) == (
            200,
            b"Gang (1).mcap: kept\n",
        )
        assert ask(door, "GET", f"/files/{quote('Gang (1).mcap')}") == (200, data)
    assert left(tmp_path / "new") == {"Gang (1).mcap"}


def test_what_cannot_be_read_is_told_and_not_kept(tmp_path: Path) -> None:
    with a_door(tmp_path) as door:
        status, told = ask(door, "POST", "/files?name=photo.csv", b"bad")
    assert (status, told) == (422, b"photo.csv: no <recording>\n")
    assert left(tmp_path) == set()


def test_one_too_large_is_refused(tmp_path: Path) -> None:
    with a_door(tmp_path, most=1000) as door:
        assert ask(door, "POST", "/files?name=a.csv", bytes(1001))[0] == 413
        assert ask(door, "POST", "/files?name=a.csv", bytes(1000))[0] == 200
    assert left(tmp_path) == {"a.csv"}


@pytest.mark.parametrize(
    "name", ["../a.csv", "..%2fa.csv", "%2e%2e%2fa.csv", "/etc/passwd", "", ".a", "a%00"]
)
def test_no_name_leads_out_of_the_folder(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "in"
    folder.mkdir()
    (tmp_path / "a.csv").write_text("secret")
    with a_door(folder) as door:
        status, told = ask(door, "GET", f"/files/{name}")
        assert status in (403, 404, 502)
        assert b"secret" not in told
        assert ask(door, "POST", f"/files?name={name}", b"x")[0] == 422
    assert left(tmp_path) == {"in", "a.csv"}
    assert left(folder) == set()


def test_a_link_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "secret.csv").write_text("secret")
    folder = tmp_path / "in"
    folder.mkdir()
    (folder / "a.csv").symlink_to(tmp_path / "secret.csv")
    with a_door(folder) as door:
        assert ask(door, "GET", "/files/a.csv")[0] == 404


def test_files_are_for_operators(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("mine")
    with a_door(tmp_path, Access(port=0, operator=OPERATOR, viewer=VIEWER)) as door:
        cookies = {token: cookie(door, token) for token in (OPERATOR, VIEWER)}
        assert ask(door, "GET", "/files/a.csv")[0] == 401
        assert ask(door, "GET", "/files/a.csv", Cookie=cookies[VIEWER])[0] == 403
        assert ask(door, "POST", "/files?name=b.csv", b"x", Cookie=cookies[VIEWER])[0] == 403
        assert ask(door, "GET", "/files/a.csv", Cookie=cookies[OPERATOR]) == (200, b"mine")
        assert ask(door, "POST", "/files?name=b.csv", b"x", Cookie=cookies[OPERATOR])[0] == 200


def cookie(door: Door, token: str) -> str:
    connection = http.client.HTTPConnection(f"127.0.0.1:{door.access.port}", timeout=60)
    connection.request("GET", f"/?token={token}")
    return (connection.getresponse().getheader("Set-Cookie") or "").partition(";")[0]


def test_another_sites_form_cannot_upload(tmp_path: Path) -> None:
    with a_door(tmp_path) as door:
        assert ask(door, "POST", "/files?name=b.csv", b"x", Origin="http://evil.example")[0] == 403
        assert ask(door, "POST", "/files?name=b.csv", b"x", Content_Type="text/plain")[0] == 415
    assert left(tmp_path) == set()
