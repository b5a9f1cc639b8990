"""The light on the page: a word and a shape with every colour, and never good when nothing comes."""

from __future__ import annotations

from app.motion.health import Health, Light, Recent
from app.scene.soundness import lights, tables
from tests.scene.fakes import snapshot, status

RECENT = Recent(100.0, 990, 10, 0, 0, 3, 1.2, 8.0, 0.21, 9.79, 0.03, -12.3, 0.0)


def health(light: Light, reason: str) -> dict[str, Health]:
    return {"foot": Health(100.0, 990, {}, 3, 1, RECENT, light, reason)}


def test_each_light_has_its_word_and_shape() -> None:
    shown = [lights(snapshot(5.0, health=health(light, "why <b>")), status()) for light in Light]
    for text, word, shape in zip(shown, ("GOOD", "CHECK", "BAD"), "●▲■", strict=True):
        assert word in text
        assert shape in text
        assert "why &lt;b&gt;" in text


def test_a_good_stream_says_its_rate() -> None:
    assert "100 Hz, 10 lost in 10 s" in lights(snapshot(5.0, health=health(Light.GREEN, "")), status())


def test_what_is_stale_is_not_good() -> None:
    text = lights(snapshot(5.0, health=health(Light.GREEN, "")), status(stale_s=3.0))
    assert "BAD" in text
    assert "no samples for 3.0 s" in text


def test_figures_have_units() -> None:
    text = tables(snapshot(5.0, health=health(Light.GREEN, "")))
    for told in ("1.0 %", "1.2 ms, 8 ms", "9.79 ± 0.21 m/s²", "3 %", "−12.3 ppm"):
        assert told in text
