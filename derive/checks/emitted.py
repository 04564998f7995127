"""Emitted functions besides the right-hand side, against SI definitions: resting contact, events, momentum, outputs."""

from collections.abc import Iterable

import sympy as sp

from ..equations.events import CONTACT_GAPS
from ..equations.model import Model, derive
from ..laws import LAWS, filled
from ..physics.forces import FILM, SHEAR, force_laws
from ..physics.mechanics import F_t, equations_of_motion, sphere_inertia
from ..physics.scaling import group_definitions, nondimensional
from ..physics.structure import FREE, Structure, structures
from ..vocabulary import quantities as q
from .base import MIDGAP, Evidence, check, models

_IMMERSED = MIDGAP | {"shear": LAWS["shear"]["immersed"]}


def _value(model: Model, function: str, name: str) -> sp.Expr:
    return model.expanded(model[function][name])


@check("resting contact", "rates at rest = rates in motion with u = 0 and du/dt = 0")
def resting_is_held() -> Evidence:
    """In resting contact of the paper's structures the rotation has the rates of motion at u = 0; the gap is held."""
    for model in models(lambda structure: structure.oblique):
        for state, rate in model.by_state("right_hand_side").items():
            moving = sp.Integer(0) if state in (q.gap, q.normal_velocity) else rate.subs(q.normal_velocity, 0)
            yield _value(model, "resting_rates", state.name) - moving


@check("inward force", "inward force = -m du/dt without the film; `release` is where it turns")
def inward_is_minus_the_acceleration() -> Evidence:
    """The inward force that keeps a doublet in contact is minus m du/dt without the film."""
    for model in models():
        inward = -model.by_state("right_hand_side")[q.normal_velocity].subs(FILM, 0)
        yield _value(model, "inward_force", "inward_force") - inward
        if "release" in model["events"].by_name:
            yield _value(model, "events", "release") - inward


@check("emitted angular momentum", "1 + (L(t) - L(0))/|L(0)|, L = m [r^2 omega + (32/5) a^2 xi]")
def momentum_is_the_bodies() -> Evidence:
    """The emitted angular momentum is 1 + the change of L = m (r^2 omega + (32/5) a^2 xi) over its first size."""
    whole = equations_of_motion().angular_momentum
    orbital, spun = (whole.coeff(rate) * rate for rate in (q.omega, q.xi))
    first = {q.x: q.x0, q.omega: q.omega0, q.xi: q.impact_spin}
    parts = [_per_unit(momentum.subs(first)) for momentum in (orbital, spun)]
    expected = 1 + (_per_unit(whole) - sum(parts)) / sum(sp.Abs(term) for term in parts)
    for model in models(lambda s: s.oblique and not s.reduced):
        yield _value(model, "angular_momentum", "angular_momentum") - model.expanded(expected)


def _per_unit(momentum: sp.Expr) -> sp.Expr:
    """An angular momentum over m a^2 Omega; spins at initial contact in their scale."""
    scaled = momentum.subs(q.impact_spin, q.rate_scale * q.initial_spin)
    return nondimensional(sp.expand(scaled / (q.m * q.a**2 * q.rate_scale)))


@check("outputs", "e_n = u/v0, e_t = r omega/(r0 omega0), rates over Omega")
def outputs_are_the_definitions() -> Evidence:
    """e_n = u/v0, e_t = r omega/(r0 omega0), and both rates over their scale."""
    defined = {
        "restitution": q.u / q.v0,
        "tangential_restitution": q.r * q.omega / (q.r.subs(q.x, q.x0) * q.omega0),
        "final_rotation_rate": q.omega / q.rate_scale,
        "final_spin": q.xi / q.rate_scale,
    }
    scaled = {name: nondimensional(value) for name, value in defined.items()}
    for model in models():
        yield from [model.expanded(value) - model.expanded(scaled[name]) for name, value in model["outputs"].outputs]


def _si_events() -> dict[str, sp.Expr]:
    """The events as stated in the paper, over their emitted scales; x_f is not among them."""
    compliance = 2 * (1 - q.nu**2) / (sp.pi * q.E)
    elastic = (3 * sp.pi * compliance * q.mu * sp.sqrt(q.a) ** 3 * q.v0 / sp.sqrt(2)) ** sp.Rational(2, 5)
    definitions = group_definitions()
    by_group = {word: q.x / q.x0 - definitions[limit] for word, limit in CONTACT_GAPS.items()}
    return by_group | {  # in their published form, where there is one
        "glass": (q.p_gt - 3 * q.mu * q.a * (-q.u) / q.x**2) * q.x0**2 / (3 * q.mu * q.a * q.v0),
        "elastic": (q.x - elastic) / q.x0,
        "rough": (q.x - q.x_b) / q.x0,
        "turning": q.u / q.v0,
        "film_edge": (q.x0 - q.x) / q.x0,
        "tangential_edge": (2 * q.a - q.x) / q.x0,
        "half_turn": sp.pi - q.beta,
        "unwinding": q.orbital_momentum,
    }


@check("events", "glass, elastic, rough, rupture and the rest = their SI definitions")
def events_are_the_definitions(chosen: Iterable[Structure] | None = None) -> Evidence:
    """Every event function, with the groups' definitions, is the criterion in SI; of all structures, or of these."""
    back = {q.gap: q.x / q.x0, q.normal_velocity: q.u / q.v0, **group_definitions()}
    laws = {"glass": LAWS["glass"]["literal"], "shear": LAWS["shear"]["immersed"]}
    defined = _si_events()
    for structure in structures() if chosen is None else chosen:
        model = derive(structure)
        end = 2 * q.a * q.volume ** sp.Rational(1, 3) * (1 + q.contact_angle / 2) if structure.bridge else q.x0
        expected = {**defined, "rupture": (end - q.x) / q.x0}
        for name, value in model["events"].outputs:
            if name in expected:  # not a release, which `inward_is_minus_the_acceleration` covers
                emitted = filled(model.expanded(value), laws).subs(back, simultaneous=True)
                yield (emitted - expected[name]).subs(q.R, 2 * q.a)


@check("tangential force", "F_t = 8 pi mu a^2 (omega - xi) ln(2a/x), (16/5) m a^2 dxi/dt = F_t r/2")
def tangential_force_is_the_published() -> Evidence:
    """F_t = 8 pi mu a^2 (omega - xi) ln(2a/x), in SI and as the torque on a sphere in the emitted equations."""
    published = 8 * sp.pi * q.mu * q.a**2 * (q.omega - q.xi) * sp.log(2 * q.a / q.x)
    force = filled(force_laws()[F_t], _IMMERSED).subs(SHEAR, 1)
    spun = published * q.r / 2 / sphere_inertia() * q.x0 / (q.v0 * q.rate_scale)
    model = derive(FREE)
    emitted = filled(model.by_state("right_hand_side")[q.spin], _IMMERSED).subs(SHEAR, 1)
    slip = nondimensional((q.omega - q.xi) / q.rate_scale)
    factor = nondimensional(spun / ((q.omega - q.xi) / q.rate_scale) / sp.log(2 * q.a / q.x))
    logarithm = sp.log(2 * q.a / q.x).subs(q.x, q.gap * q.x0).subs(q.x0, q.a * q.aspect)
    yield from (sp.expand_log(force - published, force=True), emitted - model.expanded(slip * factor) * logarithm)
