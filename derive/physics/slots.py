"""The functions of each slot: their dimensionless arguments, these in SI, and the scale of the value."""

from dataclasses import dataclass

import sympy as sp

from ..vocabulary.dimensions import ONE, Dimension, dimension_of
from ..vocabulary.quantities import DIMENSIONS, normal_velocity, u, v0, x, x0
from .forces import FILM, SHEAR, force_laws
from .laws import LAWS
from .laws.base import slot_calls
from .scaling import LUBRICATION_PRESSURE


@dataclass(frozen=True)
class Place:
    """A function of a slot.

    Arguments:
        arguments: its dimensionless arguments.
        at: the same arguments in SI quantities; empty if the function has no SI form.
        scale: factor from the function to its SI value; 1 if the function has no SI form.
    """

    slot: str
    function: str
    arguments: tuple[sp.Symbol, ...]
    at: tuple[sp.Expr, ...]
    scale: sp.Expr
    doc: str

    @property
    def dimension(self) -> Dimension:
        return dimension_of(self.scale, DIMENSIONS) or ONE


def places() -> dict[str, Place]:
    """Every function of every slot, by `slot.function`; scales and SI arguments are taken from the force laws."""
    scaled = _scaled()
    result = {}
    for slot, laws in LAWS.items():
        functions = {function.name: function for law in reversed(laws.values()) for function in law.functions}
        for function in functions.values():  # of the first law that has the function
            key = f"{slot}.{function.name}"
            result[key] = Place(slot, function.name, function.arguments, *scaled.get(key, _NO_SI_FORM), function.doc)
    return result


_NO_SI_FORM = ((), sp.Integer(1))


def _scaled() -> dict[str, tuple[tuple[sp.Expr, ...], sp.Expr]]:
    """The factor of the call in a force that is a single call times a factor."""
    result: dict[str, tuple[tuple[sp.Expr, ...], sp.Expr]] = {
        "glass.pressure": ((x / x0, -u / v0), LUBRICATION_PRESSURE),
        "shear.edge": ((next(iter(LAWS["shear"].values()))["edge"].arguments), x0),
    }
    for force in force_laws().values():
        calls = slot_calls(force)
        if len(calls) != 1 or calls[0].func.__name__.startswith("strings."):
            continue  # rise and stiffness of the strings share one pair of arguments
        factor = force.subs({FILM: 1, SHEAR: 1}).xreplace({calls[0]: sp.Integer(1)})
        result[calls[0].func.__name__] = (calls[0].args, factor)
    return result


MOTION: dict[str, tuple[sp.Symbol, ...]] = {"film": (normal_velocity,), "shear": (normal_velocity,)}
"""States other than the gap that a slot's law may depend on: what the stick certificates do not need to know."""
