"""Entries of a scene from measured impacts: likelihood, estimates, intervals, and what the data cannot tell."""
