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

DEFAULT_PROFILE = "papers"
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
    walk.add_argument(
        "--record", metavar="DIR", type=Path, help="record from the beginning, into this folder"
    )
    walk.add_argument("--no-open", action="store_true", help="do not open a browser")

    keep = commands.add_parser("record", help="a source onto the disk, without a browser")
    keep.add_argument("--source", metavar="SPEC", required=True)
    keep.add_argument("--record", metavar="DIR", type=Path, required=True)
    keep.add_argument("--seconds", metavar="N", type=float, help="end after this many seconds")

    mend = commands.add_parser(
        "recover", help="what is whole in a damaged recording, as a new file beside it"
    )
    mend.add_argument("file", metavar="FILE")

    tell = commands.add_parser("info", help="what is in a recording")
    tell.add_argument("file", metavar="FILE")
    tell.add_argument("--json", action="store_true", help="print one JSON object and nothing else")

    give = commands.add_parser("export", help="a recording in another format, as a new file")
    give.add_argument("file", metavar="FILE")
    give.add_argument(
        "--format", required=True, choices=("csv", "tum", "strides", "gpx", "kml", "geojson", "sto"),
        help="csv: the samples; sto: orientations for OpenSim; the others: the estimated walk",
    )  # fmt: skip
    give.add_argument("--out", metavar="PATH", type=Path, help="where to (beside the recording)")
    give.add_argument("--origin", metavar="LAT,LON[,ALT]", help="where the walk starts, for a map")
    give.add_argument(
        "--declination", metavar="DEG", type=float, default=0.0, help="magnetic north east of true north"
    )
    _add_settings(give)

    process = commands.add_parser("process", help="a recording without a browser")
    process.add_argument("recording", metavar="RECORDING")
    _add_settings(process)
    process.add_argument("--out", metavar="DIR", type=Path, help="write trajectory and strides there")
    process.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    _add_gestures(commands)
    return top


def _add_gestures(commands: argparse._SubParsersAction[Parser]) -> None:
    gestures = commands.add_parser("gestures", help="what the feet ask for in a recording, without a browser")
    gestures.add_argument("recording", metavar="RECORDING", help="of two feet; or sim:gestures?…")
    gestures.add_argument("--decoder", choices=("default", "papers"), default="default")
    gestures.add_argument("--json", action="store_true", help="print one JSON object and nothing else")


def _add_settings(command: argparse.ArgumentParser) -> None:
    command.add_argument("--profile", metavar="NAME|FILE")
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
        code = RUN[options.command](options)
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
            told=options.profile is not None or bool(options.set),
            profile=Path(options.profile or DEFAULT_PROFILE).stem,
            record=options.record,
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


def run_record(options: argparse.Namespace) -> int:
    """A source onto the disk, until it ends."""
    from app import record

    if options.seconds is not None and not 0.0 < options.seconds < 1e9:
        raise InputError(f"--seconds {options.seconds:g}: expected more than 0")
    state = record.record(
        options.source, options.record, options.seconds, lambda line: print(line, flush=True)
    )
    print(f"{state.name}: {state.seconds:.1f} s, {state.size_bytes / 1e6:.2f} MB")
    if state.trouble:
        raise InputError(f"{state.name}: {state.trouble}")
    return 0


def run_recover(options: argparse.Namespace) -> int:
    """A damaged recording's whole part."""
    from app import library

    path, made = library.recover(options.file)
    print(f"wrote {path}: {made.samples} samples, {made.messages} messages in {made.chunks} whole chunks")
    return 0


def run_info(options: argparse.Namespace) -> int:
    """What is in a recording."""
    from app import library

    told = library.info(options.file)
    for line in [json.dumps(told)] if options.json else library.lines(told):
        print(line)
    return 0


def run_gestures(options: argparse.Namespace) -> int:
    """What the feet ask for in a recording."""
    from app import batch

    done = batch.decode_gestures(options.recording, options.decoder)
    if options.json:
        print(json.dumps(batch.gestures_summary(done)))
        return 0
    for line in batch.gestures_lines(done):
        print(line)
    return 0


def run_export(options: argparse.Namespace) -> int:
    """A recording in another format."""
    from app import batch, export

    wish = export.Wish(options.format, options.out, options.origin, options.declination)
    wish.place()  # before any work
    if options.format == "csv":
        files = export.samples(options.file, wish)
    else:
        done = batch.process(options.file, settings_of(options))
        files = export.walk(options.file, wish, done.recording, done.trackers)
    for path in files:
        print(f"wrote {path}")
    return 0


RUN = {
    "walk": run_walk,
    "process": run_process,
    "record": run_record,
    "recover": run_recover,
    "info": run_info,
    "export": run_export,
    "gestures": run_gestures,
}


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


if __name__ == "__main__":
    sys.exit(main())
