"""One port on the loop, with the far end of a pseudo-terminal in hand."""

from __future__ import annotations

import asyncio
import os
import tty
from collections.abc import Iterator

import pytest

from app.sources.port import Port, open_port

HEADER = b"t_ms,ax_g,ay_g,az_g\r\n"


@pytest.fixture
def ends() -> Iterator[tuple[int, str]]:
    """The board's end, and the path of the host's."""
    master, slave = os.openpty()
    tty.setraw(slave)
    yield master, os.ttyname(slave)
    os.close(slave)
    os.close(master)


async def opened_and_told(master: int, path: str) -> Port:
    """A port that has received a header since it was opened at 230400 baud."""
    port = await open_port(path, 230400)
    os.write(master, HEADER)
    async with asyncio.timeout(60):
        while sum(len(data) for _, data in port._arrived) < len(HEADER):
            await asyncio.sleep(0.01)
    return port


@pytest.mark.parametrize(("baud", "kept"), [(230400, HEADER), (115200, b"")])
def test_what_a_board_says_at_once_is_kept_where_the_rate_was_known(
    ends: tuple[int, str], baud: int, kept: bytes
) -> None:
    async def run() -> None:
        port = await opened_and_told(*ends)
        port.set_baud(baud)
        assert b"".join(data for _, data in await port.read(0.0)) == kept
        await port.close()

    asyncio.run(run())
