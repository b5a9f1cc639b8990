"""TLS: a certificate given or made here; what is wrong with it is one line; plain callers are told."""

from __future__ import annotations

import asyncio
import datetime
import socket
import ssl
import stat
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import pytest
import websockets.asyncio.client as ws
from cryptography import x509

from app.door import listening, selfmade, tls
from app.door.access import Access, Certificate
from app.door.front import Door
from app.motion.basics import InputError
from tests.door.conftest import VERSION

NOW = datetime.datetime.now(datetime.UTC)
NAMES = frozenset({"localhost", "127.0.0.1", "::1", "labpc.local"})


@pytest.fixture
def certificate(tmp_path: Path) -> Certificate:
    return selfmade.made(tmp_path / "tls", NAMES, NOW)


def trusting(certificate: Certificate) -> ssl.SSLContext:
    return ssl.create_default_context(cafile=str(certificate.chain))


def test_a_client_that_trusts_it_comes_in_by_each_name(certificate: Certificate, open_house: Any) -> None:
    house = open_house(certificate=certificate)
    assert house.door.address.startswith("https://127.0.0.1:")
    for name in ("localhost", "127.0.0.1"):
        address = f"https://{name}:{house.port}/"
        with urllib.request.urlopen(address, context=trusting(certificate)) as answer:
            assert answer.status == 200
    assert asyncio.run(_answer_over_tls(house.port, trusting(certificate)))


async def _answer_over_tls(port: int, context: ssl.SSLContext) -> bytes | str:
    """Asked by one thread: the ``sync`` client reads in a second one, both on one TLS object without a
    lock, and about one request in 700 is lost (Python 3.11).
    """
    async with ws.connect(
        f"wss://127.0.0.1:{port}/", origin=f"https://127.0.0.1:{port}", subprotocols=[VERSION],  # type: ignore[arg-type, list-item]
        ssl=context, compression=None, max_size=None, open_timeout=60,
    ) as websocket:  # fmt: skip
        await websocket.send(msgspec.msgpack.encode({"type": "ShareUrlRequest"}))
        async with asyncio.timeout(60):
            return await websocket.recv()


def test_the_cookie_is_for_tls_only(certificate: Certificate, open_house: Any) -> None:
    house = open_house(certificate=certificate, operator="secret-token")
    context = trusting(certificate)
    opener = urllib.request.build_opener(urllib.request.HTTPSHandler(context=context), NoRedirect())
    with pytest.raises(urllib.error.HTTPError) as answer:
        opener.open(f"{house.door.address}")
    cookie = answer.value.headers["Set-Cookie"]
    assert cookie.startswith(f"__Host-stridescope-{house.port}=")
    assert {"Secure", "HttpOnly", "SameSite=Strict", "Path=/"} <= set(cookie.split("; "))


class NoRedirect(urllib.request.HTTPRedirectHandler):
    def redirect_request(self, *_: Any) -> None:
        return None


def test_who_speaks_plain_is_told_and_nobody_waits_for_who_says_nothing(
    certificate: Certificate, open_house: Any
) -> None:
    house = open_house(certificate=certificate)
    silent = [house.say(b"") for _ in range(5)] + [house.say(b"\x16")]
    answer = house.say(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n").recv(4096).decode()
    assert answer.startswith("HTTP/1.1 400 ")
    assert "https://" in answer
    with urllib.request.urlopen(f"{house.door.address}/", context=trusting(certificate)) as page:
        assert page.status == 200
    house.door.stop()
    for connection in silent:
        connection.close()


def test_one_caller_from_outside_holds_few_that_never_begin(
    certificate: Certificate, open_house: Any, wait: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(listening, "is_loopback", lambda address: False)
    house = open_house(certificate=certificate)
    for _ in range(listening.MAX_SOCKETS_OF_ONE + 6):
        house.say(b"")
    wait(lambda: house.door.counters.refused_full >= 6)
    assert house.door.counters.refused_full == 6


@pytest.mark.filterwarnings("ignore:ssl.TLSVersion")
def test_old_tls_stays_outside(certificate: Certificate, open_house: Any) -> None:
    house = open_house(certificate=certificate)
    old = trusting(certificate)
    old.maximum_version = ssl.TLSVersion.TLSv1_1
    old.set_ciphers("ALL:@SECLEVEL=0")
    with socket.create_connection(("127.0.0.1", house.port)) as plain, pytest.raises(OSError):
        old.wrap_socket(plain, server_hostname="127.0.0.1")


def test_it_is_kept_until_a_name_or_the_time_asks_for_another(tmp_path: Path) -> None:
    folder = tmp_path / "config" / "tls"
    first = tls.fingerprint(selfmade.made(folder, NAMES, NOW))
    assert tls.fingerprint(selfmade.made(folder, NAMES - {"labpc.local"}, NOW)) == first
    later = NOW + selfmade.VALID
    assert tls.fingerprint(selfmade.made(folder, NAMES, later - 2 * selfmade.RENEW)) == first
    renewed = tls.fingerprint(selfmade.made(folder, NAMES, later))
    moved = tls.fingerprint(selfmade.made(folder, NAMES | {"10.1.2.3"}, later))
    assert len({first, renewed, moved}) == 3


@pytest.mark.parametrize("damage", [b"", b"-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n"])
@pytest.mark.parametrize("which", [0, 1])
def test_a_damaged_one_is_made_anew(
    tmp_path: Path, certificate: Certificate, which: int, damage: bytes
) -> None:
    before = tls.fingerprint(certificate)
    certificate[which].write_bytes(damage)
    assert tls.fingerprint(selfmade.made(tmp_path / "tls", NAMES, NOW)) != before


def test_the_key_is_its_owner_s_alone(certificate: Certificate) -> None:
    assert stat.S_IMODE(certificate.key.stat().st_mode) == 0o600


def test_it_serves_and_signs_nothing_else(certificate: Certificate) -> None:
    parsed = x509.load_pem_x509_certificate(certificate.chain.read_bytes())
    assert parsed.extensions.get_extension_for_class(x509.BasicConstraints).value.ca is False
    assert parsed.not_valid_after_utc - NOW < datetime.timedelta(days=398)


def refused(make: Callable[[], object]) -> str:
    with pytest.raises(InputError) as error:
        make()
    assert "\n" not in str(error.value)
    return str(error.value)


def test_what_is_wrong_with_given_files_is_one_line(tmp_path: Path, certificate: Certificate) -> None:
    text, missing = tmp_path / "text.pem", tmp_path / "missing.pem"
    text.write_text("no certificate\n")
    other = selfmade.made(tmp_path / "other", NAMES, NOW)
    for chain, key, word in (
        (missing, certificate.key, "missing.pem"), (certificate.chain, missing, "missing.pem"),
        (tmp_path, certificate.key, str(tmp_path)), (text, certificate.key, "text.pem"),
        (certificate.chain, text, "text.pem"), (certificate.chain, other.key, "mismatch"),
    ):  # fmt: skip
        access = Access(port=0, certificate=Certificate(chain, key))
        assert word in refused(Door(access, viser_port=9, rules=dict, health=dict).start)


def test_a_key_with_a_password_is_said_and_nothing_is_asked(tmp_path: Path, certificate: Certificate) -> None:
    from cryptography.hazmat.primitives import serialization as ser

    key = ser.load_pem_private_key(certificate.key.read_bytes(), None)
    locked = tmp_path / "locked.pem"
    secret = ser.BestAvailableEncryption(b"secret")
    locked.write_bytes(key.private_bytes(ser.Encoding.PEM, ser.PrivateFormat.PKCS8, secret))
    assert "password" in refused(lambda: tls.context(Certificate(certificate.chain, locked)))


def test_a_folder_that_cannot_be_made_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "wall").write_text("")
    assert "--tls-made" in refused(lambda: selfmade.made(tmp_path / "wall" / "tls", NAMES, NOW))
