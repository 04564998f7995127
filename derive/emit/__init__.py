"""Emission: derived equations as readable Python modules that build CasADi expressions."""
