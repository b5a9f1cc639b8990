"""Edge: the public port."""
