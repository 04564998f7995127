# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
"""From a structure module to CasADi Functions over vectors ordered as its STATES and GROUPS."""

from collections.abc import Callable, Mapping
from inspect import signature
from types import ModuleType
from typing import Any

from casadi import SX, Function, densify, jacobian, jtimes, vertcat


class Laws:
    """The law modules that fill a structure's slots, as attributes: `laws.bridge.force(...)`."""

    def __init__(self, **slots: ModuleType) -> None:
        for slot, module in slots.items():
            setattr(self, slot, module)

    def __getattr__(self, slot: str) -> Any:
        raise AttributeError(f"no law fills the slot {slot!r}")


def symbols(names: tuple[str, ...]) -> dict[str, SX]:
    """A CasADi symbol for each name."""
    return {name: SX.sym(name) for name in names}


def vector(values: Mapping[str, Any]) -> SX:
    """A dense column of the values, in their order."""
    return densify(vertcat(*(SX(value) for value in values.values())))


def casadi_functions(structure: ModuleType, laws: Laws, film: int = 1, shear: int = 1) -> dict[str, Function]:
    """Every function of a structure as a CasADi Function (state, groups) -> column, and the derivatives of two.

    Those of the friction of a dry contact have further arguments behind these two, scalars (`further`).
    `jacobian` is that of right_hand_side in the state; `event_rates` the time derivatives of the event functions.
    """
    state, groups = symbols(structure.STATES), symbols(structure.GROUPS)
    inputs = [vector(state), vector(groups)] if groups else [vector(state), SX(0, 1)]
    columns, given = {}, {}
    for name in structure.FUNCTIONS:
        region = {"film": film, "shear": shear} if name in structure.REGIONAL else {}
        given[name] = symbols(further(getattr(structure, name)))
        columns[name] = vector(getattr(structure, name)(state, groups, laws, **region, **given[name]))
    rates = columns["right_hand_side"]
    columns["jacobian"] = jacobian(rates, inputs[0])
    columns["event_rates"] = jtimes(columns["events"], inputs[0], rates)
    return {
        name: Function(name, [*inputs, *more.values()], [column], ["state", "groups", *more], [name])
        for name, column in columns.items()
        for more in [given.get(name, {})]
    }


def further(function: Callable[..., Any]) -> tuple[str, ...]:
    """Names of a structure function's arguments behind the state, the groups, the laws and the flags of the region."""
    return (*(name for name in signature(function).parameters if name not in _ARGUMENTS),)


_ARGUMENTS = ("state", "groups", "laws", "film", "shear")
