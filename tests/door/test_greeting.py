"""What is printed once: addresses, and their QR codes where a phone could reach them."""

from __future__ import annotations

import pytest
import segno

from app.door.greeting import greeting, qr_lines

OPERATE, WATCH = "http://10.0.0.7:8080/?token=abc", "http://10.0.0.7:8080/?token=xyz"


def pixels(lines: list[str]) -> list[list[bool]]:
    """The dark modules that a picture in half blocks shows, without its border."""
    light = {"█": (1, 1), "▀": (1, 0), "▄": (0, 1), " ": (0, 0)}
    rows = [[not light[cell][half] for cell in line] for line in lines for half in (0, 1)]
    size = len(rows[0])
    return [row[2 : size - 2] for row in rows[2 : size - 2]]


@pytest.mark.parametrize("address", [OPERATE, "https://192.168.100.200:65535/?token=" + "t" * 60])
def test_the_picture_is_the_code_module_by_module(address: str) -> None:
    expected = [
        [bool(module) for module in row] for row in segno.make(address, error="l", micro=False).matrix
    ]
    assert pixels(qr_lines(address)) == expected


def test_two_codes_stand_side_by_side_in_eighty_columns() -> None:
    token = "t" * 22
    lines = greeting(
        f"https://192.168.100.200:8080/?token={token}", f"https://192.168.100.200:8080/?token={token}",
        reachable=True,
    )  # fmt: skip
    assert lines[0].startswith("Stridescope is at https://192.168.100.200:8080/?token=")
    assert max(map(len, lines[2:])) <= 80
    assert sum("█" in line for line in lines) > 15


def test_on_this_machine_alone_an_address_is_enough() -> None:
    assert len(greeting("http://127.0.0.1:8080", None, reachable=False)) == 1
    assert len(greeting(OPERATE, WATCH, reachable=False)) == 2
