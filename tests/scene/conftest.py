from __future__ import annotations

from collections.abc import Iterator

import pytest

from app.motion.commands import Order
from app.scene.page import Scene


@pytest.fixture
def orders() -> list[Order]:
    """What browsers asked for."""
    return []


@pytest.fixture
def scene(orders: list[Order]) -> Iterator[Scene]:
    made = Scene(orders.append)
    yield made
    made.close()
