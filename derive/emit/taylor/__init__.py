"""Emission of the equations as C headers with Taylor recurrences."""
