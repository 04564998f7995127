"""The enclosing engine: all trajectories from a box of inputs, by interval arithmetic, so that an outcome is proved."""
