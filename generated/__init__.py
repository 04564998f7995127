# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
"""Emitted CasADi modules: one per structure, laws in `laws`, groups in `scaling`."""
