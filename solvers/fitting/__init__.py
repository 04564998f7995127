"""Parameters of a scene from measured collisions: likelihood, estimates with intervals, and what the data cannot tell."""
