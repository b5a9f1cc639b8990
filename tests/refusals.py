"""What a command says to a mistake: run in this process, for a process of its own costs two seconds."""

from __future__ import annotations

import pytest

from app.__main__ import main


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Run a command that must fail on the user's input; its one line."""
    try:
        code = main(list(arguments))
    except SystemExit as end:  # argparse's way
        code = int(end.code or 0)
    said = capsys.readouterr().err
    assert code == 2, said
    assert said.count("\n") == 1
    return said
