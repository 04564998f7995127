"""Where the model ends, in the page: the numbers of its limits as C, and what counts as outside."""

import math
from collections.abc import Sequence
from typing import Any

from casadi import SX, CodeGenerator, Function, vertcat

from ..model.validity import LIMITS, NEEDS, WORDS, law_limits
from ..scene.groups import si_values
from ..scene.scene import Scene

_NAME = "model_limits"
_SHIM = """
static double limit_numbers[{count}];

double *limits_of(int k)
{{
    const double other[] = {{{other}}};
    const double *arguments[] = {{(const double *)&material, other}};
    double *results[] = {{limit_numbers}};
    {name}(arguments, results, 0, 0, 0);
    return limit_numbers;
}}
"""


def limits(scene: Scene, material: Sequence[str], entries: Sequence[str]) -> tuple[str, list[dict[str, Any]]]:
    """C of a function `limits_of` behind that of `shim.h`, and the limits: words, and what counts as inside.

    Arguments:
        material: members of the law's material, in their order.
        entries: members of the law's entries of a pair.
    """
    members = {name: SX.sym(name) for name in material}
    results = ("speed", "angle", "outcome", *NEEDS, "density")
    others = {name: SX.sym(name) for name in results}
    dense = "liquid_density" in entries
    known = {**si_values(scene, None, None), **members, **others}
    if not dense:
        del known["density"]
    found, numbers = [], []
    for limit in (*LIMITS, *law_limits(scene)):
        number = limit.number(scene, known)
        if isinstance(number, float) and math.isnan(number):
            continue  # the question does not arise for this scene
        numbers.append(number)
        least, most = (each if math.isfinite(each) else None for each in limit.bounds)
        found.append({"words": WORDS.get(limit.flag, limit.flag), "least": least, "most": most})
    code = CodeGenerator(_NAME)
    code.add(Function(_NAME, [vertcat(*members.values()), vertcat(*others.values())], [vertcat(*numbers)]))
    given = [f"impacts[k].{name}" for name in results[:2]] + [f"collisions[k].{name}" for name in results[2:-1]]
    given.append("pair_entries.liquid_density" if dense else "0.0")
    return str(code.dump()) + _SHIM.format(count=len(found), other=", ".join(given), name=_NAME), found
