"""The doctor, in a made-up machine: every fault is found and has its remedy."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from app.clocks import LiveClock
from app.health import Monitor
from app.motion.basics import GaitPhase, InputError
from app.motion.samples import Sample
from app.motion.source import SourceInfo
from app.shell import measuring
from app.shell.doctor import Finding, Machine, examine
from app.shell.measuring import measured

Make = Callable[..., Machine]


@pytest.fixture
def machine(tmp_path: Path) -> Make:
    """A machine with one FTDI port of the group dialout, and a user of no group."""
    root = tmp_path / "root"
    timer = root / "sys/bus/usb-serial/devices/ttyUSB0/latency_timer"
    for path, text in (
        (root / "dev/ttyUSB0", ""), (root / "etc/group", f"adm:x:4:\ndialout:x:{os.getgid()}:someone\n"),
        (timer, "16\n"), (tmp_path / "bin/firefox", ""),
    ):  # fmt: skip
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    (tmp_path / "bin/firefox").chmod(0o755)
    (root / "dev/ttyUSB0").chmod(0o660)

    def make(**changes: object) -> Machine:
        usual = {
            "root": root, "uid": 4711, "groups": frozenset({4711}), "config": tmp_path / "config",
            "cache": tmp_path / "cache", "recordings": tmp_path / "recordings",
            "search": str(tmp_path / "bin"), "port": free_port(),
        }  # fmt: skip
        return Machine(**(usual | changes))  # type: ignore[arg-type]

    return make


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def found(machine: Machine) -> dict[str, Finding]:
    return {finding.what: finding for finding in examine(machine)}


def test_a_port_of_another_group_names_the_group_and_the_remedy(machine: Make) -> None:
    finding = found(machine())["/dev/ttyUSB0"]
    assert finding.state == "problem"
    assert "dialout" in finding.told
    assert finding.remedy.startswith("sudo usermod -aG dialout $USER")


@pytest.mark.parametrize("changes", [{"groups": frozenset({os.getgid()})}, {"uid": 0}])
def test_a_port_that_may_be_used_is_ok(machine: Make, changes: dict[str, object]) -> None:
    assert found(machine(**changes))["/dev/ttyUSB0"].state == "ok"


def test_a_port_that_no_group_may_use_needs_another_remedy(machine: Make) -> None:
    made = machine()
    (made.root / "dev/ttyUSB0").chmod(0o600)
    assert "chmod" in found(made)["/dev/ttyUSB0"].remedy


def test_a_slow_driver_timer_is_told_with_its_cure(machine: Make) -> None:
    made = machine()
    finding = found(made)["/dev/ttyUSB0 driver timer"]
    assert (finding.state, finding.told[:5]) == ("advice", "16 ms")
    assert finding.remedy == "echo 1 | sudo tee /sys/bus/usb-serial/devices/ttyUSB0/latency_timer"
    (made.root / "sys/bus/usb-serial/devices/ttyUSB0/latency_timer").write_text("1\n")
    assert found(made)["/dev/ttyUSB0 driver timer"].state == "ok"


def test_no_port_at_all_is_advice(machine: Make) -> None:
    made = machine()
    (made.root / "dev/ttyUSB0").unlink()
    assert found(made)["serial ports"].state == "advice"


def test_a_folder_that_cannot_be_written_is_a_problem(machine: Make, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    findings = found(machine(config=tmp_path / "file" / "config", cache=tmp_path / "file"))
    for what in ("configuration folder", "compiled kernels folder"):
        assert findings[what].state == "problem"
        assert findings[what].remedy
    assert found(machine())["configuration folder"].state == "ok"


def test_a_taken_port_and_a_missing_browser_are_told(machine: Make, tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        findings = found(machine(port=port, search=str(tmp_path / "nothing")))
    assert "--port" in findings[f"port {port}"].remedy
    assert findings["browser"].state == "advice"
    assert found(machine())["browser"].told == "firefox"


def test_an_old_python_is_a_problem(machine: Make) -> None:
    assert found(machine(python=(3, 9)))["Python"].state == "problem"
    assert found(machine())["Python"].state == "ok"


def test_everything_that_is_not_ok_has_a_remedy(machine: Make) -> None:
    for finding in examine(machine(python=(3, 9), search="")):
        assert finding.state in ("ok", "advice", "problem")
        assert (finding.state == "ok") == (finding.remedy == "")


def test_as_a_command_it_tells_json(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "app", "doctor", "--json", "--record", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120)
    told = json.loads(done.stdout)
    assert isinstance(told["ok"], bool)
    assert {"what", "state", "told", "remedy"} == set(told["findings"][0])


def test_a_sensor_is_measured_for_some_seconds(tmp_path: Path) -> None:
    """A real pseudo-terminal with a line that damages every thirtieth packet."""
    command = [sys.executable, "-m", "app", "emulate", "mip", "--source", "sim:walk?loop=1"]
    with subprocess.Popen([*command, "--fault", "flip=0.05%"], stdout=subprocess.PIPE, text=True) as sensor:
        assert sensor.stdout is not None
        spec = f"serial:{sensor.stdout.readline().strip()}?device=mip&baud=115200"
        (finding,) = measured([spec], 3.0)
        sensor.kill()
    assert finding.what.endswith(" foot")
    assert "MicroStrain/HBK MIP at 115200 baud: 100.0 Hz, jitter" in finding.told
    assert "% damaged" in finding.told
    assert finding.state != "ok"
    with pytest.raises(InputError, match="live sensor"):
        measured(["sim:walk"])


def test_a_silent_port_is_advice_and_sound_samples_are_as_they_should(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(measuring, "WAIT_S", 0.1)
    (finding,) = measured(["udp:0"])
    assert (finding.state, finding.told) == ("advice", "udp:0: nobody sends yet")
    clock = LiveClock()
    monitor = Monitor(clock)
    for i in range(500):
        clock.add(i * 10_000_000, i * 10_000_000)
        sample = Sample("left", i, i * 10_000_000, i * 10_000_000, (0.0, 0.0, -9.8), (0.0, 0.0, 0.0))
        monitor.add(sample, True, GaitPhase.SWING)
    source = SimpleNamespace(info=SourceInfo("udp:9000", "datagrams"))
    finding = measuring._finding(source, "left", monitor.recent(0.0, live=True))
    told = "datagrams: 100.0 Hz, jitter 0.0 ms, nothing lost, as it should"
    assert finding == Finding("udp:9000 left", "ok", told)
