"""NAME.f90: the law's interface by iso_c_binding."""

from __future__ import annotations

from collections.abc import Iterable

from ...scene.scene import Scene
from .header import RESULTS
from .kernels import only_in_a_plane
from .material import Number
from .space import FORTRAN_FUNCTIONS, fortran_types

_KINDS = {"int": "integer(c_int)", "double": "real(c_double)"}


def interface(scene: Scene, of_material: Iterable[Number], of_impact: Iterable[Number]) -> str:
    """The Fortran module, with `law_` in the place of the law's prefix."""
    in_space = not only_in_a_plane(scene)
    lines = ["! The law from Fortran; what everything means stands in the header of the C file.", "module @NAME@"]
    lines += ["  use, intrinsic :: iso_c_binding", "  implicit none", ""]
    for name, fields in (
        ("law_material", [("double", each.name) for each in of_material]),
        ("law_impact", [("double", each.name) for each in of_impact]),
        ("law_collision", [(kind, name) for kind, name, _ in RESULTS]),
        *(fortran_types() if in_space else []),
    ):
        lines += [f"  type, bind(c) :: {name}", *(f"    {_KINDS[kind]} :: {field}" for kind, field in fields)]
        lines += [f"  end type {name}", ""]
    lines += [
        "  interface",
        "    function law_default_material() bind(c)",
        "      import :: law_material",
        "      type(law_material) :: law_default_material",
        "    end function law_default_material",
        "",
        "    function law_collide(material, impact, rtol, found) bind(c) result(status)",
        "      import :: c_int, c_double, law_material, law_impact, law_collision",
        "      type(law_material), intent(in) :: material",
        "      type(law_impact), intent(in) :: impact",
        "      real(c_double), value :: rtol",
        "      type(law_collision), intent(out) :: found",
        "      integer(c_int) :: status",
        "    end function law_collide",
        "",
        "    function law_collide_many(material, impacts, count, rtol, found) bind(c) result(failed)",
        "      import :: c_long, c_double, law_material, law_impact, law_collision",
        "      type(law_material), intent(in) :: material",
        "      integer(c_long), value :: count",
        "      type(law_impact), intent(in) :: impacts(count)",
        "      real(c_double), value :: rtol",
        "      type(law_collision), intent(out) :: found(count)",
        "      integer(c_long) :: failed",
        "    end function law_collide_many",
        *(["", *FORTRAN_FUNCTIONS.splitlines()] if in_space else []),
        "  end interface",
        "end module @NAME@",
        "",
    ]
    return "\n".join(lines)
