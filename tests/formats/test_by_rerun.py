"""Rerun reads what we write: its own converter, the same counts and values. Optional: 170 MB to install."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from app.formats import cdr
from tests.formats.walks import CLOCK_NS, random_samples, write

rerun = pytest.importorskip(
    "rerun.chunk", reason="Rerun (170 MB) is not installed: pip install rerun-sdk==0.41.0 to see this run"
)
SAMPLES = [sample._replace(device_ns=sample.device_ns + 10**9) for sample in random_samples(400)]


@pytest.fixture(scope="module")
def converted(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[Any]]:
    """Tables of rows by topic, as Rerun's converter makes them."""
    path = tmp_path_factory.mktemp("rerun") / "walk.mcap"
    path.write_bytes(write(SAMPLES))
    tables: dict[str, list[Any]] = {}
    for chunk in rerun.McapReader(str(path)).stream().to_chunks():
        if chunk.timeline_names:
            tables.setdefault(str(chunk.entity_path), []).append(chunk.to_record_batch())
    return tables


def numbers(tables: list[Any], column: str) -> np.ndarray:
    """A column of lists of numbers, [n, …]."""
    return np.array([row for table in tables for row in table.column(column).to_pylist()])


def times(tables: list[Any]) -> list[int]:
    return [value for table in tables for value in table.column("message_log_time").cast("int64").to_pylist()]


@pytest.mark.parametrize("sensor", ["left", "right"])
def test_every_reading_is_there_to_the_bit(converted: dict[str, list[Any]], sensor: str) -> None:
    own = [sample for sample in SAMPLES if sample.sensor == sensor]
    tables = converted[f"/{sensor}/imu"]
    order = np.argsort(times(tables), kind="stable")
    assert np.array(times(tables))[order].tolist() == [sample.host_ns + CLOCK_NS for sample in own]
    read = numbers(tables, "Scalars:scalars")[order]
    assert read.tolist() == [[*sample.angular_rate_b, *sample.specific_force_b] for sample in own]


@pytest.mark.parametrize("sensor", ["left", "right"])
def test_every_field_is_there(converted: dict[str, list[Any]], sensor: str) -> None:
    own = [sample for sample in SAMPLES if sample.sensor == sensor and sample.field_b is not None]
    tables = converted[f"/{sensor}/magnetic_field"]
    order = np.argsort(times(tables), kind="stable")
    read = numbers(tables, "Arrows3D:vectors")[order][:, 0]  # as single precision
    told = [cdr.tesla(sample.field_b) for sample in own if sample.field_b is not None]
    np.testing.assert_allclose(read, told, rtol=1e-6)


def test_the_rest_is_carried_too(converted: dict[str, list[Any]]) -> None:
    assert {"/stridescope/recording", "/stridescope/start"} <= set(converted)
    assert {"/left/extra", "/right/extra"} <= set(converted)
