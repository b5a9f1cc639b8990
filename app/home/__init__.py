"""Edge: the user's configuration folder: profiles, visitors, calibrations, gyro biases, a key."""
