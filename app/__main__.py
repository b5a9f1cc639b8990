"""Shell: the program, ``stridescope`` or ``python -m app``: ready for Ctrl-C before anything is imported."""

from __future__ import annotations

import io
import os
import signal
import sys
from collections.abc import Sequence


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line (``commands/program.py``); None: as the program itself, whose process this is."""
    if arguments is None:
        open_streams()
        end_by_signal()
    from app.commands import program  # numpy and the compiler: a second in which Ctrl-C may come

    code = program.run(sys.argv[1:] if arguments is None else arguments)
    if arguments is None:
        end_by_signal()
    return code


def end_by_signal() -> None:
    """Ctrl-C ends the process at once and without a word; what has something to close sets its own handler.

    Python's own exception could come up anywhere, in the compiler too. Where Ctrl-C is ignored it stays so.
    """
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


def open_streams() -> None:
    """Where the caller closed one of the three, nothing stands in: no file of ours gets its number.

    A letter that the terminal does not have becomes a question mark.
    """
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(number, True)
    os.close(number)
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115  (for good)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")


if __name__ == "__main__":
    sys.exit(main())
