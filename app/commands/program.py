"""Shell: the command line: finds the command, runs it, sets exit codes."""

from __future__ import annotations

import errno
import logging
import os
import sys
from collections.abc import Sequence

from app import __version__
from app.commands import (
    bench,
    calibrate,
    devices,
    doctor,
    emulate,
    export,
    forward,
    gestures,
    info,
    mover,
    process,
    record,
    recover,
    study,
    walk,
)
from app.commands.shared import Parser
from app.motion.basics import InputError

#: A disk that takes no more, ours or the one that standard output goes to.
_NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)

COMMANDS = {
    "walk": walk,
    "mover": mover,
    "record": record,
    "recover": recover,
    "info": info,
    "export": export,
    "forward": forward,
    "process": process,
    "gestures": gestures,
    "study": study,
    "emulate": emulate,
    "devices": devices,
    "calibrate": calibrate,
    "doctor": doctor,
    "bench": bench,
}


def parser() -> Parser:
    """All commands and their options."""
    top = Parser(
        prog="stridescope", description="Walk with inertial sensors on your feet, and watch it live."
    )
    top.add_argument("--version", action="version", version=f"stridescope {__version__}")
    commands = top.add_subparsers(dest="command", metavar="COMMAND", parser_class=Parser)
    for command in COMMANDS.values():
        command.add(commands)
    return top


def run(arguments: Sequence[str]) -> int:
    """Run a command. Exit code 0: done; 2: the user's input is wrong, said in one line."""
    level = os.environ.get("STRIDESCOPE_LOG", "WARNING").upper()
    logging.basicConfig(
        level=level if level in logging.getLevelNamesMapping() else "WARNING",
        format="%(levelname)s %(name)s: %(message)s",
    )
    argv = list(arguments)
    if not argv or (argv[0].startswith("-") and argv[0] not in ("-h", "--help", "--version")):
        argv.insert(0, "walk")
    options = parser().parse_args(argv)
    try:
        code: int = COMMANDS[options.command].run(options)
        sys.stdout.flush()
        return code
    except InputError as error:
        print(f"stridescope: {' '.join(str(error).split())}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 0
    except BrokenPipeError:  # the reader of our output has gone (a pipe into head); nothing is wrong
        _say_no_more()
        return 0
    except OSError as error:
        if error.errno not in _NO_ROOM:
            raise
        _say_no_more()
        what = error.filename or "standard output"
        print(f"stridescope: {what}: cannot be written: {error.strerror}, expected room", file=sys.stderr)
        return 2


def _say_no_more() -> None:
    """Python would write the rest at its exit, and complain."""
    sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
