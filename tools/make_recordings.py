"""Make the shipped recordings: run it from the repository's root, `python tools/make_recordings.py`.

Each becomes a plain CSV, which is shipped, and the same as MCAP, which is not: for other tools to open.
"""

from __future__ import annotations

from pathlib import Path
from urllib.parse import parse_qsl

from app.formats.journal import Start
from app.formats.keeping import Keeper
from app.formats.plain import encode
from app.motion.recording import Recording
from app.settings import Settings
from app.simulate.walk import make_walk
from app.sources.timeline import Timeline

FOLDER = Path(__file__).parent.parent / "recordings"
#: A sensor about three times better than the papers' 3DM-GX1, with a gyro that drifts 0.2 °/s.
SENSOR = (
    "noise=0.3&accelerometer_bias_mps2=0.03,-0.02,0.04&gyro_bias_radps=0.003,-0.002,0.0035"
    "&magnetometer_bias_gauss=0.0007,-0.0005,0.0006&lost_fraction=0.001&decimals=4"
)
#: 1 January 2012, 0:00 UTC: a recording must have begun some time.
BEGAN_NS = 1_325_376_000 * 10**9
CHUNK = 400
SPECS = {
    # Two rounds of a figure eight, past a magnet on the far side that bends the compass.
    "demo.csv": "path=eight&size_m=9&laps=2&feet=2&still_s=1.5&end_s=2&seed=2012"
    f"&iron_gauss_m3=0.05&iron_along=0.125&{SENSOR}",
    # Two flights of stairs.
    "stairs.csv": f"path=stairs&feet=2&cadence_spm=100&still_s=1.5&end_s=2&seed=2007&{SENSOR}",
}


def recording_of(query: str) -> Recording:
    """The simulated recording of a `sim:walk` query."""
    return make_walk(dict(parse_qsl(query))).recording


def as_mcap(recording: Recording) -> bytes:
    """As if it had been recorded live: every sample came when it was taken."""
    about = {"source": recording.spec, "spec": recording.spec, "profile": "papers"}
    keeper = Keeper(about, {samples.sensor: samples.role for samples in recording.sensors}, BEGAN_NS)
    parts = [keeper.begin(0)]
    keeper.start(0, Start(Settings(), Settings(), False))
    timeline = Timeline(recording)
    for index, sample in enumerate(timeline.cut(0, len(timeline), 0)):
        keeper.sample(sample._replace(host_ns=timeline.elapsed_ns(index)))
        if index % CHUNK == CHUNK - 1:
            parts.append(keeper.chunk())
    return b"".join([*parts, keeper.end()])


def main() -> None:
    for name, query in SPECS.items():
        recording = recording_of(query)
        data = encode(recording)
        FOLDER.mkdir(exist_ok=True)
        (FOLDER / name).write_bytes(data)
        (FOLDER / name).with_suffix(".mcap").write_bytes(as_mcap(recording))
        print(f"{name}: {recording.duration_s:.1f} s, {len(data) / 1e6:.2f} MB, {recording.spec}")


if __name__ == "__main__":
    main()
