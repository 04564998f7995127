# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
"""Emitted laws: `<slot>_<name>`, functions of dimensionless arguments."""
