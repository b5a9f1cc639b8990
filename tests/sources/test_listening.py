"""Where to listen, and who may be heard there."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from app.motion.basics import InputError
from app.sources.listening import bind, options_of, place_of, token_for
from app.sources.spec import parse_spec


@pytest.mark.parametrize(
    ("text", "host", "port"),
    [
        ("ws:9000", "127.0.0.1", 9000),
        ("udp:0", "127.0.0.1", 0),
        ("udp:0.0.0.0:9000", "0.0.0.0", 9000),
        ("ws:localhost:9000", "127.0.0.1", 9000),
        ("ws:[::1]:9000?foot=left", "::1", 9000),
    ],
)
def test_a_place(text: str, host: str, port: int) -> None:
    assert place_of(parse_spec(text)) == (host, port)


@pytest.mark.parametrize(
    "text", ["ws:", "ws:abc", "ws:70000", "udp::9000", "udp:0.0.0.0:", "udp:-1", "udp:9000000"]
)
def test_no_place(text: str) -> None:
    with pytest.raises(InputError, match="expected"):
        place_of(parse_spec(text))


def test_options_are_those_of_files_and_the_links_own() -> None:
    told, own = options_of(parse_spec("udp:9000?foot=left&axes=y,x,-z&left=10.0.0.7"), ("left", "right"))
    assert told.foot == "left"
    assert own == {"left": "10.0.0.7"}
    with pytest.raises(InputError, match="speed.*expected one of"):
        options_of(parse_spec("udp:9000?speed=2"))


def test_a_token_is_needed_where_others_could_send(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spec = parse_spec("ws:0.0.0.0:9000")
    monkeypatch.delenv("STRIDESCOPE_TOKEN", raising=False)
    with pytest.raises(InputError, match="token-file"):
        token_for(spec, "0.0.0.0", None)
    file = tmp_path / "token"
    file.write_text(" secret\n")
    assert token_for(spec, "0.0.0.0", str(file)) == "secret"
    assert token_for(spec, "127.0.0.1", str(file)) == "secret"
    monkeypatch.setenv("STRIDESCOPE_TOKEN", "other")
    assert token_for(spec, "0.0.0.0", None) == "other"
    assert token_for(spec, "127.0.0.1", None) is None
    with pytest.raises(InputError, match="cannot be read"):
        token_for(spec, "127.0.0.1", str(tmp_path / "none"))


@pytest.mark.parametrize("kind", [socket.SOCK_STREAM, socket.SOCK_DGRAM])
def test_a_taken_port_and_a_foreign_host_are_said(kind: socket.SocketKind) -> None:
    with socket.socket(socket.AF_INET, kind) as other:
        other.bind(("127.0.0.1", 0))
        if kind is socket.SOCK_STREAM:
            other.listen()
        port = other.getsockname()[1]
        with pytest.raises(InputError, match=f"port {port} is taken"):
            bind(parse_spec(f"ws:{port}"), "127.0.0.1", port, kind)
    with pytest.raises(InputError, match="expected"):
        bind(parse_spec("ws:203.0.113.7:9000"), "203.0.113.7", 9000, kind)
