"""The exported law inside functions that numba compiles."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..scene.scene import Scene
from .compiled_law import compiled_law
from .extras import required

numba = required("numba", "numba")

__all__ = ["CompiledForNumba", "law"]


@dataclass(frozen=True)
class CompiledForNumba:
    """A scene's law for functions in numba's nopython mode.

    Attributes:
        material: record array of one element, the scene's numbers, SI; a changed copy is another material.
        impact, collision: numpy types of an impact and of its result, with the fields of the header.
        collide_many: (material, impacts, rtol, found) -> how many have no answer; it fills `found`, whose `outcome` is
            -1 without an answer, for the reason in `status`, and whose numbers are NaN where undefined. Contiguous
            arrays of the types above.
        address: of the C function, for a caller of one's own: (material *, impacts *, long count, double rtol,
            int budget, collisions *) -> long; budget 0 is the usual one.
    """

    material: np.ndarray
    impact: np.dtype[Any]
    collision: np.dtype[Any]
    collide_many: Any
    address: int


def law(scene: Scene | str | Path) -> CompiledForNumba:
    """The compiled law of a scene.

    Arguments:
        scene: a Scene, a path or a preset's name.

    Raises:
        ComputationError: there is no C compiler.
        ImportError: numba is not installed.

    Example:
        >>> import numpy as np
        >>> granulation = law("granulation")
        >>> impacts, found = np.zeros(1, granulation.impact), np.zeros(1, granulation.collision)
        >>> impacts["speed"], impacts["angle"] = 3.0, 0.2
        >>> granulation.collide_many(granulation.material, impacts, 1e-9, found)
        0
        >>> float(found["restitution"][0].round(3))
        0.968
    """
    compiled = compiled_law(scene)
    numbers, impact, collision = (compiled.dtype(name) for name in ("material", "impact", "collision"))
    shared = compiled.opened(ctypes.CDLL)
    default = shared.law_default_material
    fields = [(name, ctypes.c_double) for name in numbers.names or ()]
    default.restype = type("Material", (ctypes.Structure,), {"_fields_": fields})
    material = np.frombuffer(bytes(default()), numbers).copy()
    many = shared.law_collide_many
    pointer = ctypes.c_void_p
    many.argtypes, many.restype = (
        (pointer, pointer, ctypes.c_long, ctypes.c_double, ctypes.c_int, pointer),
        ctypes.c_long,
    )
    records = [numba.types.Array(numba.from_dtype(kind), 1, "C") for kind in (numbers, impact, collision)]
    signature = numba.int64(records[0], records[1], numba.float64, records[2])

    @numba.njit(signature)  # type: ignore[untyped-decorator] # numba is Any
    def collide_many(material: Any, impacts: Any, rtol: float, found: Any) -> int:
        if material.size != 1 or found.size != impacts.size:
            raise ValueError("one material, and as many collisions as impacts")
        return many(material.ctypes, impacts.ctypes, impacts.size, rtol, 0, found.ctypes)  # type: ignore[no-any-return] # as above

    return CompiledForNumba(material, impact, collision, collide_many, ctypes.cast(many, pointer).value or 0)
