"""Maps and boundaries of outcomes that are proved, for whole boxes of inputs."""
