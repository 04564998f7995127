"""The reference engines: CVODES and Rosenbrock, phases located and replayed."""
