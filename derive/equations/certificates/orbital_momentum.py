"""Orbital-momentum certificate: conditions that exclude that a doublet reaches a given gap, with their derivation.

Per unit mass, with r = d a the centre distance at that gap, J = r^2 omega the orbital momentum, W the potential of the
attractions:

1. To reach the gap with the present J requires G = u^2/2 + W(x) - W(gap) + (J^2/2)(1/r(x)^2 - 1/r^2) >= 0. Film and
   solids only reduce u^2, and as J decreases, J^2/r(x)^2 decreases by more than J^2/r^2. So G never grows while
   omega >= xi, since F_t then reduces J, for any lever arm. (Strings also reduce J, and their pull only grows.)
2. J may grow while xi > omega. F_t exchanges momenta at a fixed ratio, dJ = -(32/5) a^2 (d/2 lever) dxi. Let
   `slip_energy` be the energy that this exchange, at the distance d, can still transfer from the rotation: zero if
   omega = xi at d, never negative. G + slip_energy never grows, at whatever distance the exchange happens (proved in
   `checks`).
3. So while omega >= xi at d for the present J, G < 0 excludes the gap. Once omega = xi there, slip_energy = 0, and from
   then on G + slip_energy < 0 excludes it. Both are one test: G + slip_energy (where xi > omega) < 0.

4. If no shear acts beyond a distance e < d, J stops growing once omega = xi at e. With conserved L (lever arm at
   mid-gap) that state is known in advance, and the slip energy that remains at d in it is never transferred: it is
   subtracted in 3. If the present J is already larger, nothing is transferred (`midgap_within`).

With the lever arm at mid-gap the sum is the energy above the least one with this L at d. With the lever arm at the
surface the exchange conserves sqrt(J) + (8/5) sqrt(xi) a along states of rigid rotation, which replaces L.
"""

from __future__ import annotations

import sympy as sp

from ...physics.mechanics import doublet_inertia
from ...physics.scaling import DISTANCE, nondimensional
from ...physics.structure import Structure
from ...vocabulary.quantities import a, m, orbital_momentum, rate_scale, spin, v0, x
from ..intermediates import SLIP

RIGID = sp.Symbol("rigid_share", nonnegative=True)  # 1/(rho/a + lag), with omega = xi at the distance rho
UNIT = sp.Symbol("rotation_energy_unit", positive=True)  # m a^2 Omega^2 over m v0^2


def spheres_inertia() -> sp.Expr:
    """Moment of inertia of both spheres about their own centres, over m a^2."""
    inertia = doublet_inertia() / (m * a**2)
    return sp.expand(inertia - (4 + x / a) ** 2)


def exchanged(distance: sp.Expr, lever: sp.Expr) -> sp.Expr:
    """-dJ/dxi of the exchange by shear: dJ = -d F_t, (half the spheres' inertia) dxi = lever F_t."""
    return spheres_inertia() * distance / (2 * lever)


def lag() -> sp.Expr:
    """-dJ/dxi over the distance, for the lever arm at the surface."""
    return exchanged(sp.Integer(1), sp.Integer(2))


def midgap(distance: sp.Expr, momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """Slip energy over m a^2 Omega^2 for the lever arm at mid-gap: kinetic energy above that of rigid rotation.

    The exchange conserves L = J + (32/5) a^2 xi and nothing else.
    """
    return (momentum / distance**2 - turning) ** 2 / (2 * (1 / distance**2 + 1 / spheres_inertia()))


def rigid_momentum(distance: sp.Expr, momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """J once omega = xi at this distance, for the present L."""
    inertia = spheres_inertia()
    return distance**2 * (momentum + inertia * turning) / (distance**2 + inertia)


def midgap_within(distance: sp.Expr, edge: sp.Expr, momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """Slip energy that a shear ending at the distance `edge` can transfer, while omega < xi there."""
    rigid = rigid_momentum(edge, momentum, turning)
    return midgap(distance, momentum, turning) - midgap(distance, rigid, rigid / edge**2)


def _potential(share: sp.Expr) -> sp.Expr:
    """Antiderivative of rho/(rho + lag)^5, in share = 1/(rho + lag)."""
    return -(share**3) / 3 + lag() * share**4 / 4


def rigid_share(momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """1/(rho + lag) over 1/a, with rho^2 = J/xi."""
    return sp.sqrt(turning) / (sp.sqrt(momentum) + lag() * sp.sqrt(turning))


def surface(distance: sp.Expr, momentum: sp.Expr, turning: sp.Expr, share: sp.Expr) -> sp.Expr:
    """Slip energy over m a^2 Omega^2 for the lever arm at the surface.

    It is J^2/(2 d^2) minus what remains of it once omega = xi at d.
    """
    conserved = (sp.sqrt(momentum) + lag() * sp.sqrt(turning)) ** 4
    there = 1 / (distance + lag())
    return momentum**2 / (2 * distance**2) - conserved * (
        distance**2 * there**4 / 2 + 2 * lag() * (_potential(share) - _potential(there))
    )


def admits(structure: Structure) -> bool:
    """True for the structures covered: oblique, equal spheres, with an attraction."""
    attracts = structure.bridge or structure.attraction
    return structure.oblique and attracts and not (structure.partner or structure.friction)


def definitions(structure: Structure) -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """Named intermediates of `margins`, in order."""
    found: list[tuple[sp.Symbol, sp.Expr]] = [(UNIT, nondimensional(a**2 * rate_scale**2 / v0**2))]
    return tuple(found if structure.reduced else [*found, (RIGID, rigid_share(orbital_momentum, spin))])


def margins(structure: Structure) -> dict[str, sp.Expr]:
    """The margins at the state's gap: omega - xi, J^2/(2 r^2), slip energy for either lever arm; over m v0^2."""
    found = {
        "slip": SLIP,
        "orbital_energy": UNIT * orbital_momentum**2 / (2 * DISTANCE**2),
        "midgap": UNIT * midgap(DISTANCE, orbital_momentum, spin),
    }
    return found if structure.reduced else {**found, "surface": UNIT * surface(DISTANCE, orbital_momentum, spin, RIGID)}
