"""Orbital-momentum certificate: conditions that exclude that a doublet reaches a given gap, with their derivation.

Per unit mass, with r the centre distance now and d the one at that gap, J = r^2 omega the orbital momentum, W the
potential of the attractions (in the functions below distances are over a):

1. To reach the gap with the present J requires G = u^2/2 + W(x) - W(gap) + (J^2/2)(1/r^2 - 1/d^2) >= 0. Film and
   solids only reduce u^2, and as |J| decreases, J^2/r^2 decreases by more than J^2/d^2. So G never grows while F_t
   reduces |J|, for any lever arm. (Strings also reduce J, and their pull only grows.)
2. |J| may grow where the spins are faster than the line of centres, in the sense of J. F_t exchanges momenta at a fixed
   ratio, dJ = -(32/5) a^2 (r/2 lever) dxi. Let the slip energy be the energy that this exchange, at the distance d, can
   still transfer from the rotation: zero if omega = xi at d, never negative. G + slip energy never grows, at whatever
   distance the exchange happens (proved in `checks`).
3. Lever arm at mid-gap: L is conserved, and J tends to J_r(x), which has the sign of L and is largest, J_d, at d. Let
   L >= 0 without loss of generality (mirror image). While J > J_d, or J < 0, |J| decreases and G does not grow; between
   0 and J_d G + slip energy does not. So what can still be transferred is the slip energy of J, or of the nearer of 0
   and J_d if J is not between them (`transferable`): none from above J_d, and from J < 0 that of J = 0. If the sum of G
   and this is negative, d is excluded, for any signs of J, xi and L; with L = 0 G alone is tested.
4. If no shear acts beyond a distance e < d, J stops growing at J_e, where omega = xi at e, and the slip energy that
   remains at d in that state is never transferred: it is subtracted in 3. If J is beyond J_e, nothing is transferred
   (`transferable_within_edge`).

With the lever arm at mid-gap, G + slip energy is the energy above the least one with this L at d.
"""

from dataclasses import replace

import sympy as sp

from ...physics.law import Definition
from ...physics.mechanics import doublet_inertia
from ...physics.scaling import DISTANCE, nondimensional
from ...physics.structure import Structure
from ...vocabulary.quantities import a, m, normal_velocity, orbital_momentum, rate_scale, spin, v0, x
from ..intermediates import SLIP
from . import attraction
from .certificate import Certificate, Enclosed, Functions, Proof

UNIT = sp.Symbol("rotation_energy_unit", positive=True)  # m a^2 Omega^2 over m v0^2
RIGID = sp.Symbol("rigid_momentum", real=True)


def admits(structure: Structure) -> bool:
    """True for what the attraction certificate covers, and on strings with friction, where the test is no proof."""
    rubs = bool(structure.friction) and structure.strings
    return attraction.admits(replace(structure, friction="") if rubs else structure)


def spheres_inertia() -> sp.Expr:
    """Moment of inertia of both spheres about their own centres, over m a^2."""
    inertia = doublet_inertia() / (m * a**2)
    return sp.expand(inertia - (4 + x / a) ** 2)


def exchanged(distance: sp.Expr, lever: sp.Expr) -> sp.Expr:
    """-dJ/dxi of the exchange by shear: dJ = -d F_t, (half the spheres' inertia) dxi = lever F_t."""
    return spheres_inertia() * distance / (2 * lever)


def midgap_slip_energy(distance: sp.Expr, momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """Slip energy over m a^2 Omega^2 for the lever arm at mid-gap: kinetic energy above that of rigid rotation.

    The exchange conserves L = J + (32/5) a^2 xi and nothing else.
    """
    return (momentum / distance**2 - turning) ** 2 / (2 * (1 / distance**2 + 1 / spheres_inertia()))


def rigid_momentum(distance: sp.Expr, momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """J once omega = xi at this distance, for the present L."""
    inertia = spheres_inertia()
    return distance**2 * (momentum + inertia * turning) / (distance**2 + inertia)


def transferable(distance: sp.Expr, momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """Slip energy of the present J, or of the nearer of 0 and J_d if J is not between them (lever arm at mid-gap)."""
    return clamped_slip_energy(distance, momentum, rigid_momentum(distance, momentum, turning))


def clamped_slip_energy(distance: sp.Expr, momentum: sp.Expr, rigid: sp.Expr) -> sp.Expr:
    """`transferable` for J_d, which stands for L."""
    within = sp.Max(sp.Min(momentum, sp.Max(rigid, 0)), sp.Min(rigid, 0))
    return (within - rigid) ** 2 * (1 / distance**2 + 1 / spheres_inertia()) / 2


def transferable_within_edge(distance: sp.Expr, edge: sp.Expr, momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """Slip energy that a shear ending at the distance `edge` can transfer, while omega < xi there."""
    rigid = rigid_momentum(edge, momentum, turning)
    return midgap_slip_energy(distance, momentum, turning) - midgap_slip_energy(distance, rigid, rigid / edge**2)


def definitions(_structure: Structure) -> tuple[Definition, ...]:
    """Named intermediates of the margins, in order."""
    return ((UNIT, nondimensional(a**2 * rate_scale**2 / v0**2)),)


def functions(_structure: Structure) -> Functions:
    """The function `transferable` of a state, evaluated at gaps ahead of the doublet."""
    doc = (
        "Slip omega - xi at this gap, and the slip energy over m v0^2 that shear can still transfer before it "
        "(lever arm at mid-gap)."
    )
    yield "transferable", doc, {"slip": SLIP, "slip_energy": UNIT * transferable(DISTANCE, orbital_momentum, spin)}


def enclosed(_structure: Structure) -> Enclosed:
    """G + slip energy: what a state has of it, and what its orbital momentum needs at a gap."""
    orbit = UNIT * orbital_momentum**2 / (2 * DISTANCE**2)
    rest = orbit - UNIT * clamped_slip_energy(DISTANCE, orbital_momentum, RIGID)
    return normal_velocity**2 / 2 + orbit, rest, ((RIGID, rigid_momentum(DISTANCE, orbital_momentum, spin)),)


ROW = Certificate(
    "orbital",
    "the orbital momentum and what the spins can give to it do not suffice for a gap ahead",
    (Proof("stays_below", "the energy does not suffice for a gap ahead", "needed < -margin*size"),),
    ("orbital_momentum_certificate",), admits, definitions, functions,
    enclosed=enclosed, library_only=True,
)  # fmt: skip
