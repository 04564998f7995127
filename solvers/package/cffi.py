"""`wetdoublet.cffi`: see `solvers/bindings/cffi.py`."""

from wetdoublet.solvers.bindings.cffi import *  # noqa: F403 # its `__all__`
