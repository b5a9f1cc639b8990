"""Shell: a recording without a browser."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from app.commands.shared import Commands, add_json, add_settings, answer, settings_of, wrote
from app.commands.workers import add_workers, bar, jobs_of

if TYPE_CHECKING:
    from app.sources.spec import Spec


def add(commands: Commands) -> None:
    """Its options."""
    process = commands.add_parser("process", help="a recording, or a folder of them, without a browser")
    process.add_argument("recording", metavar="RECORDING|FOLDER")
    add_settings(process)
    process.add_argument("--out", metavar="DIR", type=Path, help="write trajectory and strides there")
    process.add_argument(
        "--bias-from",
        metavar="RECORDING",
        help="begin with the gyro bias told by this one, of the same sensor",
    )
    add_json(process)
    add_workers(process)


def run(options: argparse.Namespace) -> int:
    """A recording without a browser."""
    from app.shell import batch
    from app.sources.spec import parse_spec

    spec = parse_spec(options.recording)
    if spec.kind == "replay" and Path(spec.target).expanduser().is_dir():
        return run_folder(options, spec)
    done = batch.process(options.recording, settings_of(options), options.bias_from)
    files = batch.write(done, options.out) if options.out else []
    return answer(options.json, batch.summary(done), [*batch.lines(done), *wrote(files)])


def run_folder(options: argparse.Namespace, spec: Spec) -> int:
    """Every recording of a folder."""
    from app.shell import batch

    done = batch.process_folder(
        spec, settings_of(options), options.out, jobs_of(options), options.cluster, bar
    )
    return answer(options.json, batch.folder_summary(done), batch.folder_lines(done))
