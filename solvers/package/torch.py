"""`wetdoublet.torch`: see `solvers/export/torch.py`."""

from wetdoublet.solvers.export.torch import *  # noqa: F403 # its `__all__`
