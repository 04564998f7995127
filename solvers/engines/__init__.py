"""What integrates a collision: CasADi's integrators, the reference, and the compiled Taylor kernel."""
