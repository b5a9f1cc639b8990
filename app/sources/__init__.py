"""Edge: where samples come from. A source is an asynchronous iterator of samples."""
