"""What must hold of the derivation: dimensions, conservation laws, limits between structures, and the groups.

Every check works on the expressions that are emitted (or on the SI equations they come from), symbolically: a check
that holds, holds for all values. `symbolic_checks` runs them all.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp
from sympy.core.function import AppliedUndef

from .dimensions import (
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
from .laws import LAWS, Law, fill, film, shear, slot_call, strings
from .laws.base import is_slot_call
from .laws.reversal import elastic_compliance, elastic_length
from .laws.rupture import rupture_distance
from .laws.start import start_values
from .mechanics import (
    F_c,
    F_n,
    F_t,
    S_n,
    S_t,
    arm,
    doublet_inertia,
    equations_of_motion,
    sphere_inertia,
    string_forces,
)
from .model import FILM, SHEAR, Model, derive, force_laws
from .quantities import (
    DIMENSIONS,
    VOCABULARY,
    a,
    aspect,
    beta,
    capillary,
    centrifugal,
    gap,
    m,
    obliquity,
    omega,
    omega0,
    opening,
    orbit,
    r,
    spin,
    stokes,
    u,
    v0,
    x,
    x0,
    xi,
)
from .quantities import t as time
from .scaling import centrifugal_identity, dimension_matrix, group_definitions, nondimensional, paper_normalisation
from .structure import Structure, structures

_FULL = tuple(structure for structure in structures() if not structure.reduced)
_FREE_SPINNING = tuple(s for s in _FULL if s.oblique and not s.strings)  # where nothing exerts a torque


@dataclass(frozen=True)
class Check:
    """A statement about the derivation, whether it holds, and what was found."""

    name: str
    statement: str
    ok: bool
    figure: str


def symbolic_checks() -> tuple[Check, ...]:
    """Every check, in the order of the derivation."""
    return (
        *dimension_checks(),
        inertia_is_rigid_rotation(),
        *strings_are_conservative(),
        *angular_momentum(),
        *energy(),
        reduced_is_full(),
        head_on_is_oblique_at_rest(),
        least_energy(),
        centrifugal_number(),
        normalisation_of_the_paper(),
        number_of_groups(),
    )


# Dimensions


Equations = dict[str, tuple[sp.Expr, Dimension]]


def si_equations() -> dict[str, Equations]:
    """Every SI expression of the model by room and name, with the dimension it must have."""
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
    """Dimensions of the vocabulary and of the names that the SI equations use beside it."""
    forces = dict.fromkeys((F_n, F_c, F_t, S_n, S_t), FORCE)
    thicknesses = sp.symbols("h h_outer", positive=True)  # local, and where the tangential logarithm ends
    lengths = dict.fromkeys((arm, strings.r, *thicknesses), LENGTH)
    return {**DIMENSIONS, **forces, **lengths, FILM: ONE, SHEAR: ONE}


def dimension_checks(rooms: Mapping[str, Equations] | None = None) -> tuple[Check, ...]:
    """One check a room of `si_equations`: each equation homogeneous in every term, and of the dimension expected."""
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


# Mechanics


def inertia_is_rigid_rotation() -> Check:
    """I(x), by the parallel-axis theorem, is what the kinetic energy says of a doublet that turns as one body."""
    rigid = equations_of_motion().kinetic_energy.subs({u: 0, xi: omega})
    left = sp.expand(2 * rigid / omega**2 - doublet_inertia())
    left_paper = sp.expand(doublet_inertia() - m * a**2 * ((4 + x / a) ** 2 + sp.Rational(32, 5)))
    return _zero("inertia", "I(x) = 2 T(u = 0, xi = omega)/omega^2 = m a^2 [(4 + x/a)^2 + 32/5]", [left, left_paper])


def strings_are_conservative() -> tuple[Check, ...]:
    """The strings' forces are minus the gradient of their potential, and `stiffness` twice the slope of `rise`."""
    checks = []
    forces = force_laws()
    for name, law in LAWS["strings"].items():
        normal, sideways = string_forces(strings.potential(name == "small-angle"), strings.r, beta)
        pairs = ((S_n, normal), (S_t, sideways))
        left = [
            sp.simplify(_filled(forces[force], {"strings": law}) - expected.subs(strings.r, r))
            for force, expected in pairs
        ]
        rise, stiffness = law["rise"], law["stiffness"]
        left.append(sp.simplify(2 * rise.result.diff(strings.offset_squared) - stiffness.result))
        checks.append(_zero(f"strings: {name}", "S_n = dU/dr, S_t = (1/r) dU/dbeta", left))
    return tuple(checks)


def momentum_rate(structure: Structure, laws: Mapping[str, Law]) -> sp.Expr:
    """d/dtau of orbit + (32/5) spin, the angular momentum over m a^2 omega0, along the emitted right-hand side."""
    rates = _rates(derive(structure))
    return sp.factor(sp.expand(_filled(rates[orbit] + sp.Rational(32, 5) * rates[spin], laws)))


def angular_momentum() -> tuple[Check, ...]:
    """Without strings the midgap arm conserves L identically; the surface arm loses x F_t."""
    arms = LAWS["arm"]
    conserved, surface = [], []
    for structure in _FREE_SPINNING:
        conserved.append(momentum_rate(structure, {"arm": arms["midgap"]}))
        for name in LAWS["shear"]:
            tangential = {"shear": LAWS["shear"][name]}
            conserved.append(momentum_rate(structure, {"arm": arms["midgap"], **tangential}))
            lost = nondimensional(-x * force_laws()[F_t] * x0 / (v0 * m * a**2 * omega0))
            found = momentum_rate(structure, {"arm": arms["surface"], **tangential})
            surface.append(found - derive(structure).expanded(_filled(lost, tangential)))
    shown = momentum_rate(_FREE_SPINNING[0], {"arm": arms["surface"]})
    return (
        _zero(
            "angular momentum, midgap arm", "dL/dt = 0 without strings, for every tangential and bridge law", conserved
        ),
        _zero("angular momentum, surface arm", "dL/dt = -x F_t without strings", surface, f"dL/dtau = {shown}"),
    )


def energy_balance(structure: Structure) -> sp.Expr:
    """d/dtau of the emitted energies plus the emitted energy_rates, for any laws (and either arm)."""
    model = derive(structure)
    stored = [model.expanded(expression) for _, expression in model["energies"].outputs]
    total = sum((_slope(each, state) * rate for state, rate in _rates(model).items() for each in stored), sp.Integer(0))
    lost = sum((model.expanded(expression) for _, expression in model["energy_rates"].outputs), sp.Integer(0))
    return sp.factor(sp.expand(strings.half_angles(total + lost)))


def energy() -> tuple[Check, ...]:
    """Mechanical energy is taken by the film, the shear and the bridge, and by nothing else; strings give back."""
    return tuple(
        _zero(
            f"energy: {structure.name}",
            "d(kinetic + strings)/dt = -(film + shear + bridge power), for all laws and both arms",
            [energy_balance(structure)],
        )
        for structure in _FULL
    )


# Structures against each other


def reduced_is_full() -> Check:
    """With the spin that a conserved L leaves, the full equations are the reduced ones, and so is the spin's rate."""
    left = []
    midgap = {"arm": LAWS["arm"]["midgap"]}
    for structure in structures():
        if not structure.reduced:
            continue
        reduced, full = derive(structure), derive(Structure(True, structure.bridge, False))
        initial = (4 + aspect) ** 2  # L/(m a^2 omega0) at first touch, where nothing spins
        eliminated = {spin: (initial - orbit) * sp.Rational(5, 32)}
        rates, full_rates = _rates(reduced), _rates(full)
        left += [_filled(full_rates[s], midgap).subs(eliminated) - rate for s, rate in rates.items()]
        # the spin eliminated turns as the full equations say it does
        left.append(eliminated[spin].diff(orbit) * rates[orbit] - _filled(full_rates[spin], midgap).subs(eliminated))
        for name in ("events", "energies", "outputs", "effective_potential", "inward_force", "turning_rate", "start"):
            of_full = dict(full[name].outputs)
            for key, expression in reduced[name].outputs:
                left.append(full.expanded(of_full[key]).subs(eliminated) - reduced.expanded(expression))
    return _zero("reduced form", "full equations with xi = (L - m r^2 omega)/((32/5) m a^2) are the reduced ones", left)


def head_on_is_oblique_at_rest() -> Check:
    """An oblique doublet that does not rotate is the head-on one, and does not start to rotate."""
    still = {orbit: 0, spin: 0, beta: 0}
    left = []
    for head_on in _FULL:
        if head_on.oblique:
            continue
        narrow, wide = derive(head_on), derive(Structure(True, head_on.bridge, head_on.strings))
        rates = _rates(wide)
        left += [rates[s].subs(still) - rate for s, rate in _rates(narrow).items()]
        left += [rates[s].subs(still) for s in wide.states if s not in narrow.states]
        for name in ("events", "energies", "energy_rates", "inward_force", "effective_potential", "outputs"):
            if name not in [function.name for function in wide.functions]:
                continue  # no least-energy argument for rotating strings
            there = dict(wide[name].outputs)
            left += [
                wide.expanded(there[key]).subs(still) - narrow.expanded(value) for key, value in narrow[name].outputs
            ]
    return _zero("head-on limit", "oblique equations at zero rotation are the head-on ones", left)


def least_energy() -> Check:
    """The certificate's energy is L^2/(2 I) (and U_s), and its slope that energy's, at fixed L, and the bridge's."""
    left = []
    for structure in structures():
        model = derive(structure)
        if "effective_potential" not in [function.name for function in model.functions]:
            continue
        outputs = dict(model["effective_potential"].outputs)
        value, slope = model.expanded(outputs["energy"]), model.expanded(outputs["slope"])
        momentum = sp.Symbol("L", positive=True)  # over m a^2 omega0
        inertia = (4 + aspect * gap) ** 2 + sp.Rational(32, 5)
        expected: sp.Expr = sp.Integer(0)
        change: sp.Expr = sp.Integer(0)
        if structure.oblique:
            own = orbit + sp.Rational(32, 5) * spin if not structure.reduced else (4 + aspect) ** 2
            fixed = momentum**2 * obliquity**2 / (32 * inertia)  # omega0 = v0 tan(theta0)/(4a)
            expected += fixed.subs(momentum, own)
            change += fixed.diff(gap).subs(momentum, own)
        if structure.strings:
            stored = model.expanded(dict(model["energies"].outputs)["strings"])
            expected += stored
            change += _slope(stored, gap)
        if structure.bridge:
            work = dict(model["energy_rates"].outputs)["capillary"]
            change += model.expanded(work) / opening
        left += [value - expected, slope - change]
    return _zero("stick certificate", "slope = d/dx [L^2/(2 I(x)) + U_s(x) + W_c(x)] at fixed L", left)


# Groups


def centrifugal_number() -> Check:
    """Ce depends on the other groups once the angle is counted among them."""
    expected = sp.pi / 8 * aspect * obliquity**2 * stokes * capillary
    found = centrifugal_identity()
    return _zero("centrifugal number", "Ce = (pi/8) (x0/a) tan^2(theta0) St Ca", [found - expected], f"Ce = {found}")


def normalisation_of_the_paper() -> Check:
    """The centrifugal term over a sigma is Ce times a function of the state alone."""
    expected = centrifugal * (4 + x / a) * (omega / omega0) ** 2
    return _zero(
        "paper's normalisation",
        "m r omega^2/(a sigma) = Ce (4 + x/a) (omega/omega0)^2",
        [paper_normalisation() - expected],
    )


def number_of_groups() -> Check:
    """Buckingham: the independent groups are as many as the quantities less the rank of their dimension matrix."""
    motion = {time, x, u, omega, xi, omega0}
    given = [q.symbol for q in VOCABULARY.values() if any(q.dimension.exponents) and q.symbol not in motion]
    dimensions = dimension_matrix(given)
    # exponent of a quantity in a group: d ln(group)/d ln(quantity)
    powers = sp.Matrix(
        [[sp.simplify(group.diff(s) * s / group) for s in given] for group in group_definitions().values()]
    )
    found, rank = powers.rank(), dimensions.rank()
    left = [sp.Integer(found - (len(given) - rank)), *(dimensions * powers.T)]
    statement = "groups = dimensional quantities - rank of their dimension matrix (density included)"
    return _zero("number of groups", statement, left, f"{found} = {len(given)} - {rank}")


# Tools


def _zero(name: str, statement: str, left: list[sp.Expr], figure: str = "") -> Check:
    """A check that every expression of `left` vanishes identically; the first that does not is the figure."""
    rest = [value for value in map(_settled, left) if value != 0]
    shown = figure or (f"{len(left)} identities" if len(left) > 1 else "identity")
    return Check(name, statement, not rest, f"left over: {rest[0]}" if rest else shown)


def _settled(expression: sp.Expr) -> sp.Expr:
    """Zero if the expression vanishes identically: expanded, and simplified only where that is not enough."""
    quick = sp.expand(expression)
    if quick == 0:
        return quick
    return sp.simplify(sp.factor(quick))


def _rates(model: Model) -> dict[sp.Symbol, sp.Expr]:
    """The emitted right-hand side by state, every intermediate put back in."""
    named = dict(model["right_hand_side"].outputs)
    return {state: model.expanded(named[state.name]) for state in model.states}


def _slope(energy: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """Derivative of an energy, with d rise/d offset_squared = stiffness/2 (which strings_are_conservative checks)."""
    heights = {node: sp.Dummy("height") for node in energy.atoms(AppliedUndef) if is_slot_call(node)}
    flat = energy.xreplace(heights)
    slope = flat.diff(variable)
    for node, height in heights.items():
        slope += flat.diff(height) * slot_call("strings", "stiffness", *node.args) / 2 * node.args[1].diff(variable)
    return slope


def _filled(expression: sp.Expr, laws: Mapping[str, Law]) -> sp.Expr:
    """`fill` for the slots in `laws` alone; the others stay calls, i.e. hold for any law."""
    kept: dict[sp.Basic, sp.Basic] = {}
    for node in expression.atoms(AppliedUndef):
        if is_slot_call(node) and node.func.__name__.split(".")[0] not in laws:
            kept[node] = sp.Dummy(node.func.__name__.replace(".", "_"))
    return fill(expression.xreplace(kept), laws).xreplace({dummy: node for node, dummy in kept.items()})
