"""Shell: what several commands share: the parser, settings, the public port, the profile it starts with."""

from __future__ import annotations

import argparse
import datetime
import json
import logging
import os
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NoReturn, Protocol

from app.door.access import Access, Certificate, is_loopback, made_token
from app.door.addresses import everything
from app.home import profiles
from app.motion.basics import InputError
from app.settings import Settings, parse

log = logging.getLogger(__name__)

DEFAULT_PROFILE = "default"
LONG_TOKEN = 12


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one line."""

    def error(self, message: str) -> NoReturn:
        """Exit 2 with one line."""
        self.exit(2, f"{self.prog}: {' '.join(message.split())} (see {self.prog} --help)\n")


class Commands(Protocol):
    """Where a command adds its own parser."""

    def add_parser(self, name: str, *, help: str) -> Parser:
        """A parser for the command's own options."""
        ...


def add_settings(command: argparse.ArgumentParser) -> None:
    """The options that choose an estimator's settings."""
    command.add_argument("--profile", metavar="NAME|FILE")
    command.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="change one setting")


def add_json(command: argparse.ArgumentParser) -> None:
    """The option for one JSON object."""
    command.add_argument("--json", action="store_true", help="print one JSON object and nothing else")


def settings_of(options: argparse.Namespace) -> Settings:
    """The profile, with each ``--set`` on top."""
    settings = profiles.load(DEFAULT_PROFILE if options.profile is None else options.profile)
    changes = {}
    for text in options.set:
        key, equals, value = text.partition("=")
        if not equals:
            raise InputError(f"--set {text}: expected KEY=VALUE")
        try:
            changes[key.strip()] = parse(key.strip(), value.strip())
        except ValueError as error:
            raise InputError(f"--set {error}") from None
    try:
        return settings.with_changes(changes)
    except ValueError as error:
        raise InputError(f"--set {error}") from None


def add_door(command: argparse.ArgumentParser) -> None:
    """The options of the public port: where it listens, and who may come in."""
    command.add_argument(
        "--host", default="127.0.0.1", help="address to listen on; other than loopback always with tokens"
    )
    command.add_argument("--port", type=int, default=8080)
    command.add_argument(
        "--token-file", metavar="FILE", type=Path,
        help="the token of who operates (or $STRIDESCOPE_TOKEN); else one is made where one is needed",
    )  # fmt: skip
    command.add_argument(
        "--viewer-token-file", metavar="FILE", type=Path,
        help="the token of who only watches (or $STRIDESCOPE_VIEWER_TOKEN); else made likewise",
    )  # fmt: skip
    command.add_argument(
        "--with-token", action="store_true", help="make tokens on loopback too: other people use this machine"
    )
    command.add_argument(
        "--tls-cert", metavar="FILE", type=Path, help="speak https with this PEM certificate"
    )
    command.add_argument("--tls-key", metavar="FILE", type=Path, help="its key, without a password")
    command.add_argument(
        "--tls-made", action="store_true",
        help="speak https with a certificate made here (phones give their sensors to https only)",
    )  # fmt: skip
    command.add_argument("--no-open", action="store_true", help="do not open a browser")


def door_options(options: argparse.Namespace) -> Access:
    """Where to listen, and the tokens: given, or made for this run where others could come in."""
    operator = token_from(options.token_file, "--token-file", "STRIDESCOPE_TOKEN")
    viewer = token_from(options.viewer_token_file, "--viewer-token-file", "STRIDESCOPE_VIEWER_TOKEN")
    for given in (operator, viewer):
        _warn_of_short(given)
    if operator or viewer or options.with_token or not is_loopback(options.host):
        operator, viewer = operator or made_token(), viewer or made_token()
    return Access(options.host, options.port, operator, viewer, _certificate(options))


def _certificate(options: argparse.Namespace) -> Certificate | None:
    chain, key = options.tls_cert, options.tls_key
    if (chain is None) != (key is None):
        raise InputError("--tls-cert and --tls-key: expected both or neither")
    if chain is not None and options.tls_made:
        raise InputError("--tls-made: a certificate was given as well, expected one of them")
    if options.tls_made:
        from app.door import selfmade  # only who wants it waits for it

        now = datetime.datetime.now(datetime.UTC)
        return selfmade.made(profiles.folder().parent / "tls", everything(options.host), now)
    return None if chain is None else Certificate(chain, key)


def answer(json_wanted: bool, told: Mapping[str, object], lines: Iterable[str]) -> int:
    """What a command found, as one JSON object or as lines for a person; the exit code."""
    for line in [json.dumps(told)] if json_wanted else lines:
        print(line)
    return 0


def wrote(files: Iterable[Path]) -> list[str]:
    """Which files were written."""
    return [f"wrote {path}" for path in files]


def tell(line: str) -> None:
    """Print a line now; what the terminal has no letters for (a QR code's blocks) is left out."""
    encoding = sys.stdout.encoding or "utf-8"
    print(line.encode(encoding, "ignore").decode(encoding), flush=True)


def token_from(file: Path | None, option: str, variable: str) -> str | None:
    """The token in a file, else the environment's; None where there is neither."""
    if file is None:
        return os.environ.get(variable) or None
    try:
        token = file.read_text("utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{option} {file}: cannot be read: {error}") from None
    if not token:
        raise InputError(f"{option} {file}: empty, expected a token")
    return token


def _warn_of_short(token: str | None) -> None:
    if token and len(token) < LONG_TOKEN:
        log.warning("a token of %d characters can be guessed: give %d or more", len(token), LONG_TOKEN)
