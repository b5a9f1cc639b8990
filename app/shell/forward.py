"""Shell: a source onto the network, for a walk on another machine (the papers' wearable computer)."""

from __future__ import annotations

import asyncio
import secrets
import signal
from collections.abc import Callable
from contextlib import suppress

from app.formats.wire.message import NAME
from app.motion.basics import InputError
from app.motion.commands import RestartHere
from app.motion.samples import Sample
from app.outputs.forwarder import Links, Sender, sender_to
from app.outputs.lsl import LslSender
from app.sources.lsl import library
from app.sources.opening import open_source
from app.sources.phone import PhoneSource
from app.sources.source import Source

#: A source that is faster than the clock (``speed=0``) waits for the network here; temperatures are told.
_BREATH = 200
#: After Ctrl-C the last samples have so long to arrive.
_LAST_S = 0.5


def forward(spec: str, to: str, links: Links, tell: Callable[[str], None]) -> str:
    """Forward until the source ends or Ctrl-C; what became of the samples, in one line."""
    source = open_source(spec, finish=True, changes=False)
    if isinstance(source, PhoneSource):
        raise InputError(f"--source {spec}: a phone comes by the page's port, and needs no forwarder")
    try:
        return asyncio.run(_forward(source, to, links, tell))
    finally:
        source.close()


def _sender(source: Source, to: str, links: Links, tell: Callable[[str], None]) -> Sender:
    if not to.startswith("lsl:"):
        return sender_to(to, secrets.randbits(64), links, tell)
    if not NAME.fullmatch(to[4:]):
        raise InputError(f"--to {to}: expected lsl:NAME of 1 to 16 letters, digits, _ . -")
    return LslSender(library(), to[4:], source.info.rate_hz)


async def _forward(source: Source, to: str, links: Links, tell: Callable[[str], None]) -> str:
    sender = _sender(source, to, links, tell)
    delivering = asyncio.create_task(sender.run(), name="deliver")
    reading = asyncio.create_task(_read(source, sender), name="read")
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, reading.cancel)
    await asyncio.wait((reading, delivering), return_when=asyncio.FIRST_COMPLETED)
    for task in (delivering, reading):
        if task.done() and not task.cancelled() and (error := task.exception()) is not None:
            raise error
    with suppress(TimeoutError):
        await asyncio.wait_for(sender.finish(), _LAST_S)
    for task in (delivering, reading):
        task.cancel()
        with suppress(asyncio.CancelledError, InputError):
            await task
    return sender.summary()


async def _read(source: Source, sender: Sender) -> None:
    taken = 0
    async for item in source:
        if isinstance(item, RestartHere):
            sender.begin_anew(secrets.randbits(64))
        elif isinstance(item, Sample):
            if taken % _BREATH == 0:
                sender.warm(source.info.temperatures)
            sender.send(item)
            taken += 1
            if taken % _BREATH == 0:
                await asyncio.sleep(0)
            while source.replay and sender.full:
                await asyncio.sleep(0.05)
    await sender.finish()
