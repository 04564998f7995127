"""Dimensions of every SI equation, the number of dimensionless groups, and the paper's groups."""

from collections.abc import Mapping

import sympy as sp

from ..laws import LAWS, film, shear
from ..physics import mechanics, scaling
from ..physics import pendulum as strings
from ..physics.forces import FILM, SHEAR, force_laws
from ..vocabulary import quantities as q
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
from .base import Check, Evidence, check, checks, readable, vanishing

Equations = dict[str, tuple[sp.Expr, Dimension]]


def si_equations() -> dict[str, Equations]:
    """Every SI expression of the model by room and name, with its expected dimension."""
    motion = mechanics.equations_of_motion()
    moment = MASS * LENGTH**2
    moving: Equations = {
        "inertia of a sphere": (mechanics.sphere_inertia(), moment),
        "inertia of the doublet": (mechanics.doublet_inertia(), moment),
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
        normal, sideways = mechanics.string_forces(potential, strings.r, q.beta)
        pendulum |= {f"U_s, {name}": (potential, ENERGY)}
        pendulum |= {f"S_n, {name}": (normal, FORCE), f"S_t, {name}": (sideways, FORCE)}
    lengths: Equations = {
        "elastic compliance": (scaling.elastic_compliance(), ONE / PRESSURE),
        "elastic length": (scaling.elastic_length(), LENGTH),
        "rupture distance": (scaling.rupture_distance(), LENGTH),
    }
    return {
        "mechanics": moving,
        "lubrication": lubrication,
        "strings": pendulum,
        "elastic length and rupture": lengths,
        "forces as the laws fill them": {
            s.name: (e, LENGTH if s == mechanics.arm else FORCE) for s, e in force_laws().items()
        },
        "start": {symbol.name: (value, q.DIMENSIONS[symbol]) for symbol, value in scaling.start_values().items()},
        "groups": {symbol.name: (definition, ONE) for symbol, definition in scaling.group_definitions().items()},
    }


def symbol_dimensions() -> dict[sp.Basic, Dimension]:
    """Dimensions of the vocabulary and of further names in the SI equations."""
    forces = dict.fromkeys(
        (mechanics.F_n, mechanics.F_c, mechanics.F_w, mechanics.F_t, mechanics.S_n, mechanics.S_t), FORCE
    )
    thicknesses = sp.symbols("h h_outer", positive=True)  # local, and the outer thickness of the tangential logarithm
    lengths = dict.fromkeys((mechanics.arm, strings.r, *thicknesses), LENGTH)
    return {**q.DIMENSIONS, **forces, **lengths, FILM: ONE, SHEAR: ONE}


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


def _dimensional(symbols: set[sp.Basic]) -> list[sp.Symbol]:
    """The symbols that have a dimension, in the order of the vocabulary."""
    return [s for s, dimension in q.DIMENSIONS.items() if s in symbols and any(dimension.exponents)]


@check("centrifugal number", "Ce = (pi/8) (x0/a) tan^2(theta0) St Ca")
def centrifugal_number() -> Evidence:
    """Ce is a function of the other groups if the angle is counted among them."""
    by_groups = scaling.nondimensional(scaling.group_definitions()[q.centrifugal].subs(sp.tan(q.theta0), q.obliquity))
    yield by_groups - sp.pi / 8 * q.aspect * q.obliquity**2 * q.stokes * q.capillary
    yield f"Ce = {by_groups}"


@check("paper's normalisation", "m r omega^2/(a sigma) = Ce (4 + x/a) (omega/omega0)^2")
def normalisation_of_the_paper() -> Evidence:
    """The centrifugal term over a sigma is Ce times a function of the state alone."""
    term = (q.m * q.r * q.omega**2 / (q.a * q.sigma)).subs(q.m, q.centrifugal * q.sigma / q.omega0**2)
    yield term - q.centrifugal * (4 + q.x / q.a) * (q.omega / q.omega0) ** 2


@check("number of groups", "groups = dimensional quantities - rank of their dimension matrix (density included)")
def number_of_groups() -> Evidence:
    """Buckingham: as many independent groups as quantities minus the rank of their dimension matrix."""
    groups = scaling.group_definitions().values()
    used = set().union(*(group.free_symbols for group in groups))
    quantities = _dimensional(used - {q.t, q.x, q.u, q.omega, q.xi, q.omega0})
    dimensions = scaling.dimension_matrix(quantities)
    # exponent of a quantity in a group: d ln(group)/d ln(quantity)
    powers = sp.Matrix([[sp.simplify(group.diff(s) * s / group) for s in quantities] for group in groups])
    independent, rank = powers.rank(), dimensions.rank()
    yield sp.Integer(independent - (len(quantities) - rank))
    yield from dimensions * powers.T
    yield f"{independent} = {len(quantities)} - {rank}"


@checks
def groups_span_the_nullspace() -> Check:
    """St, Ca and Ce are combinations of the dimensionless monomials of their quantities (nullspace)."""
    residuals, texts = [], []
    for group, label in ((q.stokes, "St"), (q.capillary, "Ca"), (q.centrifugal, "Ce")):
        definition = scaling.group_definitions()[group]
        used = _dimensional(definition.free_symbols)
        powers = sp.Matrix([sp.simplify(definition.diff(s) * s / definition) for s in used])
        basis = scaling.dimension_matrix(used).nullspace()
        residuals.append(sp.Integer(sp.Matrix.hstack(*basis, powers).rank() - len(basis)))
        texts.append(f"{label} = {readable(definition)}")
    return vanishing(
        "St, Ca, Ce", "each in the span of the nullspace of its dimension matrix", residuals, "; ".join(texts)
    )


@check("paper's groups", "St = m v0/(6 pi mu a^2), Ca = 3 mu a v0/(sigma x0), Ce = m omega0^2/sigma")
def groups_are_the_papers() -> Evidence:
    """St, Ca and Ce as ratios of terms are the paper's numbers, Ce with omega0 = v0 tan(theta0)/(4a)."""
    expected = {
        q.stokes: q.m * q.v0 / (6 * sp.pi * q.mu * q.a**2),
        q.capillary: 3 * q.mu * q.a * q.v0 / (q.sigma * q.x0),
        q.centrifugal: q.m * (q.v0 * sp.tan(q.theta0) / (4 * q.a)) ** 2 / q.sigma,
    }
    yield from [scaling.group_definitions()[group] - value for group, value in expected.items()]
