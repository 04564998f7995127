"""Entries of a scene from measured impacts: likelihood, intervals, what is not known, and where to measure next."""
