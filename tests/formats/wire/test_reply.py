"""What a receiver answers, and any bytes in its place."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from app.formats.wire.reply import Ack, Refused, decode_reply, encode_ack, encode_refusal


@given(st.integers(0, 2**64 - 1), st.integers(0, 2**53))
def test_an_ack_comes_back(session: int, following: int) -> None:
    ack = Ack(session, "left", following)
    assert decode_reply(encode_ack(ack)) == ack


@given(st.text(max_size=300))
def test_a_refusal_comes_back_cut_short(why: str) -> None:
    assert decode_reply(encode_refusal(why)) == Refused(why[:200])


@given(
    st.binary(max_size=60)
    | st.text(max_size=60)
    | st.sampled_from(
        ["[]", "1", "null", '{"ack":1}', '{"ack":{"session":5,"sensor":[],"next":{}}}', "[" * 9999]
    )
)
def test_anything_else_is_no_answer(data: bytes | str) -> None:
    assert isinstance(decode_reply(data), Refused)
