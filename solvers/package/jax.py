"""`wetdoublet.jax`: see `solvers/export/jax.py`."""

from wetdoublet.solvers.export.jax import *  # noqa: F403 # its `__all__`
