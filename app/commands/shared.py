"""Shell: what several commands share: the parser, settings, the token, the profile it starts with."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import NoReturn, Protocol

from app import profiles
from app.motion import InputError
from app.settings import Settings, parse

DEFAULT_PROFILE = "papers"


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
    settings = profiles.load(options.profile or DEFAULT_PROFILE)
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


def token_of(options: argparse.Namespace) -> str | None:
    """The token from a file or the environment; none is fine on loopback."""
    if options.token_file is None:
        return os.environ.get("STRIDESCOPE_TOKEN") or None
    try:
        token = Path(options.token_file).read_text("utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"--token-file {options.token_file}: cannot be read: {error}") from None
    if not token:
        raise InputError(f"--token-file {options.token_file}: empty, expected a token")
    return token
