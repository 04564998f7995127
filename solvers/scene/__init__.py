"""What collides: entries, units, consistency and derived quantities of a scene."""
