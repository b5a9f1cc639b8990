"""Heart: the papers' tables and figures, made again."""
