"""Pendulum certificate: four margins of a doublet on strings that exclude separation, with their derivation.

Per unit mass, lever arm at mid-gap, strings and a film (no bridge), 0 <= beta <= pi and omega >= 0 (otherwise a
cut-off has ended the trajectory as a stick):

1. L decreases, since the strings pull back (S_t >= 0), and F_t reduces the slip omega - xi. So J = r^2 omega never
   exceeds J_max, the larger of its present value and its share r_f^2/(r_f^2 + (32/5) a^2) of L in rigid rotation at
   r_f.
2. beta only grows, and S_n(r, beta) grows with both arguments. So if J_max^2/r^3 < S_n/m at the smallest gap
   (`outward` < `pull`), all forces except lubrication point inward from now on, at every gap.
3. Then the film alone stops an opening doublet if u St/v0 is below the integral of its resistance from the present gap
   to x0 (`film` < 0).
4. While closing, u^2 grows by at most 2 max(S_n/m) x0. A rebound happens at a gap of at most `reach`, the larger of the
   contact gap and the gap at which the glass criterion is met at that speed. If the film stops the rebound from there
   (`recoil` < 0), it stops every later rebound.

`checks.pendulum_certificate` proves the steps on the emitted equations.
"""

from __future__ import annotations

import sympy as sp

from ...physics.forces import scaled_strings
from ...physics.laws import slot_call
from ...physics.laws.strings import offset_squared
from ...physics.mechanics import doublet_inertia
from ...physics.scaling import DISTANCE, INERTIA, nondimensional
from ...vocabulary.quantities import (
    a,
    aspect,
    beta,
    e_dry,
    gap,
    glass_number,
    m,
    normal_velocity,
    omega,
    orbital_momentum,
    r,
    stokes,
)
from ..events import contact_gap
from ..intermediates import MOMENTUM

CONTACT, FASTEST, REACH = sp.symbols("contact fastest reach", positive=True)
NEAREST, FARTHEST = sp.symbols("nearest farthest", positive=True)  # smallest and largest centre distance over a
SPUN_UP, LARGEST_MOMENTUM = sp.symbols("spun_up largest_momentum", real=True)
LARGEST_PULL = sp.Symbol("largest_pull", positive=True)


def rigid_momentum(momentum: sp.Expr, distance: sp.Expr) -> sp.Expr:
    """r^2 omega over a^2 omega0 in rigid rotation with this angular momentum."""
    inertia = nondimensional(doublet_inertia() / (m * a**2)).subs(DISTANCE, distance)
    return momentum * distance**2 / inertia


def pull_at(at: sp.Expr, angle: sp.Expr) -> sp.Expr:
    """Normal string force over m v0^2/x0 at this gap and angle."""
    pull, _, swing = scaled_strings(oblique=True)
    whole = pull.subs(offset_squared, swing).subs(DISTANCE, 4 + aspect * gap)
    return whole.subs({gap: at, beta: angle}, simultaneous=True)


def outward_at(momentum: sp.Expr, distance: sp.Expr) -> sp.Expr:
    """Centrifugal force over m v0^2/x0 for this orbital momentum and centre distance."""
    force = nondimensional(m * r * omega**2 / INERTIA)
    return force.subs({orbital_momentum: momentum, DISTANCE: distance}, simultaneous=True)


def definitions() -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """Named intermediates of `margins`, in order."""
    closing = sp.Min(normal_velocity, 0)
    return (
        (CONTACT, contact_gap),
        (NEAREST, 4 + aspect * CONTACT),
        (FARTHEST, 4 + aspect),
        (SPUN_UP, rigid_momentum(MOMENTUM, FARTHEST)),
        (LARGEST_MOMENTUM, sp.Max(orbital_momentum, SPUN_UP)),
        (LARGEST_PULL, pull_at(sp.Integer(1), sp.pi)),
        (FASTEST, sp.sqrt(closing**2 + 2 * LARGEST_PULL)),
        (REACH, sp.Max(CONTACT, slot_call("glass", "reach", FASTEST, glass_number))),
    )


def margins() -> dict[str, sp.Expr]:
    """The margins: a stick is certain if `outward` < `pull`, `film` < 0 and `recoil` < 0."""
    return {
        "outward": outward_at(LARGEST_MOMENTUM, NEAREST),
        "pull": pull_at(CONTACT, beta),
        "film": stokes * sp.Max(normal_velocity, 0) - slot_call("film", "stopping", gap),
        "recoil": stokes * e_dry * FASTEST - slot_call("film", "stopping", REACH),
    }
