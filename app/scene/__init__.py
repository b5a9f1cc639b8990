"""Edge: the only importer of viser. Draws a snapshot, hands over commands."""
