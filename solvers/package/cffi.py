"""`wetdoublet.cffi`: see `solvers/bindings/cffi.py`."""

from wetdoublet.solvers.bindings.cffi import *  # noqa: F403 # its `__all__`
from wetdoublet.solvers.bindings.cffi import __all__ as __all__
