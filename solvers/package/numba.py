"""`wetdoublet.numba`: see `solvers/bindings/numba.py`."""

from wetdoublet.solvers.bindings.numba import *  # noqa: F403 # its `__all__`
