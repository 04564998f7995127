"""Equations and functions for use elsewhere, and differences between models."""
