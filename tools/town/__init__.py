"""Tool: what tools/make_town.py builds the drawn town of."""
