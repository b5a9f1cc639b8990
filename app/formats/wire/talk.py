"""Heart: a conversation with a device as pure state: what to send, what answer to wait for, how long.

A script is a generator. It yields an ``Ask`` and is sent the answer, or None when every try passed in
silence; what it returns is the conversation's result. The clock and the port are the caller's:

    talk = Talk(start_up())
    while (ask := talk.ask) is not None:
        send ask.send; for ask.timeout_s seconds, hand what comes to talk.receive(), until it is True
        if the time passed: talk.expire()
    talk.result, or talk.failed; talk.left_over: bytes behind the last answer, which the decoder gets
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Generic, TypeVar

Result = TypeVar("Result")
#: Finds an answer in the bytes that came: where it begins and ends, or None.
FindAnswer = Callable[[bytes], tuple[int, int] | None]

_KEPT = 16384  # of what came since the question; the longest answer has 2 kB


def no_answer(_: bytes) -> None:
    """For a command that is never answered: its timeout is the pause after it."""


@dataclass(frozen=True)
class Ask:
    """Bytes to send, and the answer that is expected within ``timeout_s``, in up to ``tries`` tries."""

    send: bytes
    what: str  # in words, for whoever waits
    answer: FindAnswer = no_answer
    timeout_s: float = 0.3
    tries: int = 3
    quiet_s: float = 0.0  # above 0: so much silence ends the waiting too


class RefusedError(Exception):
    """What a script raises when it cannot go on: one sentence for the user."""


#: What a protocol writes: yields what to ask, is sent the answers, returns what it learnt.
Script = Generator[Ask, bytes | None, Result]


class Talk(Generic[Result]):
    """A script under way. ``ask`` is what to send now (again, after ``expire``); None: it is over."""

    def __init__(self, script: Script[Result]) -> None:
        self.ask: Ask | None = None
        self.result: Result | None = None
        self.failed = ""  # why there is no result, in a sentence
        self.left_over = b""
        self._script = script
        self._tries = 0
        self._advance(None, first=True)

    def receive(self, data: bytes) -> bool:
        """Take bytes from the device; True when they completed the answer and there is a new ``ask``."""
        self.left_over = (self.left_over + data)[-_KEPT:]
        found = None if self.ask is None else self.ask.answer(self.left_over)
        if found is None:
            return False
        start, end = found
        answer, self.left_over = self.left_over[start:end], self.left_over[end:]
        self._advance(answer)
        return True

    def expire(self) -> None:
        """The ask's time is over: send it again, or go on without an answer."""
        if self.ask is None:
            return
        self._tries += 1
        if self.ask.answer is no_answer or self._tries >= self.ask.tries:
            self._advance(None)

    def _advance(self, answer: bytes | None, first: bool = False) -> None:
        self._tries = 0
        try:
            self.ask = next(self._script) if first else self._script.send(answer)
            self.left_over = b""  # came before the question, so is not its answer
        except StopIteration as stop:
            self.ask, self.result = None, stop.value
        except RefusedError as refusal:
            self.ask, self.failed = None, str(refusal)
