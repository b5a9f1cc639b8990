"""The picture of an address, and words in its place."""

from __future__ import annotations

import xml.etree.ElementTree as ET

from app.door.codes import picture, words


def test_a_picture_is_svg_and_differs_by_address() -> None:
    one, other = (
        picture("https://192.0.2.7:8080/phone?token=a"),
        picture("https://192.0.2.7:8080/phone?token=b"),
    )
    assert ET.fromstring(one).tag == "{http://www.w3.org/2000/svg}svg"
    assert one != other
    assert "token" not in one


def test_words_are_never_markup() -> None:
    svg = ET.fromstring(words("<script>", "a & b"))
    assert [text.text for text in svg] == ["<script>", "a & b"]
