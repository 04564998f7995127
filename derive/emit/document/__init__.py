"""Emission of the equations as LaTeX."""
