"""Properties of collisions, tried on random scenes of structures that together have every pair of choices."""
