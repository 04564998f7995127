"""Where a model file imports from: `from wetdoublet.derive.user import ...`."""

from .user_model import declarations
from .user_model.declarations import *  # noqa: F403 -- the names of people's model files

__all__ = declarations.__all__
