"""Oblique collisions of two liquid-coated particles: whether they stick, bounce, or stick, rotate and separate.

Plain numbers are SI and radians; a string carries its unit. A scene is a `Scene`, a path to a scene file, or a preset's
name. Names are loaded on first use, so that importing the package costs a few milliseconds.

Example:
    >>> import wetdoublet as wd
    >>> one = wd.collide("granulation", stokes=0.02, angle="75 deg")
    >>> one.outcome, one.restitution > 1
    ('stick-rotate-separate', True)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from wetdoublet.solvers import __all__ as __all__  # absolute: this folder is mapped to the top of the package

if TYPE_CHECKING:
    from wetdoublet.solvers import *  # noqa: F403 # its `__all__`

    __version__: str

if not TYPE_CHECKING:  # so that type checkers know the names above and no others

    def __getattr__(name: str) -> Any:
        if name == "__version__":
            from importlib.metadata import version

            value: Any = version("wetdoublet")
        elif name in __all__:
            from wetdoublet import solvers

            value = getattr(solvers, name)
        else:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
