"""`wetdoublet.torch`: see `solvers/bindings/torch.py`."""

from wetdoublet.solvers.bindings.torch import *  # noqa: F403 # its `__all__`
