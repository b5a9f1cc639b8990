"""Heart: simulated walkers; their truth in closed form. Never calls the estimator."""
