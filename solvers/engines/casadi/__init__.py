"""The reference engines, CVODES and Rosenbrock: replay of the phases that the kernel has found."""
