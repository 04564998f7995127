"""The collision law in other people's programs: jax, torch, numba, cffi, and an estimator with `fit` and `predict`."""
