"""What answers on a port, and two ports as two feet, with emulated sensors."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator

import pytest

from app.__main__ import main
from app.motion.basics import Role
from app.motion.samples import Sample
from app.motion.source import Link
from app.shell.emulate import Emulator, Wanted
from app.sources.devices import look
from app.sources.opening import open_recording, open_source
from app.sources.spec import parse_spec
from tests.emulated import WALK


@contextlib.asynccontextmanager
async def emulated(device: str, baud: int) -> AsyncIterator[str]:
    spec = parse_spec(f"{WALK}&loop=1")
    emulator = Emulator(Wanted(device, "", baud), *open_recording(spec), loop=True)
    task = asyncio.create_task(emulator.run())
    try:
        yield emulator.path
    finally:
        task.cancel()
        emulator.close()


def test_what_answers_is_named_with_the_spec_that_opens_it() -> None:
    async def run() -> None:
        async with emulated("mip", 460800) as port, emulated("ngimu", 115200) as other:
            mip, ngimu, none = await look([port, other, "/dev/no-such-port"], ask=False)
            assert (mip.device, mip.baud) == ("mip", 460800)
            assert mip.spec == f"serial:{port}?device=mip&baud=460800"
            assert ngimu.device == "ngimu"
            assert none.spec is None
            assert "is not there" in none.words

    asyncio.run(run())


def test_the_command_prints_one_line_for_a_port_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["devices", "/dev/no-such-port"]) == 0
    assert "/dev/no-such-port is not there: plug the sensor in" in capsys.readouterr().out


def test_two_ports_are_two_feet() -> None:
    async def run() -> None:
        async with emulated("xsens", 115200) as one, emulated("csv", 230400) as two:
            source = open_source(
                f"serial:{one},{two}?left.device=xsens&right.device=csv&left.baud=115200&right.baud=230400"
            )
            assert source.link is Link.WAITING
            seen: dict[str, int] = {}
            async with asyncio.timeout(60):
                async for item in source:
                    assert isinstance(item, Sample)
                    seen[item.sensor] = seen.get(item.sensor, 0) + 1
                    if min(seen.get("left", 0), seen.get("right", 0)) >= 20:
                        break
            assert dict(source.info.sensors) == {"left": Role.LEFT, "right": Role.RIGHT}
            assert set(source.counters) == {"left", "right"}
            assert "Xsens MTi at 115200 baud and text lines" in source.info.format
            assert any(sentence.startswith("left: mounting") for sentence in source.info.assumed)
            source.close()

    asyncio.run(run())
