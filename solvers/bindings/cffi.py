"""The exported law by cffi, in its ABI mode: the header's declarations, and the compiled library."""

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
        scene: a Scene, a path or a preset's name. Names begin with `law_` for every scene.

    Returns:
        (ffi, lib): `ffi` has the structures of the exported header, `lib` its functions and enumerators.

    Raises:
        ComputationError: there is no C compiler.
        ImportError: cffi is not installed.

    Example:
        >>> ffi, lib = law("granulation")
        >>> material = ffi.new("law_material *", lib.law_default_material())
        >>> impact = ffi.new("law_impact *", {"speed": 3.0, "angle": 0.2})
        >>> found = ffi.new("law_collision *")
        >>> lib.law_collide(material, impact, 1e-9, 0, found) == lib.LAW_OK
        True
        >>> found.outcome == lib.LAW_BOUNCE
        True
    """
    compiled, ffi = compiled_law(scene), FFI()
    ffi.cdef(compiled.declarations)
    return ffi, compiled.opened(ffi.dlopen)
