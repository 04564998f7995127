"""The equations of a structure: rates, events, observables, invariants and certificates."""
