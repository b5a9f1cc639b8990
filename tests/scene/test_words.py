from __future__ import annotations

import math
from html.parser import HTMLParser

from hypothesis import given
from hypothesis import strategies as st

from app.scene import words


class Tags(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)

    def handle_data(self, data: str) -> None:
        self.text += data


def read(html: str) -> Tags:
    parser = Tags()
    parser.feed(html)
    parser.close()
    return parser


@given(st.text(max_size=100))
def test_nobodys_text_becomes_markup(text: str) -> None:
    for html in (f"<b>{words.plain(text)}</b>", f'<b title="{words.plain(text)}">x</b>'):
        assert read(html).tags == ["b"]


def test_text_reads_as_typed() -> None:
    assert (
        read(words.plain("<img src=x onerror=alert(1)> & **bold**")).text
        == "<img src=x onerror=alert(1)> & **bold**"
    )


def test_long_text_is_cut_and_controls_go() -> None:
    assert len(words.plain("x" * 999)) == words.LONGEST
    assert words.plain("a\x00b\nc\u202ed") == "a b c d"


def test_numbers() -> None:
    assert words.number(1234.567) == "1\u2009234.57"
    assert words.number(-0.5, 1) == "−0.5"
    assert words.number(-0.001) == "0.00"
    assert words.number(None) == words.number(math.nan) == words.number(math.inf) == "–"


def test_signs() -> None:
    assert [words.signed(v) for v in (0.126, -0.126, 0.001, math.nan)] == ["+0.13", "−0.13", "0.00", "–"]


def test_units_grow_with_the_distance() -> None:
    assert words.metres(0.123) == ("0.12", "m")
    assert words.metres(437.54) == ("437.5", "m")
    assert words.metres(1204.0) == ("1.204", "km")
    assert words.metres(math.nan) == ("–", "m")


def test_clock() -> None:
    assert [words.clock(t) for t in (0.04, 59.94, 95.0, 3723.0, math.inf)] == [
        "0.0 s",
        "59.9 s",
        "1:35",
        "1:02:03",
        "–",
    ]


def test_percent_of_nothing() -> None:
    assert words.percent(1.0, 0.0) == "–"
    assert words.percent(0.84, 60.0) == "1.4 %"


def test_counts_are_harmless() -> None:
    assert words.counts({}) == "0"
    assert words.counts({"time <b>backward</b>": 2, "nothing": 0}) == "2 (2 time &lt;b&gt;backward&lt;/b&gt;)"
