"""Emission of the equations as LaTeX and Markdown."""
