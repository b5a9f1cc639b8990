"""Compile every kernel once, so that the tests that run side by side find them in the cache."""

from __future__ import annotations

from app.warm import warm_attitude, warm_gestures, warm_hindsight, warm_up

warm_up("papers")
warm_up("kalman")
warm_hindsight()
warm_attitude()
warm_gestures()
