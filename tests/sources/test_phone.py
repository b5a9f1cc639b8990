"""What the door hands over becomes samples: messages, Sensor Logger's pushes, and anything else a reason."""

from __future__ import annotations

import json
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.message import encode_binary, encode_json
from app.formats.wire.reply import Ack, Refused, decode_reply
from app.motion.basics import InputError
from app.motion.samples import Sample
from app.motion.source import Link
from app.sources.opening import open_source
from app.sources.phone import PhoneSource
from app.sources.spec import parse_spec
from tests.formats.wire.test_sensorlogger import pushes
from tests.sources.links import walk


def phone(options: str = "") -> PhoneSource:
    return PhoneSource(parse_spec(f"phone:{options}"))


def waiting(source: PhoneSource) -> list[Sample]:
    return [s._replace(host_ns=0) for s in source._waiting]


def test_messages_of_two_feet_in_both_forms() -> None:
    source = phone()
    assert decode_reply(source.take(encode_json(1, walk(5)))) == Ack(1, "left", 5)
    assert decode_reply(source.take(encode_binary(2, walk(5, "right"), doubles=True))) == Ack(2, "right", 5)
    assert waiting(source) == walk(5) + walk(5, "right")
    assert source.link is Link.LIVE


def test_a_push_may_be_a_message_or_sensor_loggers() -> None:
    source = phone("?foot=left")
    status, text = source.push(encode_json(1, walk(5)).encode(), {})
    assert (status, decode_reply(text)) == (200, Ack(1, "left", 5))
    for body in pushes(10):
        assert source.push(json.dumps(body).encode(), {"foot": "right"}) == (200, "ok")
    assert len([s for s in waiting(source) if s.sensor == "right"]) >= 90


def test_a_wrong_push_is_answered_as_the_app_shows_it() -> None:
    source = phone()
    status, text = source.push(b"rubbish", {})
    assert status == 499
    assert "JSON" in text
    status, text = source.push(json.dumps(pushes(1)[0]).encode(), {"axes": "up"})
    assert status == 499
    assert "axes=" in text
    status, text = source.push(json.dumps(pushes(1)[0]).encode(), {"foot": "lefft"})
    assert status == 499
    assert "foot='lefft'" in text


def test_a_push_address_that_was_put_right_holds_from_then_on() -> None:
    source = phone()
    for number, body in enumerate(pushes(20)):
        query = {"axes": "x,-y,-z"} if number < 10 else {"axes": "y,x,-z", "foot": "right"}
        assert source.push(json.dumps(body).encode(), query) == (200, "ok")
    told = phone()
    for body in pushes(20):
        told.push(json.dumps(body).encode(), {"axes": "y,x,-z", "foot": "right"})
    after = [sample._replace(host_ns=0, seq=0) for sample in source._waiting if sample.sensor == "right"]
    assert len(after) >= 50
    assert after == [sample._replace(seq=0) for sample in waiting(told)][-len(after) :]


def test_ever_more_phones_are_not_remembered() -> None:
    source = phone()
    answers = [
        source.push(json.dumps(pushes(1)[0] | {"deviceId": f"d{i}"}).encode(), {})[0] for i in range(20)
    ]
    assert answers == [200] * 8 + [499] * 12


@given(st.binary(max_size=200) | st.text(max_size=100))
def test_anything_is_answered(data: bytes | str) -> None:
    assert isinstance(decode_reply(phone().take(data)), Refused)


def test_only_the_walks_page_has_a_door_for_it() -> None:
    source = open_source("phone:")
    assert "scan" in source.detail
    assert isinstance(source, PhoneSource)
    source.take(encode_json(1, walk(5)))
    assert (source.link, source.detail) == (Link.LIVE, "")
    while source.link is not Link.LOST:
        time.sleep(0.1)
    assert "unlock it" in source.detail
    with pytest.raises(InputError, match="expected"):
        open_source("phone:9000")
    with pytest.raises(InputError, match="expected one of"):
        open_source("phone:?speed=2")


def test_a_walk_that_was_left_takes_nothing_more_and_says_so() -> None:
    """The page may show a recording by now, while a phone goes on sending."""
    source = phone()
    source.take(encode_json(1, walk(5)))
    source.close()
    answer = decode_reply(source.take(encode_json(1, walk(10))))
    assert isinstance(answer, Refused)
    assert "over" in answer.why
    assert source.push(json.dumps(pushes(1)[0]).encode(), {})[0] == 499
    assert [sample.seq for sample in source.unread()] == list(range(5))
