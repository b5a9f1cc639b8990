"""The options of the public port: tokens where others could come in, and certificates."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest

from app.commands.shared import Parser, add_door, door_options, tell
from app.door.access import Access, Certificate
from app.motion.basics import InputError


@pytest.fixture(autouse=True)
def no_tokens(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("STRIDESCOPE_TOKEN", "STRIDESCOPE_VIEWER_TOKEN"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setenv("HOME", str(tmp_path / "home"))


def access(*arguments: str) -> Access:
    parser = Parser(prog="stridescope")
    add_door(parser)
    return door_options(parser.parse_args(arguments))


def test_on_this_machine_there_is_no_token_unless_wanted() -> None:
    assert access() == Access("127.0.0.1", 8080)
    wanted = access("--with-token")
    assert wanted.operator
    assert wanted.viewer


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "labpc", ""])
def test_where_others_come_in_tokens_are_made_new_for_each_run(host: str) -> None:
    made = [access("--host", host) for _ in range(2)]
    tokens = {token for one in made for token in (one.operator, one.viewer)}
    assert len(tokens) == 4
    assert None not in tokens


def test_tokens_are_given_by_file_or_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("STRIDESCOPE_TOKEN", "of the environment")
    monkeypatch.setenv("STRIDESCOPE_VIEWER_TOKEN", "to watch")
    file = tmp_path / "token"
    file.write_text("  of the file\n")
    assert (access().operator, access().viewer) == ("of the environment", "to watch")
    assert access("--token-file", str(file)).operator == "of the file"


def test_a_short_token_is_warned_of_and_not_told(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("STRIDESCOPE_TOKEN", "hunter2")
    assert access().operator == "hunter2"
    assert "7 characters" in caplog.text
    assert "hunter2" not in caplog.text


def test_a_viewer_s_token_alone_brings_one_for_operators(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("STRIDESCOPE_VIEWER_TOKEN", "to watch")
    assert access().viewer == "to watch"
    assert access().operator


@pytest.mark.parametrize("content", [None, b"", b"  \n", b"\xff\xfe"])
@pytest.mark.parametrize("option", ["--token-file", "--viewer-token-file"])
def test_a_token_file_that_is_none_is_one_line(tmp_path: Path, content: bytes | None, option: str) -> None:
    file = tmp_path / "token"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(InputError, match=option) as refused:
        access(option, str(file))
    assert str(file) in str(refused.value)


def test_certificates_are_given_in_pairs_or_made(tmp_path: Path) -> None:
    chain, key = tmp_path / "a.pem", tmp_path / "b.pem"
    assert access("--tls-cert", str(chain), "--tls-key", str(key)).certificate == Certificate(chain, key)
    for half in (
        ["--tls-cert", "a"],
        ["--tls-key", "b"],
        ["--tls-cert", "a", "--tls-key", "b", "--tls-made"],
    ):
        with pytest.raises(InputError, match="--tls-"):
            access(*half)
    made = access("--tls-made").certificate
    assert made is not None
    assert made.chain.is_file()
    assert access("--tls-made").certificate == made


def test_a_terminal_without_blocks_still_tells_the_address(monkeypatch: pytest.MonkeyPatch) -> None:
    out = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(out, encoding="ascii"))
    tell("█▀ at http://x")
    assert out.getvalue() == b" at http://x\n"
