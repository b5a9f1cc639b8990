"""One port on the loop, with the far end of a pseudo-terminal in hand."""

from __future__ import annotations

import asyncio
import math
import os
import tty
from collections.abc import Iterator
from itertools import pairwise

import pytest

from app.sources.opening import open_source
from app.sources.port import Port, open_port
from tests.sources.links import Reader

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


def test_a_board_without_a_header_is_read_by_the_columns_that_are_named(ends: tuple[int, str]) -> None:
    master, path = ends
    names = "t_ms,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps"

    async def run() -> None:
        source = open_source(f"serial:{path}?device=csv&baud=115200&columns={names}&axes=x,y,z")
        reader = Reader(source)
        row = 0
        async with asyncio.timeout(90):
            while len(reader.got) < 20:
                os.write(master, f"{10 * row},0.00,0.50,1.00,{row}.00,0.00,0.00\r\n".encode())
                row += 1
                await asyncio.sleep(0.01)
        for sample, after in pairwise(reader.got):
            assert sample.specific_force_b == pytest.approx((0.0, 0.5 * 9.80665, 9.80665))
            assert after.angular_rate_b[0] - sample.angular_rate_b[0] == pytest.approx(math.radians(1.0))
            assert after.device_ns - sample.device_ns == 10_000_000
        reader.stop()

    asyncio.run(run())
