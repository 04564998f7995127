"""Emitted functions besides the right-hand side, against SI definitions: resting contact, events, momentum, outputs."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from ..equations.events import CONTACT_GAPS
from ..equations.model import Model, derive
from ..physics.forces import FILM, SHEAR, force_laws
from ..physics.laws import LAWS
from ..physics.mechanics import F_t, equations_of_motion, sphere_inertia
from ..physics.scaling import group_definitions, nondimensional
from ..physics.structure import Structure, structures
from ..vocabulary.quantities import (
    E,
    R,
    a,
    aspect,
    beta,
    contact_angle,
    gap,
    impact_spin,
    initial_spin,
    m,
    mu,
    normal_velocity,
    nu,
    omega,
    omega0,
    orbital_momentum,
    p_gt,
    r,
    rate_scale,
    spin,
    u,
    v0,
    volume,
    x,
    x0,
    x_b,
    xi,
)
from .base import Check, vanishing
from .closed import emitted_rates, filled

_FREE = Structure(oblique=True, bridge=False, strings=False)
_MIDGAP = {"arm": LAWS["arm"]["midgap"], "shear": LAWS["shear"]["immersed"]}


def _value(model: Model, function: str, name: str) -> sp.Expr:
    return model.expanded(model[function][name])


def resting_is_held() -> Check:
    """In resting contact the rotation goes on as in motion with u = 0, and the gap is held."""
    left = []
    for structure in structures():
        if not structure.oblique:
            continue
        model = derive(structure)
        for state, rate in emitted_rates(model).items():
            moving = sp.Integer(0) if state in (gap, normal_velocity) else rate.subs(normal_velocity, 0)
            left.append(_value(model, "resting_rates", state.name) - moving)
    return vanishing("resting contact", "rates at rest = rates in motion with u = 0 and du/dt = 0", left)


def inward_is_minus_the_acceleration() -> Check:
    """The inward force that keeps a doublet in contact is minus m du/dt without the film."""
    left = []
    for structure in structures():
        model = derive(structure)
        inward = -emitted_rates(model)[normal_velocity].subs(FILM, 0)
        left.append(_value(model, "inward_force", "inward_force") - inward)
        if "release" in model["events"].by_name:
            left.append(_value(model, "events", "release") - inward)
    return vanishing("inward force", "inward force = -m du/dt without the film; `release` is where it turns", left)


def momentum_is_the_bodies() -> Check:
    """The emitted angular momentum is 1 + the change of L = m (r^2 omega + (32/5) a^2 xi) over its first size."""
    whole = equations_of_motion().angular_momentum
    orbital, spun = (whole.coeff(rate) * rate for rate in (omega, xi))
    first = {x: x0, omega: omega0, xi: impact_spin}
    parts = [_per_unit(part.subs(first)) for part in (orbital, spun)]
    expected = 1 + (_per_unit(whole) - sum(parts)) / sum(sp.Abs(part) for part in parts)
    left = []
    for structure in structures():
        if structure.oblique and not structure.reduced:
            model = derive(structure)
            left.append(_value(model, "angular_momentum", "angular_momentum") - model.expanded(expected))
    return vanishing("emitted angular momentum", "1 + (L(t) - L(0))/|L(0)|, L = m [r^2 omega + (32/5) a^2 xi]", left)


def _per_unit(momentum: sp.Expr) -> sp.Expr:
    """An angular momentum over m a^2 Omega; spins at initial contact in their scale."""
    return nondimensional(sp.expand(momentum.subs(impact_spin, rate_scale * initial_spin) / (m * a**2 * rate_scale)))


def outputs_are_the_definitions() -> Check:
    """e_n = u/v0, e_t = r omega/(r0 omega0), and both rates over their scale."""
    defined = {
        "restitution": u / v0,
        "tangential_restitution": r * omega / (r.subs(x, x0) * omega0),
        "final_rotation_rate": omega / rate_scale,
        "final_spin": xi / rate_scale,
    }
    scaled = {name: nondimensional(value) for name, value in defined.items()}
    left = []
    for structure in structures():
        model = derive(structure)
        left += [model.expanded(value) - model.expanded(scaled[name]) for name, value in model["outputs"].outputs]
    return vanishing("outputs", "e_n = u/v0, e_t = r omega/(r0 omega0), rates over Omega", left)


def _si_events() -> dict[str, sp.Expr]:
    """The events as stated in the paper, over their emitted scales; x_f is not among them."""
    compliance = 2 * (1 - nu**2) / (sp.pi * E)
    elastic = (3 * sp.pi * compliance * mu * sp.sqrt(a) ** 3 * v0 / sp.sqrt(2)) ** sp.Rational(2, 5)
    definitions = group_definitions()
    by_group = {word: x / x0 - definitions[limit] for word, limit in CONTACT_GAPS.items()}  # without a published form
    return by_group | {
        "glass": (p_gt - 3 * mu * a * (-u) / x**2) * x0**2 / (3 * mu * a * v0),
        "elastic": (x - elastic) / x0,
        "rough": (x - x_b) / x0,
        "turning": u / v0,
        "film_edge": (x0 - x) / x0,
        "tangential_edge": (2 * a - x) / x0,
        "half_turn": sp.pi - beta,
        "unwinding": orbital_momentum,
    }


def events_are_the_definitions(those: Iterable[Structure] | None = None) -> Check:
    """Every event function, with the groups' definitions, is the criterion in SI; of all structures, or of these."""
    back = {gap: x / x0, normal_velocity: u / v0, **group_definitions()}
    laws = {"glass": LAWS["glass"]["literal"], "shear": LAWS["shear"]["immersed"]}
    defined = _si_events()
    left = []
    for structure in structures() if those is None else those:
        model = derive(structure)
        end = 2 * a * volume ** sp.Rational(1, 3) * (1 + contact_angle / 2) if structure.bridge else x0
        expected = {**defined, "rupture": (end - x) / x0}
        for name, value in model["events"].outputs:
            if name != "release":  # `inward_is_minus_the_acceleration` covers it
                own = filled(model.expanded(value), laws).subs(back, simultaneous=True)
                left.append((own - expected[name]).subs(R, 2 * a))
    return vanishing("events", "glass, elastic, rough, rupture and the rest = their SI definitions", left)


def tangential_force_is_the_published() -> Check:
    """F_t = 8 pi mu a^2 (omega - xi) ln(2a/x), in SI and as the torque on a sphere in the emitted equations."""
    published = 8 * sp.pi * mu * a**2 * (omega - xi) * sp.log(2 * a / x)
    force = filled(force_laws()[F_t], _MIDGAP).subs(SHEAR, 1)
    spun = published * r / 2 / sphere_inertia() * x0 / (v0 * rate_scale)
    model = derive(_FREE)
    emitted = filled(emitted_rates(model)[spin], _MIDGAP).subs(SHEAR, 1)
    slip = nondimensional((omega - xi) / rate_scale)
    factor = nondimensional(spun / ((omega - xi) / rate_scale) / sp.log(2 * a / x))
    logarithm = sp.log(2 * a / x).subs(x, gap * x0).subs(x0, a * aspect)
    left = [sp.expand_log(force - published, force=True), emitted - model.expanded(slip * factor) * logarithm]
    return vanishing("tangential force", "F_t = 8 pi mu a^2 (omega - xi) ln(2a/x), (16/5) m a^2 dxi/dt = F_t r/2", left)


def emitted() -> tuple[Check, ...]:
    """Every check of the functions other than the right-hand side."""
    return (
        resting_is_held(),
        inward_is_minus_the_acceleration(),
        momentum_is_the_bodies(),
        outputs_are_the_definitions(),
        events_are_the_definitions(),
        tangential_force_is_the_published(),
    )
