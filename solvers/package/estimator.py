"""`wetdoublet.estimator`: see `solvers/bindings/estimator.py`."""

from wetdoublet.solvers.bindings.estimator import *  # noqa: F403 # its `__all__`
