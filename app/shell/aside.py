"""Shell: long work in a thread of its own that ends with the program: Ctrl-C waits for none of it."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Callable
from functools import partial
from typing import TypeVar

_T = TypeVar("_T")


async def aside(work: Callable[[], _T], name: str) -> _T:
    """What ``work`` returns or raises; ``name`` is its thread's."""
    loop = asyncio.get_running_loop()
    done: asyncio.Future[_T] = loop.create_future()

    def answer(tell: Callable[[], None]) -> None:
        if not done.done():  # nobody waits any more
            tell()

    def run() -> None:
        try:
            tell = partial(done.set_result, work())
        except Exception as error:
            tell = partial(done.set_exception, error)
        with contextlib.suppress(RuntimeError):  # the program has ended meanwhile
            loop.call_soon_threadsafe(answer, tell)

    threading.Thread(target=run, name=name, daemon=True).start()
    return await done
