"""The names this machine goes by."""

from __future__ import annotations

import socket

import pytest

from app.door.access import is_ip
from app.door.addresses import everything, own_names, reachable


@pytest.mark.parametrize("host", ["", "0.0.0.0", "::"])
def test_everywhere_is_told_as_an_address(host: str) -> None:
    assert is_ip(reachable(host))
    assert reachable(host) not in ("0.0.0.0", "::")


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.1.5", "Localhost"])
def test_a_certificate_holds_what_people_type(host: str) -> None:
    names = everything(host)
    assert {"localhost", "127.0.0.1", "::1", reachable(host), socket.gethostname().lower()} <= names
    assert not {"", "0.0.0.0", "::"} & names
    assert own_names(host) - {host} <= names
