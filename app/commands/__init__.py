"""Shell: the command line, a file for each command: its options, and what it prints."""
