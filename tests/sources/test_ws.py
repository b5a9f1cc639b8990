"""Real websockets: acks, reconnects and resends, who is let in, and any bytes."""

from __future__ import annotations

import asyncio
import random
from pathlib import Path

import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from app.formats.wire.message import encode_binary, encode_json
from app.formats.wire.reply import Ack, Refused, decode_reply
from app.motion.source import Link
from app.sources.spec import parse_spec
from app.sources.ws import WsSource
from tests.sources.links import Reader, walk


def address(source: WsSource) -> str:
    return f"ws://127.0.0.1:{source.port}"


def test_two_feet_on_one_port_each_acknowledged() -> None:
    async def main() -> None:
        source = WsSource(parse_spec("ws:0"))
        reader = Reader(source)
        async with connect(address(source)) as left, connect(address(source)) as right:
            for i in range(0, 50, 5):
                await left.send(encode_json(1, walk(5, "left", i)))
                await right.send(encode_binary(2, walk(5, "right", i), doubles=True))
                assert decode_reply(await left.recv()) == Ack(1, "left", i + 5)
                assert decode_reply(await right.recv()) == Ack(2, "right", i + 5)
        await reader.until(lambda: len(reader.got) == 100)
        assert reader.of("left") == walk(50)
        assert reader.of("right") == walk(50, "right")
        assert source.link is Link.LIVE
        reader.stop()

    asyncio.run(main())


def test_a_sender_that_reconnects_and_sends_again_is_taken_once() -> None:
    async def main() -> None:
        source = WsSource(parse_spec("ws:0"))
        reader = Reader(source)
        for first in (0, 5, 5, 20):
            async with connect(address(source)) as sender:
                await sender.send(encode_json(1, walk(20, "left", first)))
                await sender.recv()
        await reader.until(lambda: len(reader.got) == 40)
        assert reader.of("left") == walk(40)
        assert source.info.line == {"came twice": 40}
        reader.stop()

    asyncio.run(main())


def test_any_bytes_are_answered_with_a_reason_and_harm_nobody() -> None:
    async def main() -> None:
        source = WsSource(parse_spec("ws:0"))
        reader = Reader(source)
        dice = random.Random(1)
        whole = encode_binary(7, walk(4))
        async with connect(address(source)) as sender:
            for _ in range(100):
                damaged = bytearray(whole)
                damaged[dice.randrange(6)] ^= 1 << dice.randrange(8)  # in magic, version or flags
                sent: list[bytes | str] = [bytes(damaged), dice.randbytes(60), "x" * dice.randrange(60)]
                await sender.send(dice.choice(sent))
                reply = decode_reply(await sender.recv())
                assert isinstance(reply, Refused | Ack)
            await sender.send(encode_binary(8, walk(4, "right")))
            assert decode_reply(await sender.recv()) == Ack(8, "right", 4)
            await sender.send(b"x" * 100_000)
            with pytest.raises(ConnectionClosed):
                await sender.recv()
        await reader.until(lambda: len(reader.of("right")) == 4)
        reader.stop()

    asyncio.run(main())


def test_a_fault_of_the_program_is_seen(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def falter(*_: object) -> None:
        raise KeyError("a fault")

    async def main() -> None:
        source = WsSource(parse_spec("ws:0"))
        monkeypatch.setattr(source._intake, "take", falter)
        async with connect(address(source)) as sender:
            await sender.send(encode_json(1, walk(5)))
            with pytest.raises(ConnectionClosed):
                await sender.recv()
        source.close()

    asyncio.run(main())
    assert "could not be taken" in caplog.text


def test_a_browsers_page_is_not_let_in() -> None:
    async def main() -> None:
        source = WsSource(parse_spec("ws:0"))
        with pytest.raises(InvalidStatus, match="403"):
            async with connect(address(source), origin="http://evil.example"):  # type: ignore[arg-type]
                pass
        source.close()

    asyncio.run(main())


def test_without_the_token_nobody_is_let_in(tmp_path: Path) -> None:
    (tmp_path / "token").write_text("a secret")

    async def main() -> None:
        source = WsSource(parse_spec(f"ws:0?token-file={tmp_path / 'token'}"))
        for wrong in ("", "?token=", "?token=another", "?token=a%20secret%00"):
            with pytest.raises(InvalidStatus, match="401"):
                async with connect(address(source) + "/" + wrong):
                    pass
        async with connect(
            address(source), additional_headers={"Authorization": "Bearer a secret"}
        ) as sender:
            await sender.send(encode_json(1, walk(1)))
            assert isinstance(decode_reply(await sender.recv()), Ack)
        async with connect(address(source) + "/?token=a%20secret"):
            pass
        assert source.info.line == {"refused senders": 4}
        source.close()

    asyncio.run(main())


def test_a_closed_source_frees_its_port() -> None:
    source = WsSource(parse_spec("ws:0"))
    source.close()
    source.close()
    WsSource(parse_spec(f"ws:{source.port}")).close()
