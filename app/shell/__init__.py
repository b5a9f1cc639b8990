"""Shell: opens the edges, hands samples and commands to the heart, closes everything in the end."""
