"""Checks of the approach certificate: each of its steps, on the emitted equations."""

from dataclasses import replace

import sympy as sp

from ..equations.certificates.approach import DEEPER, GAIN, LARGEST_FORCE, LEFT, PATH, RATIO, braking
from ..equations.certificates.pendulum import PENDULUM, pull_at
from ..equations.events import contact_gap
from ..equations.intermediates import FILM_FORCE, attractions
from ..equations.model import Model, derive
from ..physics.forces import FILM
from ..physics.laws import LAWS
from ..physics.laws.base import filled
from ..physics.scaling import DISTANCE
from ..physics.structure import BRIDGED
from ..vocabulary.quantities import aspect, beta, gap, normal_velocity, obliquity, orbital_momentum, stokes
from .base import SIZES, Check, Evidence, check, checks, vanishing

_ATTRACTED = (
    replace(BRIDGED, oblique=False), BRIDGED, replace(BRIDGED, bridge=False, attraction=True),
    replace(BRIDGED, partner="pair"), replace(BRIDGED, partner="wall"),
)  # fmt: skip
_PULL, _DEPTH, _LEFT = sp.symbols("pull depth left", positive=True)


@checks
def braking_is_the_films() -> tuple[Check, ...]:
    """What a film takes from an approach is the integral of its resistance from x0."""
    checks = []
    for law in LAWS["film"].values():
        taken, resistance = (law[name](*law[name].arguments) for name in ("braking", "resistance"))
        left = [taken.diff(gap) + resistance, taken.subs(gap, 1)]
        checks.append(vanishing(f"braking: {law.name}", "dB/dx = -resistance, B(x0) = 0", left))
    return tuple(checks)


def _inward(model: Model) -> sp.Expr:
    return model.expanded(model["inward_force"]["inward_force"], SIZES)


@check("approach: closing speed", "dw/dy <= P/w - g/St, and the bound of w rises as fast")
def closing_speed() -> Evidence:
    """dw/dy = (F - C)/w - g/St with C >= 0, and both comparison functions rise at least as fast.

    Where a bound z is reached, it has to rise by P/z - g/St at least: P/left with z >= left, or P/sqrt(2 P y) with
    z >= sqrt(2 P y). At left = sqrt(P y/2) both gains agree, so that the larger denominator takes the smaller gain.
    """
    for structure in (*_ATTRACTED, PENDULUM):
        model = derive(structure)
        rate = model.expanded(model["right_hand_side"]["normal_velocity"], SIZES)
        film = model.expanded(FILM_FORCE, SIZES)
        yield rate + film + _inward(model)
        spread = braking(structure, gap)
        resistance = sp.Function("film.resistance", real=True)(*spread.args)
        yield film - FILM * normal_velocity * resistance / stokes
        if structure.strings:
            pull = _inward(model).subs(orbital_momentum, 0)
            yield pull - model.expanded(pull_at(gap, beta)).subs(DISTANCE, 4 + aspect * gap)
        else:
            still = {state: 0 for state in model.states if state != gap}
            yield _inward(model).subs(still) - model.expanded(attractions(structure, gap), SIZES)
    straight, rooted = _PULL * _DEPTH / _LEFT, sp.sqrt(2 * _PULL * _DEPTH)
    yield from (straight.diff(_DEPTH) * _LEFT - _PULL, rooted.diff(_DEPTH) * rooted - _PULL)
    yield straight.subs(_LEFT, sp.sqrt(_PULL * _DEPTH / 2)) - rooted


@check("approach: rotation", "C = 2 E_orb/r <= 2 E_rot/r, dE_rot/dx = -C + what shear takes")
def rotation_gains() -> Evidence:
    """C = -dE_orb/dx at fixed J = 2 E_orb/r, and E_rot - E_orb is a sum of squares: E_rot r^2 never grows going in."""
    squares = True
    for structure in _ATTRACTED:
        model = derive(structure)
        thrown = sp.expand(model.expanded(attractions(structure, gap), SIZES) - _inward(model))
        kinetic = model.expanded(model["energies"]["kinetic"], SIZES)
        rotating = sp.expand(kinetic - normal_velocity**2 / 2)
        if not structure.oblique or structure.partner == "wall":
            yield thrown
            continue
        distance = model.expanded(DISTANCE, SIZES)
        orbital = rotating.subs(dict.fromkeys(model.states[3:], 0))
        yield from (thrown + orbital.diff(gap), thrown - 2 * aspect * orbital / distance)
        spins = sp.Poly(sp.expand(rotating - orbital), *model.states[3:], obliquity)
        squares &= all(c.is_positive and all(n % 2 == 0 for n in powers) for powers, c in spins.terms())
    yield squares, "the energy of the spins is no sum of squares"


@check("approach: as emitted", "the step and the outward force are the bounds")
def as_emitted() -> Evidence:
    """The emitted step and outward force are these bounds."""
    for structure in (*_ATTRACTED, PENDULUM):
        model = derive(structure)
        named = dict(model.definitions)
        force, deeper = named[LARGEST_FORCE], named[DEEPER]
        whole = pull_at(sp.Integer(1), sp.pi) if structure.strings else sp.Max(attractions(structure, DEEPER), 0)
        yield from (model.expanded(force) - model.expanded(whole), deeper - gap * RATIO)
        yield named[RATIO] ** 24 - sp.Max(contact_gap, sp.Rational(1, 100))
        rest = -normal_velocity - (braking(structure, DEEPER) - braking(structure, gap)) / stokes
        work = LARGEST_FORCE * (gap - DEEPER)
        gain = work / sp.Max(rest, sp.sqrt(work / 2))
        wanted = {"deeper_gap": DEEPER, "slowed": sp.Max(rest, 0) + gain, "fastest": gain - normal_velocity}
        for name, value in wanted.items():
            result = model["approach_step"][name]
            for symbol in (GAIN, LEFT, PATH):
                result = result.subs(symbol, named[symbol])
            yield result - value
        if structure.strings:
            continue
        outward = model.expanded(model["approach_force"]["outward"], SIZES)
        thrown = sp.Integer(0)
        if structure.oblique and structure.partner != "wall":
            kinetic = model.expanded(model["energies"]["kinetic"], SIZES)
            distance = model.expanded(DISTANCE, SIZES)
            near = distance.subs(gap, contact_gap)
            thrown = 2 * aspect * (kinetic - normal_velocity**2 / 2) * distance**2 / near**3
        inner = outward.args[1] if outward.args[0] == 0 else outward.args[0]
        yield filled(inner - (thrown - model.expanded(attractions(structure, gap), SIZES)), {})
