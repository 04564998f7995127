"""Figures of one collision."""
