"""When the momentum of the orbit holds a doublet: what proves that it never gets as far as a given gap, and why.

Per unit mass, r = d a the centre distance there, J = r^2 omega the momentum of the orbit, W the work of what attracts:

1. G = u^2/2 + W(x) - W(there) + (J^2/2)(1/r(x)^2 - 1/r^2) < 0 is needed to get there with the J of now. Film and
   solids only take from u^2, and a J that falls takes more from J^2/r(x)^2 than from J^2/r^2: G never grows while
   omega >= xi, since F_t then pulls J down, whatever the arm. (Strings pull J down as well, and their pull only grows.)
2. J may grow where xi > omega. F_t exchanges momenta at a fixed rate, dJ = -(32/5) a^2 (d/2 lever) dxi. Let
   `slip_energy` be what that exchange, at the distance d, can still take from the rotation: zero where omega = xi
   there, never negative. G + slip_energy never grows, wherever the exchange happens (proved in `checks`).
3. So while omega >= xi at d for the J of now, G < 0 holds the doublet; once omega = xi there, slip_energy = 0, and
   from then on G + slip_energy < 0 does. One test: G + slip_energy (where xi > omega) < 0.

4. Where no shear acts beyond a distance e < d, J stops growing once omega = xi at e. With L conserved (midgap) that is
   a state known in advance: the slip energy at d that is left there is never taken, and does not count in 3. None
   counts where the J of now is larger already (`midgap_within`).

With the midgap arm that sum is the energy above the least one with this L at d. With the surface arm the exchange
conserves sqrt(J) + (8/5) sqrt(xi) a along states that turn as one body, which takes the place of L.
"""

from __future__ import annotations

import sympy as sp

from ...physics.mechanics import doublet_inertia
from ...physics.scaling import DISTANCE, nondimensional
from ...physics.structure import Structure
from ...vocabulary.quantities import a, m, omega0, orbital_momentum, spin, v0, x
from ..intermediates import SLIP

RIGID = sp.Symbol("rigid_share", nonnegative=True)  # 1/(rho/a + lag), rho the distance at which omega = xi for this J
UNIT = sp.Symbol("rotation_energy_unit", positive=True)  # m a^2 omega0^2 over m v0^2


def spheres_inertia() -> sp.Expr:
    """Moment of inertia of both spheres about their own centres, over m a^2."""
    inertia = doublet_inertia() / (m * a**2)
    return sp.simplify(inertia - (4 + x / a) ** 2)


def exchanged(distance: sp.Expr, lever: sp.Expr) -> sp.Expr:
    """-dJ/dxi of what the shear exchanges: dJ = -d F_t, (half the spheres' inertia) dxi = lever F_t."""
    return spheres_inertia() * distance / (2 * lever)


def lag() -> sp.Expr:
    """The surface arm's -dJ/dxi over the distance."""
    return exchanged(sp.Integer(1), sp.Integer(2))


def midgap(distance: sp.Expr, momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """Slip energy over m a^2 omega0^2: that of the slip, since L = J + (32/5) a^2 xi is all that is conserved."""
    return (momentum / distance**2 - turning) ** 2 / (2 * (1 / distance**2 + 1 / spheres_inertia()))


def rigid_momentum(distance: sp.Expr, momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """J once omega = xi at this distance, with the L of now."""
    inertia = spheres_inertia()
    return distance**2 * (momentum + inertia * turning) / (distance**2 + inertia)


def midgap_within(distance: sp.Expr, edge: sp.Expr, momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """Slip energy as far as a shear can take it that ends at the distance `edge`, while omega < xi there."""
    rigid = rigid_momentum(edge, momentum, turning)
    return midgap(distance, momentum, turning) - midgap(distance, rigid, rigid / edge**2)


def _potential(share: sp.Expr) -> sp.Expr:
    """Integral of rho/(rho + lag)^5 by rho, in share = 1/(rho + lag)."""
    return -(share**3) / 3 + lag() * share**4 / 4


def rigid_share(momentum: sp.Expr, turning: sp.Expr) -> sp.Expr:
    """1/(rho + lag) over 1/a, with rho^2 = J/xi."""
    return sp.sqrt(turning) / (sp.sqrt(momentum) + lag() * sp.sqrt(turning))


def surface(distance: sp.Expr, momentum: sp.Expr, turning: sp.Expr, share: sp.Expr) -> sp.Expr:
    """Slip energy over m a^2 omega0^2 with the surface arm: J^2/(2 d^2) less what is left once omega = xi there."""
    conserved = (sp.sqrt(momentum) + lag() * sp.sqrt(turning)) ** 4
    there = 1 / (distance + lag())
    return momentum**2 / (2 * distance**2) - conserved * (
        distance**2 * there**4 / 2 + 2 * lag() * (_potential(share) - _potential(there))
    )


def admits(structure: Structure) -> bool:
    """Whether the proof is about this structure: equal spheres that turn, and something that attracts."""
    return structure.oblique and (structure.bridge or structure.attraction) and not structure.partner


def definitions(structure: Structure) -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """Named intermediates of `margins`, in order."""
    found: list[tuple[sp.Symbol, sp.Expr]] = [(UNIT, nondimensional(a**2 * omega0**2 / v0**2))]
    return tuple(found if structure.reduced else [*found, (RIGID, rigid_share(orbital_momentum, spin))])


def margins(structure: Structure) -> dict[str, sp.Expr]:
    """Omega - xi and J^2/(2 r^2) at the state's gap; the slip energy for either arm; energies over m v0^2."""
    found = {
        "slip": SLIP,
        "orbital_energy": UNIT * orbital_momentum**2 / (2 * DISTANCE**2),
        "midgap": UNIT * midgap(DISTANCE, orbital_momentum, spin),
    }
    return found if structure.reduced else {**found, "surface": UNIT * surface(DISTANCE, orbital_momentum, spin, RIGID)}
