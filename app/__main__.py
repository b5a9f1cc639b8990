"""Shell: the command line: reads arguments, prints, sets exit codes."""

from __future__ import annotations

import argparse
import json
import logging
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from app import __version__, profiles
from app.motion import InputError
from app.settings import Settings, parse

DEMO = Path(__file__).parent.parent / "recordings" / "demo.csv"


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one line."""

    def error(self, message: str) -> NoReturn:
        """Exit 2 with one line."""
        self.exit(2, f"{self.prog}: {' '.join(message.split())} (see {self.prog} --help)\n")


def parser() -> Parser:
    """All commands and their options (contract.md)."""
    top = Parser(
        prog="stridescope", description="Walk with inertial sensors on your feet, and watch it live."
    )
    top.add_argument("--version", action="version", version=f"stridescope {__version__}")
    commands = top.add_subparsers(dest="command", metavar="COMMAND", parser_class=Parser)

    walk = commands.add_parser("walk", help="the live page (this is the default)")
    walk.add_argument("--source", metavar="SPEC", default=None, help="a recording, replay:… or sim:walk?…")
    _add_settings(walk)
    walk.add_argument(
        "--host", default="127.0.0.1", help="address to listen on; other than loopback needs a token"
    )
    walk.add_argument("--port", type=int, default=8080)
    walk.add_argument(
        "--token-file", metavar="FILE", help="the token that browsers need (or $STRIDESCOPE_TOKEN)"
    )
    walk.add_argument(
        "--memory-mb", type=int, default=512, help="budget for samples; beyond it the oldest go"
    )
    walk.add_argument("--no-open", action="store_true", help="do not open a browser")

    process = commands.add_parser("process", help="a recording without a browser")
    process.add_argument("recording", metavar="RECORDING")
    _add_settings(process)
    process.add_argument("--out", metavar="DIR", type=Path, help="write trajectory and strides there")
    process.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    return top


def _add_settings(command: argparse.ArgumentParser) -> None:
    command.add_argument("--profile", metavar="NAME|FILE", default="papers")
    command.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="change one setting")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command. Exit code 0: done; 2: the user's input is wrong, said in one line."""
    level = os.environ.get("STRIDESCOPE_LOG", "WARNING").upper()
    logging.basicConfig(
        level=level if level in logging.getLevelNamesMapping() else "WARNING",
        format="%(levelname)s %(name)s: %(message)s",
    )
    argv = list(sys.argv[1:] if arguments is None else arguments)
    if not argv or (argv[0].startswith("-") and argv[0] not in ("-h", "--help", "--version")):
        argv.insert(0, "walk")
    options = parser().parse_args(argv)
    try:
        code = run_walk(options) if options.command == "walk" else run_process(options)
        sys.stdout.flush()
        return code
    except InputError as error:
        print(f"stridescope: {' '.join(str(error).split())}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 0
    except BrokenPipeError:  # the reader of our output has gone (a pipe into head); nothing is wrong
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115  (Python flushes it at exit)
        return 0


def run_walk(options: argparse.Namespace) -> int:
    """The live page, until Ctrl-C."""
    from app import run  # the heavy imports, after --help and --version

    if options.memory_mb < 16:
        raise InputError(f"--memory-mb {options.memory_mb}: expected 16 or more")
    run.walk(
        run.Options(
            source=options.source if options.source is not None else str(DEMO),
            settings=settings_of(options),
            host=options.host,
            port=options.port,
            token=token_of(options),
            open_browser=not options.no_open,
            budget_bytes=options.memory_mb * 2**20,
        ),
        lambda line: print(line, flush=True),
    )
    return 0


def run_process(options: argparse.Namespace) -> int:
    """A recording without a browser."""
    from app import batch

    done = batch.process(options.recording, settings_of(options))
    files = batch.write(done, options.out) if options.out else []
    if options.json:
        print(json.dumps(batch.summary(done)))
        return 0
    for line in batch.lines(done):
        print(line)
    for path in files:
        print(f"wrote {path}")
    return 0


def settings_of(options: argparse.Namespace) -> Settings:
    """The profile, with each ``--set`` on top."""
    settings = profiles.load(options.profile)
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


if __name__ == "__main__":
    sys.exit(main())
