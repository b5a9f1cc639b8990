"""Edge: what a walk leaves behind: files."""
