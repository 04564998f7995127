"""The picture of a collision."""
