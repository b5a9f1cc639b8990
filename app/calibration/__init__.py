"""Heart: null points, scales and axes of a sensor, found without equipment."""
