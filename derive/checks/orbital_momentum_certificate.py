"""Checks of the orbital-momentum certificate: the exchange by F_t, and that it never increases the margin."""

from dataclasses import replace

import sympy as sp

from ..equations.certificates import orbital_momentum as orbital
from ..equations.model import derive
from ..laws import filled
from ..physics.scaling import DISTANCE
from ..physics.structure import BRIDGED
from ..vocabulary.quantities import aspect, gap, normal_velocity, obliquity, orbital_momentum, spin
from .base import MIDGAP, Check, Evidence, check, checks, no_negative, vanishing

_FAR, _NEAR = sp.symbols("far near", positive=True)  # centre distances over a
# square roots of momentum and spin, in which all expressions are rational
_P, _Q = sp.symbols("root_J root_xi", positive=True)
_EDGE = sp.Symbol("edge", positive=True)  # centre distance over a beyond which no shear acts
_CLOSER, _BEYOND = sp.symbols("closer beyond", nonnegative=True)


@check("F_t exchanges momenta", "dJ = -(32/5)(d/(2 lever)) a^2 dxi")
def exchange() -> Evidence:
    """The emitted rates of J and xi have the ratio `exchanged`."""
    rates = derive(BRIDGED).by_state("right_hand_side")
    here = 4 + aspect * gap
    to_orbit, to_spin = (filled(rates[state], MIDGAP) for state in (orbital_momentum, spin))
    yield to_orbit + orbital.exchanged(here, MIDGAP["arm"]["lever"](here)) * to_spin


@check("slip energy", "zero where omega = xi at d; exchange where omega = xi changes nothing")
def stationary() -> Evidence:
    """The slip energy vanishes at omega = xi at d; with J^2/2 (1/r^2 - 1/d^2) it is stationary where omega = xi."""
    energy = _midgap()
    yield from (energy.subs(_P, _FAR * _Q), _change(energy).subs(_P, _NEAR * _Q))


def _settled(expression: sp.Expr) -> sp.Expr:
    return sp.cancel(sp.together(expression))


def _midgap() -> sp.Expr:
    return orbital.midgap_slip_energy(_FAR, _P**2, _Q**2)


def _change(energy: sp.Expr) -> sp.Expr:
    """Change of the margin per dxi by the exchange at the distance `near`."""
    margin = _P**4 / 2 * (1 / _NEAR**2 - 1 / _FAR**2) + energy
    rate = orbital.exchanged(_NEAR, MIDGAP["arm"]["lever"](_NEAR))
    return margin.diff(_Q) / (2 * _Q) - rate * margin.diff(_P) / (2 * _P)


@check("exchange takes, midgap", "d(margin) = -c (omega - xi) dxi, dxi ~ omega - xi")
def midgap_takes() -> Evidence:
    """Lever arm at mid-gap: d(margin)/dxi = -(32/5)(omega - xi) a^2, so that F_t never increases the margin."""
    ratio = _settled(_change(_midgap()) / (_P**2 / _NEAR**2 - _Q**2))
    yield from (ratio.is_number and bool(ratio < 0), f"c = {-ratio}")


@check("exchange ends, midgap", "nothing is left once omega = xi at the edge of the shear")
def midgap_ends() -> Evidence:
    """Beyond the edge of the shear: the same exchange, zero once omega = xi at the edge, and positive before."""
    within = orbital.transferable_within_edge(_FAR, _EDGE, _P**2, _Q**2)
    yield from (_change(within) - _change(_midgap()), within.subs(_P, _EDGE * _Q))
    # on the way to the edge J grows while xi > J/e^2, and each step transfers xi - J/d^2
    to_spin = 1 / orbital.exchanged(_NEAR, MIDGAP["arm"]["lever"](_NEAR))
    slope = within.diff(_P) / (2 * _P) - to_spin * within.diff(_Q) / (2 * _Q)
    ahead = {_FAR: _EDGE + _BEYOND, _P: _EDGE * _Q / (1 + _CLOSER)}
    top, bottom = sp.fraction(sp.cancel(sp.together(-slope.subs(ahead))))
    yield no_negative(top) and no_negative(bottom), "it grows on the way to the edge"


@checks
def transferable_bounds() -> tuple[Check, ...]:
    """What can be transferred, for momenta of any sign: where |J| falls G falls, elsewhere the sum with slip energy.

    dG/dJ = J (1/r^2 - 1/d^2), and dJ = -k (J - J_r(x)) with J_r = L r^2/(r^2 + 32/5). With L >= 0 (`mirror`): for J < 0
    and for J > J_d, J (J - J_r) >= 0. The slip energy of J is a square that vanishes at J_d, and at the ends of both
    ranges the bound is continuous: 0 at J_d, the slip energy of J = 0 at 0.
    """
    inertia = orbital.spheres_inertia()
    momentum, turning = sp.symbols("momentum turning", real=True)
    rigid = orbital.rigid_momentum(_FAR, momentum, turning)
    energy = (momentum - rigid) ** 2 * (1 / _FAR**2 + 1 / inertia) / 2
    residuals = [energy - orbital.midgap_slip_energy(_FAR, momentum, turning)]  # for every sign: no square roots
    margin = momentum**2 / 2 * (1 / _NEAR**2 - 1 / _FAR**2) + orbital.midgap_slip_energy(_FAR, momentum, turning)
    rate = orbital.exchanged(_NEAR, MIDGAP["arm"]["lever"](_NEAR))
    change = margin.diff(turning) - rate * margin.diff(momentum)
    ratio = _settled(change / (momentum / _NEAR**2 - turning))
    whole, excess = sp.symbols("whole excess", nonnegative=True)
    closer = 4 + _CLOSER
    share = orbital.rigid_momentum(sp.Symbol("r", positive=True), whole, sp.Integer(0))
    here, beyond = (share.subs(sp.Symbol("r", positive=True), d) for d in (closer, closer + _BEYOND))
    products = [(beyond + excess) * (beyond + excess - here), -excess * (-excess - here)]
    fall = all(no_negative(factor) for value in products for factor in sp.fraction(sp.cancel(sp.together(value))))
    same = vanishing("exchange takes, any sign", "d(margin) = -c (omega - xi) dxi for momenta of any sign", residuals)
    bounded = Check(
        "what can be transferred",
        "J (J - J_r) >= 0 for J >= J_d and for J <= 0 <= L: |J| falls, and G with it",
        fall and ratio.is_number and bool(ratio < 0),
        f"slip energy (J - J_d)^2 {sp.factor((1 / _FAR**2 + 1 / inertia) / 2)}",
    )
    return same, bounded


def _clamped(value: sp.Expr) -> sp.Expr:
    """An expression in J and J_d as one in J, Max and Min of which have arguments in one form."""
    return value.replace(
        lambda node: isinstance(node, (sp.Max, sp.Min)), lambda node: node.func(*map(sp.cancel, node.args))
    )


@check("orbital: as emitted", "slip and slip energies over m v0^2")
def as_emitted() -> Evidence:
    """The emitted margins are this energy, in units of m v0^2, and the slip."""
    for structure in (BRIDGED, replace(BRIDGED, reduced=True)):
        model = derive(structure)
        emitted = model.results("transferable")
        held, needed, further = orbital.enclosed(structure)
        here, turning = model.expanded(DISTANCE), model.expanded(spin) if structure.reduced else spin
        unit = obliquity**2 / 16  # omega0 = v0 tan(theta0)/(4a)
        yield emitted["slip"] - (orbital_momentum / here**2 - turning)
        orbit = unit * orbital_momentum**2 / (2 * here**2)
        yield model.expanded(held) - normal_velocity**2 / 2 - orbit
        yield model.expanded(needed.subs(dict(further))) - (orbit - emitted["slip_energy"])
        rigid = sp.cancel(orbital.rigid_momentum(here, orbital_momentum, turning))
        expected = orbital.clamped_slip_energy(here, orbital_momentum, rigid)
        yield _clamped(emitted["slip_energy"] / unit) - _clamped(expected)
