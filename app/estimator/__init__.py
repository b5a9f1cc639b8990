"""Heart: samples into orientation, gait phase and position; the papers' step and what stands beside it."""
