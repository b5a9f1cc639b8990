"""Profiles: they come back as saved, and no file makes a traceback."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from app.home import profiles
from app.motion.basics import InputError
from app.settings import BUILT_IN, LIMITS, Settings

PAPERS = BUILT_IN["papers"]
BUILT_IN_NAMES = ("papers", "default", "hindsight")
BAD_NAMES = [
    "../x",
    "a/b",
    ".hidden",
    "",
    " x",
    "x" * 41,
    "x\n",
    "a\\b",
    "x.toml",
    "..",
    "/etc/passwd",
    "a\0b",
]


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A configuration folder of its own."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setenv("HOME", str(tmp_path))
    return tmp_path


def numbers(name: str) -> st.SearchStrategy[float]:
    return st.floats(LIMITS[name].low, LIMITS[name].high)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(numbers("gain_stance"), numbers("threshold_radps"), numbers("start_heading_rad"), st.booleans())
def test_a_profile_comes_back_as_saved(gain: float, threshold: float, heading: float, compass: bool) -> None:
    chosen = Settings(
        gain_stance=gain, threshold_radps=threshold, start_heading_rad=heading, magnetometer=compass
    )
    path = profiles.save("my walk", chosen)
    assert profiles.load("my walk") == profiles.load_named("my walk") == profiles.load(str(path)) == chosen


def test_names_are_the_built_in_and_the_saved_ones() -> None:
    assert profiles.names() == BUILT_IN_NAMES
    profiles.save("zoo", PAPERS)
    profiles.save("Ärmel 2", PAPERS)
    (profiles.folder() / ".secret.toml").write_text("")
    assert profiles.names() == (*BUILT_IN_NAMES, "zoo", "Ärmel 2")


def test_what_a_profile_leaves_out_is_as_in_papers(tmp_path: Path) -> None:
    file = tmp_path / "p.toml"
    file.write_text("gain_stance = 2\n")
    assert profiles.load(str(file)) == Settings(gain_stance=2.0)


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (b"gain = 1", "gain"),
        (b"gain_stance = 51", "50"),
        (b"gain_stance = nan", "gain_stance"),
        (b"gain_stance = inf", "gain_stance"),
        (b"gain_stance = true", "gain_stance"),
        (b"gain_stance = '1'", "gain_stance"),
        (b"gain_stance = 1" + b"0" * 400, "gain_stance"),
        (b"gain_stance = 1" + b"0" * 5000, "not TOML"),
        (b"magnetometer = 1", "magnetometer"),
        (b"estimator = 'other'", "papers"),
        (b"estimator = ['papers']", "papers"),
        (b"[gain_stance]\na = 1", "gain_stance"),
        (b"hello world", "not TOML"),
        (b"a = " + b"[" * 60_000, "not TOML"),
        (b"\xff\xfe\x00", "cannot be read"),
        (b"#" * 100_000, "100000"),
        (b"gain_stance = 1979-05-27", "gain_stance"),
    ],
)
def test_a_bad_profile_is_one_line_that_names_it(tmp_path: Path, content: bytes, named: str) -> None:
    file = tmp_path / "bad.toml"
    file.write_bytes(content)
    with pytest.raises(InputError, match=named) as caught:
        profiles.load(str(file))
    assert "bad.toml" in str(caught.value)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=150)
@given(
    st.one_of(st.binary(max_size=200), st.text("abc=[]{}.\"'#\n 0123eE+-_:T", max_size=60).map(str.encode))
)
@example(b"gain_stance = 1e999")
@example(b"gain_stance = 0x1")
@example(b"")
def test_any_bytes_are_settings_or_one_error(home: Path, content: bytes) -> None:
    file = home / "fuzz.toml"
    file.write_bytes(content)
    try:
        assert isinstance(profiles.read(file), Settings)
    except InputError as error:
        assert "fuzz.toml" in str(error)


@pytest.mark.parametrize("name", BAD_NAMES)
def test_no_name_leaves_the_folder(home: Path, name: str) -> None:
    (home / "x.toml").write_text("gain_stance = 3")
    with pytest.raises(InputError, match="profile name"):
        profiles.save(name, PAPERS)
    with pytest.raises(InputError, match="profile name"):
        profiles.load_named(name)
    assert not profiles.folder().exists()


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.text(max_size=45)
    | st.lists(st.sampled_from(["..", ".", "/", "\\", "a", "ä", " ", "-", "\0", "\n", "~"])).map("".join)
)
def test_whatever_the_name_only_its_own_file_is_written(home: Path, name: str) -> None:
    before = {path for path in home.rglob("*") if path.is_file()}
    try:
        profiles.save(name, PAPERS)
    except InputError as error:
        assert "\n" not in str(error)
    made = {path for path in home.rglob("*") if path.is_file()} - before
    assert made <= {profiles.folder() / f"{name}.toml"}
    for path in made:
        assert path.resolve().parent == profiles.folder().resolve()
        assert profiles.load_named(name) == PAPERS
        path.unlink()


def test_a_built_in_profile_is_not_overwritten() -> None:
    with pytest.raises(InputError, match="built in"):
        profiles.save("papers", Settings(gain_stance=2.0))
    profiles.folder().mkdir(parents=True)
    (profiles.folder() / "papers.toml").write_text("gain_stance = 2")
    assert profiles.load("papers") == PAPERS
    assert profiles.names() == BUILT_IN_NAMES


def test_an_unknown_name_says_what_there_is() -> None:
    profiles.save("zoo", PAPERS)
    with pytest.raises(InputError, match="hindsight, zoo"):
        profiles.load("nothing")


def test_a_missing_file_a_folder_and_a_device_are_one_error_each(tmp_path: Path) -> None:
    for name in (str(tmp_path / "no.toml"), str(tmp_path), "/dev/null", "/dev/zero"):
        with pytest.raises(InputError, match="profile"):
            profiles.load(name)


def test_a_folder_that_cannot_be_made_is_one_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "file" / "config"))
    assert profiles.names() == BUILT_IN_NAMES
    with pytest.raises(InputError, match="cannot be saved"):
        profiles.save("zoo", PAPERS)
    with pytest.raises(InputError, match="not found"):
        profiles.load("zoo")
