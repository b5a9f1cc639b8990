"""The program itself, as a user calls it: JSON, exit codes, one line for every mistake."""

from __future__ import annotations

import json
import math
import os
import random
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from app.__main__ import main

ROOT = Path(__file__).parent.parent
PLAIN = "t_s,foot,fx_mps2,fy_mps2,fz_mps2,wx_radps,wy_radps,wz_radps,mx_gauss,my_gauss,mz_gauss"
Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """Call the program in this process: exit code, standard output, standard error."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))

    def call(*arguments: object) -> tuple[int, str, str]:
        capfd.readouterr()
        try:
            code = main([str(a) for a in arguments])
        except SystemExit as ended:
            code = int(ended.code or 0)
        out, err = capfd.readouterr()
        return code, out, err

    return call


def row(t: object, f: tuple[object, ...] = (0, 0, -9.8), w: tuple[object, ...] = (0, 0, 0)) -> str:
    return ",".join(map(str, (t, "foot", *f, *w, "", "", "")))


def still_rows(seconds: float = 5.0, force: tuple[float, float, float] = (0.0, 0.0, -9.8)) -> list[str]:
    return [row(f"{i / 100:.2f}", force) for i in range(round(seconds * 100))]


def csv_of(rows: list[str]) -> str:
    return "\n".join([PLAIN, *rows]) + "\n"


def assert_one_error(result: tuple[int, str, str], *named: str) -> None:
    code, out, err = result
    assert code == 2, (out, err)
    assert out == ""
    assert err.count("\n") == 1, err
    assert err.endswith("\n")
    assert "Traceback" not in err
    for word in named:
        assert word in err


# --- what is wrong with the input -------------------------------------------------------------------

BAD_FILES = {
    "empty": (b"", "empty"),
    "text": (b"Dear diary,\ntoday I walked.\n", "expected"),
    "binary": (bytes(range(256)) * 40, "expected"),
    "no units": (b"t,ax,ay,az,gx,gy,gz\n" + b"0,0,0,-1,0,0,0\n" * 300, "unit"),
    "all nan": (csv_of([row(i / 100, ("nan", 0, -9.8)) for i in range(300)]).encode(), "finite"),
    "in g": (csv_of(still_rows(5, (0, 0, -1.0))).encode(), "g"),
    "rest at 0.1 g": (csv_of(still_rows(5, (0, 0, -0.98))).encode(), "rests at"),
    "damaged matlab": (b"MATLAB 5.0 MAT-file" + b"\0" * 500, "MATLAB"),
    "header only": ((PLAIN + "\n").encode(), ""),
}


@pytest.mark.parametrize("name", BAD_FILES)
@pytest.mark.parametrize("json_too", [True, False])
def test_a_bad_file_is_one_line_and_exit_2(run: Run, tmp_path: Path, name: str, json_too: bool) -> None:
    content, named = BAD_FILES[name]
    file = tmp_path / "walk.csv"
    file.write_bytes(content)
    assert_one_error(run("process", file, *(["--json"] if json_too else [])), "walk.csv", named)


def test_a_missing_file_a_folder_and_a_later_source(run: Run, tmp_path: Path) -> None:
    assert_one_error(run("process", tmp_path / "no.csv"), "no.csv", "no such file")
    assert_one_error(run("process", tmp_path), "folder")
    assert_one_error(run("process", "serial:/dev/ttyUSB0"), "serial")
    assert_one_error(run("process", "sim:walk?path=moon"), "moon", "expected")
    assert_one_error(run("process", "sim:run"), "sim:run")
    assert_one_error(run("process", "x.csv?rate=fast"), "rate")


@pytest.mark.parametrize(
    ("setting", "named"),
    [
        ("gain_stance=99", "50"),
        ("gain_stance=nan", "number"),
        ("gain_stance=", "number"),
        ("gain_stance", "KEY=VALUE"),
        ("gain=1", "gain"),
        ("magnetometer=maybe", "on or off"),
        ("estimator=other", "papers"),
        ("gain_stance=1e999", "number"),
        ("=", "unknown"),
        ("two\nlines=1", "unknown"),
    ],
)
def test_a_bad_setting(run: Run, setting: str, named: str) -> None:
    for command in (("process", "sim:walk?strides=1"), ("walk", "--no-open", "--source", "sim:walk")):
        assert_one_error(run(*command, "--set", setting), "--set", named)


@pytest.mark.parametrize(
    ("content", "named"), [("gain = 1", "gain"), ("gain_stance = 51", "50"), ("?", "TOML")]
)
def test_a_bad_profile(run: Run, tmp_path: Path, content: str, named: str) -> None:
    file = tmp_path / "p.toml"
    file.write_text(content)
    for command in (("process", "sim:walk?strides=1"), ("walk", "--no-open")):
        assert_one_error(run(*command, "--profile", file), "p.toml", named)
    assert_one_error(run("process", "sim:walk", "--profile", "nobody"), "nobody", "papers")


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["walk", "--port", "eighty"], "eighty"),
        (["walk", "--memory-mb", "1"], "16"),
        (["walk", "--declination", "nan"], "--declination"),
        (["process", "a", "--profile", ""], "profile"),
        (["walk", "--no-open", "--source", "nowhere.csv"], "nowhere.csv"),
        (["walk", "--no-open", "--token-file", "/nonexistent"], "/nonexistent"),
        (["walk", "--no-open", "--token-file", "/dev/null"], "empty"),
        (["fly"], "fly"),
        (["--fly"], "--fly"),
        (["process"], "RECORDING"),
        (["process", "a", "b\nc"], "b c"),
    ],
)
def test_a_bad_argument(run: Run, arguments: list[str], named: str) -> None:
    assert_one_error(run(*arguments), named)


def test_an_out_folder_that_cannot_be_made(run: Run, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert_one_error(run("process", "sim:walk?strides=1", "--json", "--out", tmp_path / "file"), "--out")


# --- bad rows in a good file: counted, and the rest of the walk kept ---------------------------------


def processed(run: Run, tmp_path: Path, rows: list[str]) -> dict[str, object]:
    file = tmp_path / "walk.csv"
    file.write_text(csv_of(rows))
    code, out, err = run("process", file, "--json")
    assert (code, err) == (0, "")
    told = json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is no JSON"))
    assert isinstance(told, dict)
    return told


def foot_of(told: dict[str, object]) -> dict[str, object]:
    feet = told["feet"]
    assert isinstance(feet, dict)
    foot = feet["foot"]
    assert isinstance(foot, dict)
    return foot


def test_rows_that_do_not_count_are_dropped_and_counted(run: Run, tmp_path: Path) -> None:
    rows = still_rows()
    rows[100] = row("1.00", ("nan", 0, 0))
    rows[200] = row("2.00", (0, "inf", 0))
    rows[300] = row("1.50")
    rows[350] = rows[349]
    told = processed(run, tmp_path, rows)
    assert (told["samples"], told["dropped_rows"]) == (496, 4)
    assert told["dropped"] == {"not a finite number": 2, "time went backward": 1, "repeated time": 1}
    assert foot_of(told)["closure_m"] == 0.0


def test_a_truncated_last_row_costs_one_row(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "walk.csv"
    file.write_text(csv_of(still_rows())[:-30])
    code, out, err = run("process", file, "--json")
    assert (code, err) == (0, "")
    assert json.loads(out)["samples"] == 499


def test_two_samples_are_a_short_recording(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "walk.csv"
    for count in (1, 2):
        file.write_text(csv_of(still_rows()[:count]))
        code, out, err = run("process", file, "--json")
        assert (code == 0 and foot_of(json.loads(out))["strides"] == 0) or (
            code == 2 and err.count("\n") == 1
        )


def test_ten_missing_seconds_are_a_second_segment(run: Run, tmp_path: Path) -> None:
    rows = [r for i, r in enumerate(still_rows(20.0)) if not 500 <= i < 1500]
    told = processed(run, tmp_path, rows)
    assert foot_of(told)["segments"] == 2
    assert told["duration_s"] == pytest.approx(19.99)


def test_saturation_is_no_error(run: Run) -> None:
    code, out, _ = run("process", "sim:walk?strides=5&gyro_range_dps=200&accelerometer_range_g=2", "--json")
    assert code == 0
    assert foot_of(json.loads(out))["strides"] == 5


def test_random_rubbish_is_never_a_traceback(run: Run, tmp_path: Path) -> None:
    random.seed(7)
    good = csv_of(still_rows(2.0)).encode()
    file = tmp_path / "walk.csv"
    for _ in range(60):
        data = bytearray(good)
        for _ in range(random.choice([1, 5, 50, 500])):
            data[random.randrange(len(data))] = random.choice(b'0123456789.,-eE\n\t "#nainf\x00\xff')
        file.write_bytes(bytes(data[: random.randrange(len(data))]))
        code, out, err = run("process", file, "--json")
        assert "Traceback" not in err
        if code == 0:
            assert math.isfinite(foot_of(json.loads(out))["closure_m"])  # type: ignore[arg-type]
        else:
            assert_one_error((code, out, err))


# --- what is right ----------------------------------------------------------------------------------


def test_json_is_the_only_thing_on_standard_output(run: Run, tmp_path: Path) -> None:
    code, out, err = run("process", "sim:walk?feet=2&path=square", "--json", "--out", tmp_path / "o")
    assert (code, err, out.count("\n")) == (0, "", 1)
    told = json.loads(out)
    assert set(told["feet"]) == {"left", "right"}
    assert sorted(p.name for p in (tmp_path / "o").iterdir()) == [
        "strides.csv", "trajectory.csv", "trajectory_left.tum", "trajectory_right.tum",
    ]  # fmt: skip


def test_a_set_goes_on_top_of_a_profile(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "p.toml"
    file.write_text("gain_stance = 2\ngain_swing = 0.5\n")
    _, out, _ = run("process", "sim:walk?strides=1", "--json", "--profile", file, "--set", "gain_stance=3")
    told = json.loads(out)["settings"]
    assert (told["gain_stance"], told["gain_swing"], told["threshold_radps"]) == (3.0, 0.5, 1.0)


def test_without_json_a_person_reads_lines(run: Run) -> None:
    code, out, err = run("process", ROOT / "recordings" / "demo.csv")
    assert (code, err) == (0, "")
    assert "strides" in out
    assert "Hz" in out


def test_help_and_version(run: Run) -> None:
    for arguments in (["--help"], ["process", "--help"], ["--version"]):
        code, out, err = run(*arguments)
        assert (code, err) == (0, "")
        assert out


def program(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "app", *arguments],
        cwd=ROOT, env={**os.environ, **environment}, capture_output=True, text=True, timeout=390, check=False,
    )  # fmt: skip


@pytest.mark.timeout(400)  # compiles the smaller estimator: nothing is kept
def test_a_home_that_cannot_be_written_and_odd_words_in_the_environment(tmp_path: Path) -> None:
    """A home below a plain file: no configuration, no cache."""
    (tmp_path / "file").write_text("")
    home = str(tmp_path / "file" / "home")
    done = program(
        "process", "sim:walk?strides=1", "--profile", "papers", "--json",
        HOME=home, XDG_CONFIG_HOME=home, XDG_CACHE_HOME=home, STRIDESCOPE_LOG="loud",
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["feet"]["foot"]["strides"] == 1


@pytest.mark.timeout(400)
@pytest.mark.parametrize(
    ("where", "code", "said"),
    [(">&-", 0, ""), ("2>&- <&-", 0, ""), ("> /dev/full", 2, "cannot be written")],
)
def test_nowhere_to_write_to_is_no_traceback(tmp_path: Path, where: str, code: int, said: str) -> None:
    if "full" in where and not Path("/dev/full").exists():
        pytest.skip("this system has no /dev/full")
    (tmp_path / "walk.csv").write_text(csv_of(still_rows(1)))
    script = f"{sys.executable} -m app info {tmp_path}/walk.csv {where}"
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = subprocess.run(
        ["bash", "-c", script], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=390,
        check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr.count("\n")) == (code, int(bool(said)))
    assert said in done.stderr


def test_ctrl_c_while_the_program_is_imported_says_nothing() -> None:
    """It comes at the worst moment: in the middle of an import."""
    script = """
import importlib.abc, os, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # also where the tests run in the background
class Finder(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == "app.commands.info":
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Finder())
from app.__main__ import main
main()
"""
    done = subprocess.run(
        [sys.executable, "-c", script, "--version"], cwd=ROOT, capture_output=True, text=True, timeout=300,
        check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, "", "")


@pytest.mark.timeout(400)
def test_a_reader_that_goes_away_is_no_traceback() -> None:
    script = f"{sys.executable} -m app process 'sim:walk?strides=1' | true"
    done = subprocess.run(
        ["bash", "-c", script], cwd=ROOT, capture_output=True, text=True, timeout=390, check=False
    )
    assert done.stderr == ""
