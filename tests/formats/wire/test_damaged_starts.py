"""Start-ups over a line on which one byte in a hundred is damaged."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from app.formats.wire import gx1_talk, mip_talk, ximu3_talk, xsens_talk
from app.formats.wire.catalogue import Model
from app.formats.wire.faults import Faults, Line
from app.formats.wire.talk import Script
from tests.formats.wire.protocols import at_rest, converse

STARTS: dict[str, tuple[Callable[[], Script[Any]], Callable[[], Model], str]] = {
    "gx1": (gx1_talk.start_up, gx1_talk.Gx1Device, "1234"),
    "mip": (mip_talk.start_up, mip_talk.MipDevice, "0000.00001"),
    "xsens": (xsens_talk.start_up, xsens_talk.XsensDevice, "03800123"),
    "ximu3": (ximu3_talk.start_up, ximu3_talk.Ximu3Device, "0123-4567"),
}


@pytest.mark.parametrize("device", STARTS)
@pytest.mark.parametrize("faults", [Faults(lost=0.01), Faults(flip=0.01)], ids=["lost", "flip"])
def test_its_serial_number_is_known_and_never_a_wrong_one(device: str, faults: Faults) -> None:
    start_up, model, serial = STARTS[device]
    talks = [converse(start_up(), model(), at_rest(300), line=Line(faults, seed)) for seed in range(40)]
    told = [talk.result.serial for talk in talks if talk.result is not None]
    assert set(told) <= {serial, ""}
    assert told.count(serial) >= 35
