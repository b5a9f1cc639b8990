"""Edge: the serial ports there are, and what answers on each."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass

from serial.tools.list_ports import comports

from app.formats.wire.catalogue import KINDS
from app.sources.port import PortLostError, open_port
from app.sources.serial_port import FIRST_BAUD
from app.sources.starting import Wish, find


@dataclass(frozen=True)
class Device:
    """A port, and in words what is there; ``device`` (a key of ``KINDS``) and ``baud`` if that is known."""

    port: str
    hardware: str  # what the adapter says of itself
    words: str
    device: str | None = None
    baud: int | None = None

    @property
    def spec(self) -> str | None:
        """The SPEC that opens it."""
        return f"serial:{self.port}?device={self.device}&baud={self.baud}" if self.device else None


async def look(ports: Sequence[str], ask: bool) -> list[Device]:
    """Look at these ports, or at all there are; all at once, each for some seconds."""
    known = {port.device: port for port in sorted(comports())}
    hardware = {path: _hardware(port.description, port.serial_number) for path, port in known.items()}
    looks = (_look_at(path, hardware.get(path, ""), ask) for path in (ports or known))
    return list(await asyncio.gather(*looks))


async def _look_at(path: str, hardware: str, ask: bool) -> Device:
    try:
        port = await open_port(path, FIRST_BAUD)
        try:
            answer = await find(port, Wish(), _quietly, ask=False)
            if answer is None:  # a board that boots when its port is opened takes a second or two
                answer = await find(port, Wish(), _quietly, ask)
        finally:
            await port.close()
    except PortLostError as error:
        return Device(path, hardware, str(error))
    if answer is None:
        return Device(path, hardware, "nothing answers" if ask else "nothing is heard")
    baud, found, _ = answer
    words = f"{KINDS[found.device].title} at {baud} baud: {found.evidence}"
    return Device(path, hardware, words, found.device, baud)


def _hardware(description: str | None, serial: str | None) -> str:
    told = "" if description in (None, "n/a") else str(description)
    return f"{told}, {serial}" if told and serial else told


def _quietly(_: str) -> None:
    """Nobody watches."""
