"""Stridescope: walk with inertial sensors on your feet, and watch it live in the browser."""

__version__ = "0.1.0"
