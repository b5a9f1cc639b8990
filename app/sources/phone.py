"""Edge: ``phone:``: samples that come in by the page's own port: the door hands them over from its thread."""

from __future__ import annotations

import time
from collections.abc import Mapping

from app.formats.wire.intake import Intake
from app.formats.wire.message import Malformed
from app.formats.wire.reply import Ack, encode_ack, encode_refusal
from app.formats.wire.sensorlogger import MOST_PHONES, Phone, parse, sensor_and_axes
from app.motion.basics import InputError
from app.motion.source import Link
from app.sources.inbox import Inbox
from app.sources.listening import options_of
from app.sources.spec import Spec

OK, BAD, TOO_MANY = 200, 499, 499  # the app shows its user the text of a 499
OVER = "this walk is over: begin it anew with --source phone:"


class PhoneSource(Inbox):
    """Filled by ``take`` and ``push``, which only one thread may call: the door's."""

    def __init__(self, spec: Spec) -> None:
        if spec.target:
            raise InputError(
                f"phone:{spec.target}: expected phone: alone, or with options as phone:?foot=left"
            )
        self._options, _ = options_of(spec)
        self._intake = Intake(self._options)
        self._logged = Intake()
        self._phones: dict[str, Phone] = {}
        super().__init__(
            "phone",
            "a phone's page, Sensor Logger or messages",
            self._told,
            self._lost,
            lambda: {"messages": self._intake.counters},
            lambda: self._intake.temperatures,
        )

    def take(self, data: bytes | str) -> str:
        """A message of ours; what to answer."""
        if self._left:
            return encode_refusal(OVER)
        samples, answer = self._intake.take(data, time.monotonic_ns())
        self.put(samples)
        return _answer(answer)

    def push(self, data: bytes, query: Mapping[str, str]) -> tuple[int, str]:
        """A body that was pushed, by Sensor Logger or a message of ours: status and text of the answer."""
        if self._left:
            return BAD, OVER
        pushed = parse(data)
        if isinstance(pushed, Malformed):
            answer = self.take(data)
            return (OK, answer) if '"ack"' in answer else (BAD, f"{pushed.why}; {answer}")
        try:
            worn = sensor_and_axes(query, self._options.foot, self._options.axes)
        except InputError as error:
            return BAD, str(error)
        phone = self._phones.get(pushed.device)
        if phone is None:
            if len(self._phones) >= MOST_PHONES:
                return TOO_MANY, f"{MOST_PHONES} phones are known already"
            phone = self._phones[pushed.device] = Phone(*worn)
        phone.wear(*worn)
        host_ns = time.monotonic_ns()
        message = phone.push(pushed, host_ns)
        if message is None:
            return OK, "ok"
        samples, taken = self._logged.take_message(message, host_ns)
        self.put(samples)
        return (BAD, taken.why) if isinstance(taken, Malformed) else (OK, "ok")

    @property
    def detail(self) -> str:
        """How a phone gets here."""
        if self.link is Link.LOST:
            return "the phone sends no more: unlock it, its page goes on; or scan the code below anew"
        return "" if self.silent_s is not None else "no phone yet: scan the code below with it"

    def _told(self) -> list[str]:
        notes = [note for phone in list(self._phones.values()) for note in phone.notes]
        return [*self._intake.notes, *notes]

    def _lost(self) -> dict[str, int]:
        counters, phones = self._intake.counters, list(self._phones.values())
        return {
            "lost on the way": counters.lost,
            "came twice": counters.repeated,
            "unusable readings": counters.dropped + sum(phone.dropped for phone in phones),
            "missing messages of Sensor Logger": sum(phone.missing for phone in phones),
            "refused messages": counters.bad_checksum + counters.unknown,
        }


def _answer(answer: Ack | Malformed) -> str:
    return encode_refusal(answer.why) if isinstance(answer, Malformed) else encode_ack(answer)
