"""The equations as Python modules of CasADi expressions."""
