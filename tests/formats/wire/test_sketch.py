"""The sketch in docs/message.md: its structs, compiled, make messages that our decoder takes."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from app.formats.wire.intake import Intake
from app.formats.wire.message import Message, decode

DOCUMENT = Path(__file__).parents[3] / "docs" / "message.md"
#: The board, for a computer: its readings are made up, datagrams go to standard output behind their length.
BOARD = """
#include <cstdint>
#include <cstdio>
#include <cstring>
typedef int wl_status_t;
const int MPU6050_RANGE_16_G = 0, MPU6050_RANGE_2000_DEG = 0, WL_CONNECTED = 3;
int64_t now_us = 0;
int64_t esp_timer_get_time() { return now_us += 100; }
uint32_t esp_random() { return 0xABCD0123; }
struct Vector { float x, y, z; };
struct sensors_event_t { Vector acceleration, gyro; };
struct Adafruit_MPU6050 {
  int calls = 0;
  void begin() {} void setAccelerometerRange(int) {} void setGyroRange(int) {}
  void getEvent(sensors_event_t *a, sensors_event_t *g, sensors_event_t *) {
    a->acceleration = {0.01f * calls, 1.0f, 9.81f};
    g->gyro = {0.1f, 0.2f, 0.3f};
    ++calls;
  }
};
struct { void begin(const char *, const char *) {} void setSleep(bool) {} int status() { return 3; } } WiFi;
struct WiFiUDP {
  void beginPacket(const char *, uint16_t) {}
  void write(const uint8_t *data, size_t size) { printf("%zu\\n", size); fwrite(data, 1, size, stdout); }
  void endPacket() {}
};
"""


@pytest.fixture(scope="module")
def datagrams(tmp_path_factory: pytest.TempPathFactory) -> list[bytes]:
    compiler = shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        pytest.skip("needs a C++ compiler")
    folder = tmp_path_factory.mktemp("sketch")
    sketch = re.search(r"```cpp\n(.*?)```", DOCUMENT.read_text("utf-8"), re.DOTALL)
    assert sketch is not None
    code = re.sub(r"#include <(?:WiFi|Adafruit).*>\n", "", sketch[1])
    main = "int main() { setup(); for (int i = 0; i < 40; ++i) loop(); }\n"
    (folder / "sketch.cpp").write_text(BOARD + code + main)
    subprocess.run([compiler, "-std=c++17", "-o", folder / "sketch", folder / "sketch.cpp"], check=True)
    out = subprocess.run([folder / "sketch"], check=True, capture_output=True).stdout
    found = []
    while out:
        size, _, out = out.partition(b"\n")
        found.append(out[: int(size)])
        out = out[int(size) :]
    return found


def test_the_sketch_sends_what_the_decoder_reads(datagrams: list[bytes]) -> None:
    assert len(datagrams) == 10
    message = decode(datagrams[1], 0)
    assert isinstance(message, Message)
    assert message.session == 0xABCD0123ABCD0123
    assert [s.seq for s in message.samples] == list(range(8))
    sample = message.samples[5]
    assert sample.sensor == "left"
    assert sample.specific_force_b == pytest.approx((0.05, -1.0, -9.81))
    assert sample.angular_rate_b == pytest.approx((0.1, -0.2, -0.3))


def test_every_other_datagram_may_be_lost(datagrams: list[bytes]) -> None:
    intake = Intake()
    got = [s for data in datagrams[1::2] for s in intake.take(data, 0)[0]]
    assert [s.seq for s in got] == list(range(40))
    assert intake.counters.lost == 0
