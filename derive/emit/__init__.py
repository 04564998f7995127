"""Emission of the derived equations: Python modules with CasADi expressions, C headers, and documents."""
