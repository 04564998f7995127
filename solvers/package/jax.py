"""`wetdoublet.jax`: see `solvers/bindings/jax.py`."""

from wetdoublet.solvers.bindings.jax import *  # noqa: F403 # its `__all__`
