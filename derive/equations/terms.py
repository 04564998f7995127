"""Terms of a model file in the states and groups of a structure: their forces and inertia by name, energy and power."""

from collections.abc import Mapping
from functools import cache

import sympy as sp

from ..physics.law import Definition
from ..physics.mechanics import M_beta, M_spin, M_x, Q_beta, Q_spin, Q_x, sphere_inertia
from ..physics.partners.bodies import CENTRES
from ..physics.scaling import EQUAL, INERTIA, cancelled, to_groups
from ..physics.structure import Structure
from ..physics.terms import STILL, VELOCITIES
from ..vocabulary import quantities as q

CLOCKS = {q.beta: q.angle_turned, q.t: q.x0 / q.v0 * q.time_passed}  # states that only terms and events watch
_TORQUE = q.m * q.a**2 * q.rate_scale * q.v0 / q.x0
FORCES = {"gap": INERTIA, "rotation": _TORQUE, "spin": _TORQUE}
"""The scale of a force on each coordinate."""
_SYMBOLS = {"gap": (Q_x, M_x), "rotation": (Q_beta, M_beta), "spin": (Q_spin, M_spin)}
_FORCE = {on: sp.Symbol(f"own_force_on_{on}", real=True) for on in VELOCITIES}
_SHARE = {on: sp.Symbol(f"own_inertia_of_{on}", nonnegative=True) for on in VELOCITIES}
_AT_REST = sp.Symbol("own_force_at_rest", real=True)
NAMES = (*_FORCE.values(), *_SHARE.values(), _AT_REST)


@cache
def _bodies() -> Mapping[str, sp.Expr]:
    """The inertia of the spheres for each coordinate."""
    return {"gap": q.m, "rotation": q.m * q.r**2, "spin": 2 * sphere_inertia()}


def settled(label: str, value: sp.Expr, structure: Structure) -> sp.Expr:
    """An expression without dimension, in SI, in the states and groups of a structure."""
    clocks = CLOCKS | ({q.beta: q.beta} if structure.strings else {})  # there it is a state of the library
    value = value.xreplace(clocks if structure.oblique else clocks | STILL)
    rules = to_groups(CENTRES if structure.partner == "pair" else EQUAL)
    for _ in range(3):
        value = value.xreplace(rules)
    return cancelled(label, sp.Add(*map(_simplified, sp.Add.make_args(sp.expand(value)))), value)


_simplified = cache(sp.simplify)  # structures of one model have most terms in common


def clocks(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """The states that terms watch beside the motion: the angle turned, where it is no state of the library."""
    terms = structure.terms
    watched = terms is not None and structure.oblique and not structure.strings and q.beta in terms.symbols
    return {q.angle_turned: sp.Integer(0)} if watched else {}


def _scaled(structure: Structure) -> Mapping[str, tuple[sp.Expr, sp.Expr]]:
    """Force over its scale, and inertia over that of the spheres, by coordinate."""
    assert structure.terms is not None
    present = structure.terms.parts if structure.oblique else {"gap": structure.terms.parts["gap"]}
    return {
        on: (
            settled(f"force_on {on}", force / FORCES[on], structure),
            settled(f"energy, inertia of the {on}", inertia / _bodies()[on], structure),
        )
        for on, (inertia, force) in present.items()
    }


def definitions(structure: Structure) -> tuple[Definition, ...]:
    """Forces and inertia by name, those that are not zero; the force on the gap also without velocity."""
    if structure.terms is None:
        return ()
    result: list[Definition] = []
    for on, (force, share) in _scaled(structure).items():
        result += [(_FORCE[on], force)] if force != 0 else []
        result += [(_SHARE[on], share)] if share != 0 else []
        if on == "gap" and (still := force.subs(q.normal_velocity, 0)) != force:
            result.append((_AT_REST, still))
    return tuple(result)


def named(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """The symbols of the equations of motion by these names: forces in their scale, and inertia."""
    defined = {symbol for symbol, _ in definitions(structure)}
    result: dict[sp.Symbol, sp.Expr] = {}
    for on, (force, inertia) in _SYMBOLS.items():
        result[force] = FORCES[on] * _FORCE[on] if _FORCE[on] in defined else sp.S.Zero
        result[inertia] = _bodies()[on] * _SHARE[on] if _SHARE[on] in defined else sp.S.Zero
    return result


def mass(structure: Structure) -> sp.Expr:
    """The inertia of the motion along the line of centres, over m."""
    added = named(structure)[M_x] if structure.terms is not None else sp.S.Zero
    return 1 + sp.sympify(added / q.m)


def at_rest(structure: Structure, expression: sp.Expr) -> sp.Expr:
    """An expression with the force on the gap as it is without normal velocity."""
    moving = _AT_REST in dict(definitions(structure))
    return expression.subs(_FORCE["gap"], _AT_REST) if moving else expression


def stored(structure: Structure) -> dict[str, sp.Expr]:
    """The declared energy of the state over m v0^2; nothing without one."""
    terms = structure.terms
    value = settled("energy", terms.stored / (q.m * q.v0**2), structure) if terms is not None else sp.S.Zero
    return {"own_energy": value} if value != 0 else {}


def taken(structure: Structure) -> dict[str, sp.Expr]:
    """The energy that declared forces take per x0/v0, over m v0^2; nothing without any."""
    terms = structure.terms
    value = settled("force_on", -terms.power * q.x0 / (q.m * q.v0**3), structure) if terms is not None else sp.S.Zero
    return {"own_work": value} if value != 0 else {}


def orbital_inertia(structure: Structure | None) -> sp.Expr | None:
    """The share of the orbital momentum of a declared inertia of the rotation, if it varies with the gap; or None."""
    if structure is None or structure.terms is None:
        return None
    share = dict(definitions(structure)).get(_SHARE["rotation"])
    return share if share is not None and q.gap in share.free_symbols else None
