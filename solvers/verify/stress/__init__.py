"""Stress test: comparison of all engines on random scenes."""
