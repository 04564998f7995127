"""The material of a pair from a scene's entries, in C: what `quantities` computes of symbols, printed as C."""

from collections.abc import Sequence

import casadi
from casadi import SX, Function

from ...averages.sizes import FIXED, scene_of_sizes
from ...errors import CheckFailed
from ...scene.quantities import Ways, quantities
from ...scene.scene import Scene
from .material import LARGE, LARGEST, Number, meaning_of

_OPERATIONS = {
    casadi.OP_ADD: "{} + {}", casadi.OP_SUB: "{} - {}", casadi.OP_MUL: "{}*{}", casadi.OP_DIV: "{}/{}",
    casadi.OP_NEG: "-{}", casadi.OP_SQ: "{0}*{0}", casadi.OP_TWICE: "2.0*{}", casadi.OP_INV: "1.0/{}",
    casadi.OP_SQRT: "sqrt({})",
}  # fmt: skip
_COATED, _COATED_TOO = "liquid.coating_thickness", "partner.coating_thickness"
_SIZES = ("reduced_radius", "reduced_mass", "film_thickness", "volume")
"""Quantities that entries of several kinds may give."""


def pair_entries(scene: Scene, of_material: Sequence[Number]) -> tuple[Number, ...]:
    """The numbers that describe a pair: all of the scene's but its impact, and those that may be added to it.

    Spheres have a radius and a density each, however the scene gives their sizes; those on strings are equal.
    """
    first, other = 2 * scene.particles.reduced_radius, scene.partner and scene.partner.radius
    alone = scene.wall or scene.pendulum is not None
    sized = scene_of_sizes(scene, first, None if alone else other or first, FIXED)
    given = {name: float(value) for name, value in sized.si if not isinstance(value, str)}
    if not alone and _COATED in given:
        given.setdefault(_COATED_TOO, given[_COATED])
    needed = {*_SIZES, "", *(number.name for number in of_material)}
    names = {*_SIZES, *(scene.fields[name].quantity for name in given)}
    added = {number.name: number.value for number in of_material if number.name not in names}
    package = scene.package
    own = {f"{package.table}.{name}" for name in package.quantities} if package else set[str]()
    numbers = []
    for name, field in scene.fields.items():
        quantity = field.quantity
        if name in given or quantity in added:
            plain = name in own or not quantity or quantity in _SIZES[:2]
            meaning = field.what if plain else meaning_of(quantity, scene)
            if name == "bridge.volume" and scene.ways.volume == "absolute":
                meaning = "bridge volume"
            if quantity not in needed:
                meaning += ", on which no collision depends"
            member, value = name.replace(".", "_"), given[name] if name in given else added[quantity]
            most = LARGE.get(quantity, LARGEST)
            numbers.append(Number(member, field.unit or "1", meaning, field.range, value, most))
    return tuple(numbers)


def computed(scene: Scene, entries: Sequence[Number], of_material: Sequence[Number]) -> list[str]:
    """Lines of C that set the members of `m` from those of `e`; what is used more than once has a name."""
    symbols = {number.name.replace("_", ".", 1): SX.sym(number.name) for number in entries}
    values = quantities(symbols, Ways(scene.wall, scene.ways.volume))
    function = Function("f", [*symbols.values()], [SX(values[number.name]) for number in of_material])
    places: dict[int, int] = {}  # of the work vector, and the instruction whose result is there
    operands: list[tuple[int, ...]] = []
    for k in range(function.n_instructions()):
        kind = function.instruction_id(k)
        operands.append(() if kind == casadi.OP_INPUT else tuple(places[i] for i in _read(function, k)))
        if kind != casadi.OP_OUTPUT:
            places[function.instruction_output(k)[0]] = k
    lines, texts = list[str](), dict[int, str]()
    for k, those in enumerate(operands):
        kind = function.instruction_id(k)
        if kind == casadi.OP_OUTPUT:
            lines.append(f"m.{of_material[function.instruction_output(k)[0]].name} = {texts[those[0]]};")
        elif kind == casadi.OP_INPUT:
            texts[k] = f"e->{entries[function.instruction_input(k)[0]].name}"
        elif kind == casadi.OP_CONST:
            texts[k] = repr(function.instruction_constant(k))
        elif kind in _OPERATIONS:
            texts[k] = f"({_OPERATIONS[kind].format(*(texts[index] for index in those))})"
            if kind == casadi.OP_SQ or sum(indices.count(k) for indices in operands) > 1:
                lines.append(f"const double w{k} = {texts[k][1:-1]};")
                texts[k] = f"w{k}"
        else:
            raise CheckFailed(f"an operation that is not known in C: {kind}")
    return lines


def _read(function: Function, k: int) -> list[int]:
    """Places of the work vector that an instruction reads."""
    return [] if function.instruction_id(k) == casadi.OP_CONST else list(function.instruction_input(k))
