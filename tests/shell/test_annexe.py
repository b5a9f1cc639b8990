from __future__ import annotations

import asyncio
import json
import urllib.error
import urllib.request
from pathlib import Path

import pytest

from app.door.access import Access, Certificate
from app.motion.basics import InputError
from app.shell.annexe import Annexe, address_in, door_arguments, environment


@pytest.mark.parametrize(
    ("line", "address"),
    [
        ("Stridescope is at http://127.0.0.1:8081  (Ctrl-C ends it)\n", "http://127.0.0.1:8081/"),
        ("Stridescope is at https://10.0.0.7:9/?token=s3cret  (Ctrl-C ends it)", "https://10.0.0.7:9/"),
        ("http://[::1]:80/", "http://[::1]:80/"),
        ("stridescope: no such thing", ""),
        ("", ""),
    ],
)
def test_an_address_is_told_without_its_token(line: str, address: str) -> None:
    assert address_in(line) == address


def test_the_town_has_the_locks_of_the_walk() -> None:
    access = Access("0.0.0.0", 1, "to operate", "to watch", Certificate(Path("c.pem"), Path("k.pem")))
    assert door_arguments(access) == ["--host", "0.0.0.0", "--tls-cert", "c.pem", "--tls-key", "k.pem"]
    told = environment(access)
    assert (told["STRIDESCOPE_TOKEN"], told["STRIDESCOPE_VIEWER_TOKEN"]) == ("to operate", "to watch")


def test_no_token_means_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("STRIDESCOPE_TOKEN", "somebody else's")
    assert "STRIDESCOPE_TOKEN" not in environment(Access())
    assert door_arguments(Access()) == ["--host", "127.0.0.1"]


def test_it_opens_once_and_ends_with_the_walk() -> None:
    async def scenario() -> str:
        said: list[str] = []
        annexe = Annexe(Access(), said.append)
        annexe.open()
        while not annexe.address:
            await asyncio.sleep(0.1)
        address = annexe.address
        with pytest.raises(InputError, match=address):
            annexe.open()
        health = await asyncio.to_thread(lambda: json.load(urllib.request.urlopen(f"{address}healthz")))
        assert health["ok"] is True
        assert said == ["Opening the town", ""]
        await annexe.close()
        assert annexe.address == ""
        return address

    address = asyncio.run(scenario())
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(f"{address}healthz", timeout=30)


def test_a_machine_that_starts_no_process_is_told_and_ends_in_peace(monkeypatch: pytest.MonkeyPatch) -> None:
    async def refused(*_: object, **__: object) -> None:
        raise BlockingIOError(11, "Resource temporarily unavailable")

    async def scenario() -> list[str]:
        said: list[str] = []
        annexe = Annexe(Access(), said.append)
        annexe.open()
        await asyncio.sleep(0.01)
        await annexe.close()
        return said

    monkeypatch.setattr(asyncio, "create_subprocess_exec", refused)
    first, last = asyncio.run(scenario())
    assert first == "Opening the town"
    assert "Resource temporarily unavailable" in last
