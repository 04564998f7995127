"""The exported law by cffi, in its ABI mode: the header's declarations, and the compiled library."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..scene.scene import Scene
from .compiled_law import compiled_law
from .extras import required

FFI = required("cffi", "cffi").FFI

__all__ = ["law"]


def law(scene: Scene | str | Path) -> tuple[Any, Any]:
    """The compiled law of a scene.

    Arguments:
        scene: a Scene, a path or a preset's name. The names of functions begin with its name.

    Returns:
        (ffi, lib): `ffi` has the structures of NAME.h, `lib` its functions and enumerators.

    Raises:
        ComputationError: there is no C compiler.
        ImportError: cffi is not installed.

    Example:
        >>> ffi, lib = law("granulation")
        >>> material = ffi.new("granulation_material *", lib.granulation_default_material())
        >>> impact = ffi.new("granulation_impact *", {"speed": 3.0, "angle": 0.2})
        >>> found = ffi.new("granulation_collision *")
        >>> lib.granulation_collide(material, impact, 1e-9, found) == lib.GRANULATION_OK
        True
        >>> found.outcome == lib.GRANULATION_BOUNCE
        True
    """
    compiled, ffi = compiled_law(scene), FFI()
    ffi.cdef(compiled.declarations)
    return ffi, compiled.opened(ffi.dlopen)
