"""Heart: motion of two feet into intention, intention into a way through the world."""
