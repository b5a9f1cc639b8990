"""Heart: wire protocols: bytes into samples and back, and the talk of sensors that obey commands."""
