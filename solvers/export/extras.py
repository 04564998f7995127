"""Packages that a binding needs, and that an installation without its extra does not have."""

from importlib import import_module
from typing import Any


def required(module: str, extra: str) -> Any:
    """The module.

    Raises:
        ImportError: it is not installed; the message has the commands that install it.
    """
    try:
        return import_module(module)
    except ImportError as error:
        raise ImportError(
            f"this part of wetdoublet needs {module}, which cannot be imported ({error}): "
            f"pip install 'wetdoublet[{extra}]', or in a clone of the repository: pip install -e '.[{extra}]'",
            name=module,
        ) from error
