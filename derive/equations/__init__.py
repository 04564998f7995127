"""What is solved: rates, events, observables, invariants and certificates of a structure."""
