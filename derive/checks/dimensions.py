"""Dimensions: every SI equation of the model is homogeneous and has the expected dimension."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from ..physics.forces import FILM, SHEAR, force_laws
from ..physics.laws import LAWS, film, shear, strings
from ..physics.laws.elastic_length import elastic_compliance, elastic_length
from ..physics.laws.rupture import rupture_distance
from ..physics.laws.start import start_values
from ..physics.mechanics import (
    F_c,
    F_n,
    F_t,
    F_w,
    S_n,
    S_t,
    arm,
    doublet_inertia,
    equations_of_motion,
    sphere_inertia,
    string_forces,
)
from ..physics.scaling import group_definitions
from ..vocabulary.dimensions import (
    ENERGY,
    FORCE,
    LENGTH,
    MASS,
    ONE,
    PRESSURE,
    RATE,
    TIME,
    Dimension,
    DimensionError,
    demand_dimension,
)
from ..vocabulary.quantities import DIMENSIONS, beta
from .base import Check, checks

Equations = dict[str, tuple[sp.Expr, Dimension]]


def si_equations() -> dict[str, Equations]:
    """Every SI expression of the model by room and name, with its expected dimension."""
    motion = equations_of_motion()
    moment = MASS * LENGTH**2
    mechanics: Equations = {
        "inertia of a sphere": (sphere_inertia(), moment),
        "inertia of the doublet": (doublet_inertia(), moment),
        "kinetic energy": (motion.kinetic_energy, ENERGY),
        "du/dt": (motion.separation_acceleration, LENGTH / TIME**2),
        "domega/dt": (motion.orbital_acceleration, RATE / TIME),
        "dxi/dt": (motion.spin_acceleration, RATE / TIME),
        "orbital momentum": (motion.orbital_momentum, moment / TIME),
        "orbital momentum rate": (motion.orbital_momentum_rate, moment / TIME**2),
        "spin momentum": (motion.spin_momentum, moment / TIME),
        "angular momentum": (motion.angular_momentum, moment / TIME),
    }
    lubrication: Equations = {
        "film pressure": (film.pressure(), PRESSURE),
        "film pressure on the axis": (film.axis_pressure(), PRESSURE),
        "film force": (film.normal_force(), FORCE),
        "shear force": (shear.tangential_force(), FORCE),
    }
    pendulum: Equations = {}
    for name in LAWS["strings"]:
        potential = strings.potential(name == "small-angle")
        normal, sideways = string_forces(potential, strings.r, beta)
        pendulum |= {
            f"U_s, {name}": (potential, ENERGY),
            f"S_n, {name}": (normal, FORCE),
            f"S_t, {name}": (sideways, FORCE),
        }
    lengths: Equations = {
        "elastic compliance": (elastic_compliance(), ONE / PRESSURE),
        "elastic length": (elastic_length(), LENGTH),
        "rupture distance with a bridge": (rupture_distance(bridge=True), LENGTH),
        "rupture distance without": (rupture_distance(bridge=False), LENGTH),
    }
    return {
        "mechanics": mechanics,
        "lubrication": lubrication,
        "strings": pendulum,
        "elastic length and rupture": lengths,
        "forces as the laws fill them": {s.name: (e, LENGTH if s == arm else FORCE) for s, e in force_laws().items()},
        "start": {symbol.name: (value, DIMENSIONS[symbol]) for symbol, value in start_values().items()},
        "groups": {symbol.name: (definition, ONE) for symbol, definition in group_definitions().items()},
    }


def symbol_dimensions() -> dict[sp.Basic, Dimension]:
    """Dimensions of the vocabulary and of further names in the SI equations."""
    forces = dict.fromkeys((F_n, F_c, F_w, F_t, S_n, S_t), FORCE)
    thicknesses = sp.symbols("h h_outer", positive=True)  # local, and the outer thickness of the tangential logarithm
    lengths = dict.fromkeys((arm, strings.r, *thicknesses), LENGTH)
    return {**DIMENSIONS, **forces, **lengths, FILM: ONE, SHEAR: ONE}


@checks
def dimension_checks(rooms: Mapping[str, Equations] | None = None) -> tuple[Check, ...]:
    """One check per room of `si_equations`: each equation is homogeneous and has the expected dimension."""
    dimensions = symbol_dimensions()
    checks = []
    for room, equations in (si_equations() if rooms is None else rooms).items():
        errors = []
        for name, (expression, expected) in equations.items():
            try:
                demand_dimension(name, expression, expected, dimensions, slots=lambda _: ONE)
            except DimensionError as error:
                errors.append(str(error))
        statement = "every term of every equation has the dimension it must have"
        figure = "; ".join(errors) or f"{len(equations)} equations"
        checks.append(Check(f"dimensions: {room}", statement, not errors, figure))
    return tuple(checks)
