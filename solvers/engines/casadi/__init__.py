"""The reference engines, CVODES and Rosenbrock: location of events, and replay of the phases."""
