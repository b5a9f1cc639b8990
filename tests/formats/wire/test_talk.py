from __future__ import annotations

import pytest

from app.formats.wire.talk import Ask, RefusedError, Script, Talk


def find_ok(data: bytes) -> tuple[int, int] | None:
    at = data.find(b"ok")
    return (at, at + 2) if at >= 0 else None


def script() -> Script[int]:
    yield Ask(b"quiet", "pausing")
    answers = 0
    for _ in range(2):
        if (yield Ask(b"say ok", "asking", find_ok, tries=2)) == b"ok":
            answers += 1
    if not answers:
        raise RefusedError("nobody answers: plug it in")
    return answers


def test_answers_are_found_in_pieces_and_the_rest_is_left_over() -> None:
    talk = Talk(script())
    assert talk.ask is not None
    assert talk.ask.send == b"quiet"
    assert not talk.receive(b"ok")  # nothing was asked
    talk.expire()
    assert not talk.receive(b"..o")
    assert talk.receive(b"k..")
    assert not talk.receive(b"..")
    assert talk.receive(b"okstream")
    assert (talk.result, talk.left_over) == (2, b"stream")


def test_an_answer_from_before_the_question_is_none() -> None:
    talk = Talk(script())
    talk.receive(b"ok")
    talk.expire()
    assert not talk.receive(b"..")


def test_silence_is_asked_again_then_passed_over() -> None:
    talk = Talk(script())
    talk.expire()
    asked: list[bytes] = []
    while talk.ask is not None and len(asked) < 9:
        asked.append(talk.ask.send)
        talk.expire()
    assert len(asked) == 4
    assert (talk.result, talk.failed) == (None, "nobody answers: plug it in")
    talk.expire()  # over is over
    assert not talk.receive(b"ok")


@pytest.mark.parametrize("size", [1, 1000])
def test_a_stream_beside_the_answer_is_not_kept_for_ever(size: int) -> None:
    talk = Talk(script())
    talk.expire()
    talk.receive(b"." * 16_300)
    for _ in range(200):
        talk.receive(b"." * size)
        assert len(talk.left_over) <= 16384
    assert talk.receive(b"ok")
