"""Equations, functions and the collision law for use elsewhere, differences between models; jax and torch."""
