"""Boundaries, where the outcome changes: on lines, as curves and as atlases."""
