"""The engines that integrate collisions: CasADi's integrators, the reference, and the compiled Taylor kernel."""
