"""Checks of the impulse bound of the pendulum certificate, on the emitted equations and definitions."""

from __future__ import annotations

import sympy as sp

from ..equations.certificates import pendulum
from ..equations.events import contact_gap
from ..equations.model import Model, derive
from ..physics.forces import SHEAR
from ..physics.laws import slot_call
from ..physics.laws.strings import offset_squared
from ..physics.scaling import DISTANCE
from ..physics.structure import Structure
from ..vocabulary.quantities import aspect, beta, gap, obliquity, orbital_momentum, spin, string_ratio, weight
from .base import Check, Evidence, check, vanishing
from .signs import positive

_PENDULUM = Structure(oblique=True, bridge=False, strings=True)
_MOMENTUM, _PULL, _RISE = sp.symbols("momentum pull rise", positive=True)
_HERE = 4 + aspect * gap


def _model() -> Model:
    return derive(_PENDULUM)


def _share(distance: sp.Expr) -> sp.Expr:
    return distance**2 / (distance**2 + sp.Rational(32, 5))


def strings_take() -> Check:
    """On the level J = J_max - s D, F_t and the strings reduce J by more than s times what the strings take.

    There J >= s L, with s the largest share: F_t reduces J, and the strings take the whole of what they take from L.
    """
    rates = _model().by_state("right_hand_side")
    log_factor = sp.Function("shear.log_factor", real=True)(gap, aspect)
    alone = sp.expand(rates[orbital_momentum].subs(log_factor, 0))
    spun = rates[spin].subs(log_factor, 0)
    torque = _model().expanded(pendulum.torque_at(gap, beta))
    shear = sp.simplify((rates[orbital_momentum] - rates[orbital_momentum].subs(log_factor, 0)) / (SHEAR * log_factor))
    slip = orbital_momentum / _HERE**2 - spin
    rest = vanishing("", "", [alone + torque, spun, rates[beta] - pendulum.turning_at(orbital_momentum, _HERE)])
    reduces = sp.simplify(-shear / slip)
    grows, below = _share(DISTANCE).diff(DISTANCE), 1 - _share(DISTANCE)
    ok = rest.ok and all(map(positive, (reduces, sp.together(grows), sp.together(below))))
    figure = f"dJ/dt = -r S_t - ({reduces}) (omega - xi)" if ok else rest.figure
    return Check("J falls with the strings' torque", "J <= J_max - s D, dD/dt = r S_t, s < 1 grows with r", ok, figure)


def torque_is_least_in_contact() -> Check:
    """r^3 S_t grows with the gap and the stiffness, which grows with the swing: least in contact, at the first angle.

    With J dD/dbeta >= S sin(beta), J^2 falls by `taken` (cos(beta_0) - cos(beta)) at least.
    """
    stiffness = slot_call("strings", "stiffness", string_ratio, offset_squared)
    (call,) = (node for node in pendulum.torque_at(gap, beta).atoms(sp.Function) if "." in str(node.func))
    per_angle = pendulum.torque_at(gap, beta).subs(call, stiffness) / pendulum.turning_at(sp.Integer(1), _HERE)
    bare = sp.simplify(per_angle / stiffness / sp.sin(beta))
    named = dict(_model().definitions)
    weighing = named[pendulum.WEIGHING] / weight
    swing = weighing.args[1].subs(beta, 2 * sp.asin(_RISE))
    in_contact = bare.subs(gap, contact_gap) * weighing.subs(named) * obliquity**2
    taken = _model().expanded(pendulum.TAKEN)
    wanted = _model().expanded(
        2 * _share(pendulum.FARTHEST) * in_contact.subs(4 + aspect * contact_gap, pendulum.NEAREST)
    )
    rest = vanishing("", "", [taken - wanted])
    ok = rest.ok and positive(bare) and positive(sp.together(bare.diff(gap))) and positive(sp.expand(swing.diff(_RISE)))
    return Check("least torque", "J^2 <= J_max^2 - 2 s r^3 S (cos(beta_0) - cos(beta))", bool(ok), f"r^3 S_t ~ {bare}")


def integrand_is_largest_in_contact() -> Check:
    """(J^2/r^3 - S_n)/(J/r^2) grows with J and falls with r and S_n, which grows with r and beta (`pull_grows`)."""
    result = (pendulum.outward_at(_MOMENTUM, DISTANCE) - _PULL) / pendulum.turning_at(_MOMENTUM, DISTANCE)
    slopes = (result.diff(_MOMENTUM), -result.diff(DISTANCE), -result.diff(_PULL))
    ok = all(positive(sp.together(slope)) for slope in slopes)
    return Check(
        "impulse by angle", "grows with J, falls with r and S_n: largest in contact", ok, str(sp.factor(result))
    )


@check("arcsine", "arcsin(z) <= z + (pi/2 - 1) z^3, equal at z = 1")
def angle_is_beyond() -> Evidence:
    """arcsin(z) <= z + (pi/2 - 1) z^3 up to z = 1, where both are equal: (arcsin(z) - z)/z^3 has positive terms."""
    z, n = sp.Symbol("z"), sp.Symbol("n", integer=True, positive=True)
    ends = sp.asin(1) - 1 - (sp.pi / 2 - 1)
    first = sp.series(sp.asin(z), z, 0, 12).removeO()
    coefficient = sp.binomial(2 * n, n) / (4**n * (2 * n + 1))
    yield from [ends] + [first.coeff(z, 2 * k + 1) - coefficient.subs(n, k) for k in range(1, 6)]


@check("impulse: as emitted", "left sums of the falling integrand, up to where it has vanished")
def impulse_as_emitted() -> Evidence:
    """The emitted impulse sums the integrand at the start of equal panels up to the angle at which it has vanished."""
    model = _model()
    named = dict(model.definitions)
    risen = aspect * contact_gap + 8 * sp.sin(beta / 2) ** 2
    yield model.expanded(pendulum.WEIGHING) * risen - model.expanded(pendulum.pull_at(contact_gap, beta))
    yield named[pendulum.TURNING] - obliquity * pendulum.LARGEST_MOMENTUM
    # at sin(beta/2) = final the pull, with the present stiffness, equals the centrifugal force of J_max
    level = named[pendulum.FINAL].args[0]
    inner = next(part for part in level.atoms(sp.Min)).args
    (zero,) = (part for part in inner if part != 1)
    yield model.expanded(pendulum.WEIGHING * (aspect * contact_gap + 8 * zero) - pendulum.OUTWARD)
    yield named[pendulum.WIDTH] * pendulum.PANELS - sp.Max(
        0, 2 * pendulum.FINAL + (sp.pi - 2) * pendulum.FINAL**3 - beta
    )
    total = sp.Integer(0)
    for k, (angle, later) in enumerate(zip(pendulum.ANGLES, pendulum.TURNINGS, strict=True)):
        yield named[angle] - beta - k * pendulum.WIDTH
        yield named[later] ** 2 - sp.Max(0, pendulum.TURNING**2 - pendulum.TAKEN * (sp.cos(beta) - sp.cos(angle)))
        pull = pendulum.WEIGHING * (aspect * contact_gap + 4 * (1 - sp.cos(angle)))
        momentum = later / obliquity
        result = (pendulum.outward_at(momentum, pendulum.NEAREST) - _PULL) / pendulum.turning_at(
            momentum, pendulum.NEAREST
        )
        total += sp.Max(0, sp.factor(result).subs(_PULL, pull))
    emitted = model["pendulum_margins"]["impulse"]
    first = {symbol: value for symbol, value in model.definitions if symbol.name == "contact"}
    parts = [sp.expand(part.subs(first)) for part in sp.Mul.make_args(emitted) if part != pendulum.WIDTH]
    ours = sorted((sp.expand(each.args[1]) for each in total.args), key=str)
    theirs = sorted((sp.expand(each.args[1]) for part in parts for each in sp.Add.make_args(part)), key=str)
    yield from [a - b for a, b in zip(ours, theirs, strict=True)]


CHECKS = (
    strings_take, torque_is_least_in_contact, integrand_is_largest_in_contact, angle_is_beyond, impulse_as_emitted,
)  # fmt: skip
