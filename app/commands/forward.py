"""Shell: a source onto the network."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.commands.shared import Commands, tell, token_from
from app.motion.basics import InputError


def add(commands: Commands) -> None:
    """Its options."""
    send = commands.add_parser("forward", help="a source onto the network, for a walk on another machine")
    send.add_argument("--source", metavar="SPEC", required=True)
    send.add_argument(
        "--to",
        metavar="URL",
        required=True,
        help="ws://HOST:PORT (nothing is lost), udp://HOST:PORT or lsl:NAME",
    )
    send.add_argument(
        "--token-file", metavar="FILE", type=Path, help="the receiver's token (or $STRIDESCOPE_TOKEN)"
    )
    send.add_argument(
        "--trust", metavar="FILE", type=Path, help="believe this certificate of a wss:// receiver (PEM)"
    )
    send.add_argument(
        "--keep-mb", metavar="N", type=int, default=64, help="keep so much while the network is away"
    )


def run(options: argparse.Namespace) -> int:
    """Forward until the source ends or Ctrl-C."""
    from app.outputs.forwarder import Links
    from app.shell import forward as forwarding

    token = token_from(options.token_file, "--token-file", "STRIDESCOPE_TOKEN")
    if not 1 <= options.keep_mb <= 100_000:
        raise InputError(f"--keep-mb {options.keep_mb}: expected 1 to 100000")

    links = Links(token, options.trust, options.keep_mb * 2**20)
    tell(forwarding.forward(options.source, options.to, links, tell))
    return 0
