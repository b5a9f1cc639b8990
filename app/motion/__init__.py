"""Heart: the words that all rooms share, a file for each topic."""
