# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
"""Emitted CasADi modules: a structure a module, laws in `laws`, groups in `scaling`."""
