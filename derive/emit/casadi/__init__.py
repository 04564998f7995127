"""Emission of the equations as Python modules with CasADi expressions."""
