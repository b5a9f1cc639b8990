"""Shell: a recording in another format."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.commands.shared import Commands, add_settings, settings_of


def add(commands: Commands) -> None:
    """Its options."""
    give = commands.add_parser("export", help="a recording in another format, as a new file")
    give.add_argument("file", metavar="FILE")
    give.add_argument(
        "--format", required=True, choices=("csv", "tum", "strides", "gpx", "kml", "geojson", "sto", "html"),
        help="csv: the samples; sto: orientations for OpenSim; html: a page that plays the walk offline;"
        " the others: the estimated walk",
    )  # fmt: skip
    give.add_argument("--out", metavar="PATH", type=Path, help="where to (beside the recording)")
    give.add_argument("--origin", metavar="LAT,LON[,ALT]", help="where the walk starts, for a map")
    give.add_argument(
        "--declination", metavar="DEG", type=float, default=0.0, help="magnetic north east of true north"
    )
    add_settings(give)


def run(options: argparse.Namespace) -> int:
    """A recording in another format."""
    from app.shell import batch
    from app.shell import export as exports

    wish = exports.Wish(options.format, options.out, options.origin, options.declination)
    wish.place()  # before any work
    if options.format == "csv":
        files = exports.samples(options.file, wish)
    elif options.format == "html":
        from app.shell import film

        files = [film.share(options.file, settings_of(options), wish.path(options.file))]
    else:
        done = batch.process(options.file, settings_of(options))
        files = exports.walk(options.file, wish, done.recording, batch.foot_tables(done))
    for path in files:
        print(f"wrote {path}")
    return 0
