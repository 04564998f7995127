"""Where the model ends, in the page: its limits as C, and their words."""

import math
from collections.abc import Sequence

from casadi import SX, CodeGenerator, Function, vertcat

from ..model.validity import LIMITS, NEEDS, WORDS, law_limits
from ..scene.groups import si_values
from ..scene.scene import Scene

_NAME = "model_limits"
_SHIM = """
/* Bits of the limits that a collision has exceeded. */
int outside(int k)
{{
    static const double least[] = {{{least}}}, most[] = {{{most}}};
    double numbers[{count}];
    const double other[] = {{{other}}};
    const double *arguments[] = {{(const double *)&material, other}};
    double *results[] = {{numbers}};
    int bits = 0;
    {name}(arguments, results, 0, 0, 0);
    for (int i = 0; i < {count}; i++)
        bits |= (numbers[i] < least[i] || numbers[i] > most[i]) << i;
    return bits;
}}
"""


def limits(scene: Scene, material: Sequence[str], entries: Sequence[str]) -> tuple[str, list[str]]:
    """C of a function `outside` behind that of `shim.h`, and the words of its bits.

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
        found.append(limit)
    code = CodeGenerator(_NAME)
    code.add(Function(_NAME, [vertcat(*members.values()), vertcat(*others.values())], [vertcat(*numbers)]))
    given = [f"impacts[k].{name}" for name in results[:2]] + [f"collisions[k].{name}" for name in results[2:-1]]
    given.append("pair_entries.liquid_density" if dense else "0.0")
    least, most = (
        ", ".join(f"{bound!r}".replace("inf", "INFINITY") for bound in bounds)
        for bounds in zip(*(limit.bounds for limit in found), strict=True)
    )
    shim = _SHIM.format(count=len(found), other=", ".join(given), name=_NAME, least=least, most=most)
    return str(code.dump()) + shim, [WORDS.get(limit.flag, limit.flag) for limit in found]
