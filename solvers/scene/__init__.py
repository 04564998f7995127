"""Scenes: entries, units, consistency and derived quantities."""
