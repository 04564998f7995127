"""The derivation arrives at the published equations (retyped here), symbol for symbol."""

import pytest
import sympy as sp
from wetdoublet.derive.equations.model import Model
from wetdoublet.derive.laws import LAWS, film, glass
from wetdoublet.derive.physics import pendulum as strings
from wetdoublet.derive.physics import scaling
from wetdoublet.derive.physics.forces import FILM, SHEAR, force_laws
from wetdoublet.derive.physics.law import fill
from wetdoublet.derive.physics.mechanics import (
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
from wetdoublet.derive.physics.scaling import elastic_compliance, elastic_length, rupture_distance, start_values
from wetdoublet.derive.vocabulary import quantities as q

a, m, x, u, omega, xi = q.a, q.m, q.x, q.u, q.omega, q.xi
mu, x0, v0, sigma, beta, g, length = q.mu, q.x0, q.v0, q.sigma, q.beta, q.g, q.l_s
r = 4 * a + x
St, Ca, eps, tan0, s = q.stokes, q.capillary, q.aspect, q.obliquity, q.gap


def same(left: sp.Expr, right: sp.Expr) -> bool:
    """Whether two expressions are identically equal."""
    return sp.simplify(strings.half_angles(left) - strings.half_angles(right)) == 0


DISC_GAP = sp.Symbol("h", positive=True)
DOUBLET = m * a**2 * ((4 + x / a) ** 2 + sp.Rational(32, 5))
SWING = (strings.r**2 + 16 * a**2 - 8 * a * strings.r * sp.cos(beta)) / 4
TURNING = (r**2 * omega**2 + sp.Rational(32, 5) * a**2 * xi**2) * m / 2
THETA = 2 * (1 - q.nu**2) / (sp.pi * q.E)
PUBLISHED = {  # what the derivation has, and what is printed
    "inertia of a sphere": lambda: (sphere_inertia(), sp.Rational(2, 5) * (2 * m) * (2 * a) ** 2),
    "inertia of the doublet": lambda: (doublet_inertia(), DOUBLET),
    "kinetic energy": lambda: (equations_of_motion().kinetic_energy, m * u**2 / 2 + TURNING),
    "of a rigid doublet": lambda: (
        equations_of_motion().kinetic_energy.subs(xi, omega), m * u**2 / 2 + DOUBLET * omega**2 / 2,
    ),
    "normal equation": lambda: (  # F_w is any further attraction
        m * equations_of_motion().separation_acceleration, m * r * omega**2 - F_n - F_c - F_w - S_n,
    ),
    "orbital equation": lambda: (m * (r * equations_of_motion().orbital_acceleration + 2 * u * omega), -F_t - S_t),
    "spin equation": lambda: (sp.Rational(16, 5) * m * a**2 * equations_of_motion().spin_acceleration, F_t * arm),
    "angular momentum": lambda: (
        equations_of_motion().angular_momentum, m * (r**2 * omega + sp.Rational(32, 5) * a**2 * xi),
    ),
    "rate of its orbital part": lambda: (equations_of_motion().orbital_momentum_rate, -r * (F_t + S_t)),
    "film pressure": lambda: (film.pressure(), 3 * mu * a * (-u) * (1 / DISC_GAP**2 - 1 / x0**2)),
    "film force": lambda: (film.normal_force(), 6 * sp.pi * mu * a**2 * u / x * (1 - x / x0) ** 2),
    "film force, as it is filled in": lambda: (
        fill(force_laws()[F_n], {"film": LAWS["film"]["finite"]}).subs(FILM, 1), film.normal_force(),
    ),
    "Taylor's force of an unbounded film": lambda: (
        sp.limit(film.normal_force(), x0, sp.oo), 6 * sp.pi * mu * a**2 * u / x,
    ),
    "arm": lambda: (fill(force_laws()[arm], {"arm": LAWS["arm"]["midgap"]}), r / 2),
    "swing of either sphere": lambda: (strings.swing_squared(), SWING),
    "potential of strings": lambda: (strings.potential(False), 4 * m * g * (length - sp.sqrt(length**2 - SWING))),
    "potential at small angles": lambda: (strings.potential(True), 4 * m * g * SWING / (2 * length)),
    "normal force of strings at small angles": lambda: (
        string_forces(strings.potential(True), strings.r, beta)[0], m * g * (strings.r - 4 * a * sp.cos(beta)) / length,
    ),
    "elastic compliance": lambda: (elastic_compliance(), THETA),
    "elastic length": lambda: (
        elastic_length() ** 5, (3 * sp.pi * THETA * mu * a ** sp.Rational(3, 2) * v0 / sp.sqrt(2)) ** 2,
    ),
    "rupture distance": lambda: (
        rupture_distance(), 2 * a * q.volume ** sp.Rational(1, 3) * (1 + q.contact_angle / 2),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", PUBLISHED)
def test_it_is_as_published(name: str):
    """Inertias, energies, equations of motion, film, strings and lengths are those that are printed."""
    assert same(*PUBLISHED[name]())


@pytest.mark.parametrize(("name", "outer"), [("immersed", 2 * a), ("film", x0)])
def test_tangential_force(name: str, outer: sp.Expr):
    """F_t = 8 pi mu a^2 (omega - xi) ln(outer/x), which vanishes at its own edge and in rigid rotation."""
    found = fill(force_laws()[F_t], {"shear": LAWS["shear"][name]}).subs(SHEAR, 1)
    published = 8 * sp.pi * mu * a**2 * (omega - xi) * sp.log(outer / x)
    assert sp.simplify(sp.expand_log(found - published, force=True)) == 0
    edge = LAWS["shear"][name]["edge"](x0 / a) * x0
    assert same(edge, outer)
    assert found.subs(xi, omega) == 0


@pytest.mark.parametrize("name", ["exact", "small-angle"])
def test_string_forces(name: str):
    """S_n = m g (r - 4a cos beta)/D, S_t = m g 4a sin(beta)/D, D = sqrt(l^2 - d^2), or l for small angles."""
    swing = (r**2 + 16 * a**2 - 8 * a * r * sp.cos(beta)) / 4
    across = length if name == "small-angle" else sp.sqrt(length**2 - swing)
    laws = {"strings": LAWS["strings"][name]}
    assert same(fill(force_laws()[S_n], laws), m * g * (r - 4 * a * sp.cos(beta)) / across)
    assert same(fill(force_laws()[S_t], laws), m * g * 4 * a * sp.sin(beta) / across)


@pytest.mark.parametrize("name", ["literal", "film-corrected"])
def test_glass_criterion(name: str):
    """The axis pressure is 3 mu a |u|/x^2, or with the rim 3 mu a |u| (1/x^2 - 1/x0^2)."""
    rim = 1 / x0**2 if name == "film-corrected" else 0
    speed = sp.Symbol("U", positive=True)
    scaled = LAWS["glass"][name]["pressure"](x / x0, speed / v0)
    assert same(3 * mu * a * v0 / x0**2 * scaled, 3 * mu * a * speed * (1 / x**2 - rim))
    assert glass.approach.name == "approach"


def test_start():
    """At initial contact x = x0, u = -v0, omega = v0 tan(theta0)/(4a), xi as it arrives, beta = 0."""
    published = {x: x0, u: -v0, omega: v0 * sp.tan(q.theta0) / (4 * a), xi: q.impact_spin, beta: 0}
    assert start_values() == published


GROUPS = {
    "stokes": m * v0 / (6 * sp.pi * mu * a**2), "capillary": 3 * mu * a * v0 / (sigma * x0),
    "centrifugal": m * (v0 * sp.tan(q.theta0) / (4 * a)) ** 2 / sigma,
    "adhesion": q.A_H / (36 * sp.pi * mu * v0 * x0 * a), "reynolds": q.rho * v0 * x0 / mu, "aspect": x0 / a,
    "obliquity": sp.tan(q.theta0), "glass_number": q.p_gt * x0**2 / (3 * mu * a * v0), "weight": g * x0 / v0**2,
    "string_ratio": length / a, "rough_gap": q.x_b / x0,
    "rupture_gap": 2 * a * q.volume ** sp.Rational(1, 3) * (1 + q.contact_angle / 2) / x0,
    "elastic_gap": (6 * (1 - q.nu**2) / q.E * mu * a ** sp.Rational(3, 2) * v0 / sp.sqrt(2)) ** sp.Rational(2, 5) / x0,
}  # fmt: skip


def test_no_group_is_untested():
    """The published definitions above are those of every group there is."""
    assert GROUPS.keys() == {symbol.name for symbol in scaling.group_definitions()}


@pytest.mark.parametrize("name", GROUPS)
def test_group(name: str):
    """Each group is the published combination of SI quantities."""
    found = scaling.group_definitions()[q.VOCABULARY[name].symbol]
    assert same(found / GROUPS[name], sp.Integer(1))


def test_groups_undo_the_scaling():
    """Every SI quantity written in groups gives the group back when its definition is formed from it."""
    rules = scaling.to_groups()
    for group, definition in scaling.group_definitions().items():
        quantities = definition.free_symbols & {m, x0, sigma, q.p_gt, g, length}
        if group.name in ("centrifugal", "elastic_gap", "rough_gap", "rupture_gap", "reynolds") or not quantities:
            continue
        assert same(definition.subs(rules, simultaneous=True), group), group


def test_start_of_the_states(models: dict[str, Model]):
    """The dimensionless start is s = 1, w = -1, J = (4 + x0/a)^2 tan(theta0)/T, the spin over its scale, no angle."""
    outputs = dict(models["oblique_strings"]["start"].outputs)
    published = {"gap": 1, "normal_velocity": -1, "orbital_momentum": (4 + eps) ** 2, "spin": 0, "rotation": 0}
    unspun = {q.initial_turning: 1, q.initial_spin: 0}
    assert {name: sp.sympify(value).subs(unspun) for name, value in outputs.items()} == published
    assert (outputs["orbital_momentum"] / (4 + eps) ** 2, outputs["spin"]) == (q.initial_turning, q.initial_spin)


@pytest.mark.parametrize("name", ["oblique_bridge", "oblique_bridge_reduced"])
def test_certificate_slope(models: dict[str, Model], name: str):
    """The certificate's slope is d/ds of U_eff = L^2/(2 I(x)) + W_c(x) at fixed L, over m v0^2."""
    model = models[name]
    outputs = dict(model["effective_potential"].outputs)
    found = {key: fill(model.expanded(value), {"bridge": LAWS["bridge"]["constant"]}) for key, value in outputs.items()}
    at = x0 * s
    momentum, theta = sp.Symbol("L", positive=True), q.theta0
    inertia = m * a**2 * ((4 + at / a) ** 2 + sp.Rational(32, 5))
    work = sp.pi * 2 * a * sigma * 2 * sp.cos(q.contact_angle) * at  # of the constant law from s = 0
    level = momentum**2 / (2 * inertia) + work
    first = (4 + eps) ** 2 * q.initial_turning + sp.Rational(32, 5) * q.initial_spin
    spinning = sp.Rational(32, 5) * q.spin if name == "oblique_bridge" else first - q.orbital_momentum
    held = m * a**2 * v0 * sp.tan(theta) / (4 * a) * (q.orbital_momentum + spinning)
    groups = {St: GROUPS["stokes"], Ca: GROUPS["capillary"], eps: x0 / a, tan0: sp.tan(theta)}
    scale = m * v0**2
    assert same((level.diff(s).subs(momentum, held) / scale).subs(groups), found["slope"].subs(groups))
    assert same(((level - work).subs(momentum, held) / scale).subs(groups), found["energy"].subs(groups))
