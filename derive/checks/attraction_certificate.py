"""Checks of the attraction certificate: its margins as emitted, and the laws whose force decreases with the gap."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from ..equations.certificates.attraction import admits
from ..equations.events import contact_gap
from ..equations.model import derive
from ..physics.forces import SHEAR
from ..physics.laws import LAWS, Law
from ..physics.scaling import DISTANCE
from ..physics.structure import Structure, structures
from ..vocabulary.quantities import (
    aspect,
    beta,
    contact_angle,
    e_dry,
    gap,
    normal_velocity,
    orbital_momentum,
    rupture_gap,
    spin,
    volume,
    weight,
)
from .base import Check, vanishing
from .closed import emitted_rates, filled

_COSINE = sp.Symbol("cosine", nonnegative=True)  # for a contact angle up to 90 deg


def force_falls(laws: Iterable[Law], last: sp.Expr = sp.oo) -> tuple[Check, ...]:
    """dF/dx <= 0 for every law declared to decrease with the gap, up to the gap `last`."""
    checks = []
    for law in laws:
        for each in law.functions:
            if each.falls:
                first = sp.Symbol(each.arguments[0].name, positive=True)
                force = each(*each.arguments).subs(each.arguments[0], first).subs(sp.cos(contact_angle), _COSINE)
                if aspect in each.arguments:  # a volume per film thickness, to keep the expressions short
                    force = force.subs(volume, sp.pi * aspect**2 * volume)
                slope = sp.factor(sp.simplify(sp.simplify(force).diff(first)))
                if slope.is_nonpositive is None and last != sp.oo:
                    slope = sp.factor(slope.subs(first, last / (1 + first)))  # any gap below the last
                checks.append(
                    Check(f"force falls: {law.name}", "dF/dx <= 0", slope.is_nonpositive is True, f"dF/dh = {slope}")
                )
    return tuple(checks)


def margins_are_the_forces() -> Check:
    """`hold`, `escape` and `rebound` from the emitted inward force at the gaps and momenta that bound it."""
    left: list[sp.Expr] = []
    for structure in structures():
        if not admits(structure) or structure.reduced:
            continue
        model = derive(structure)
        emitted = model["inward_force"]["inward_force"]
        force = model.expanded(emitted).subs(DISTANCE, 4 + aspect * gap)
        attraction = force.subs({weight: 0, orbital_momentum: 0})
        strings, outward = force.subs(orbital_momentum, 0) - attraction, force.subs(orbital_momentum, 0) - force
        contact, end = contact_gap, rupture_gap
        share = (4 + aspect * end) ** 2 / ((4 + aspect * end) ** 2 + sp.Rational(32, 5))
        momentum = orbital_momentum + sp.Rational(32, 5) * spin
        least, most = attraction.subs(gap, end), strings.subs({gap: end, beta: sp.pi}, simultaneous=True)
        away = outward.subs(
            {
                gap: contact,
                orbital_momentum: sp.Max(*(s * j for j in (orbital_momentum, momentum * share) for s in (1, -1))),
            },
            simultaneous=True,
        )
        hold = least + strings.subs(gap, contact) - away
        found = {name: model.expanded(value) for name, value in model["attraction_margins"].outputs}
        left += [
            found["hold"] - hold,
            found["escape"] - (sp.Max(normal_velocity, -e_dry * normal_velocity) ** 2 / 2 - hold * (end - gap)),
            found["rebound"] - (e_dry**2 * (least + most) - hold),
        ]
    return vanishing("held: margins", "inward force at its least, at J_max and at the rupture distance", left)


def momentum_is_bounded() -> Check:
    """|J| falls where it exceeds |s L|, the largest in rigid rotation up to a gap, for L of either sign.

    Let J be positive (`mirror`: a reflection reverses every rotation), and at least the share at the end of |L|. There
    J - s L, to which the slip is proportional, is positive for every L between -|L| and |L|.
    """
    model = derive(Structure(oblique=True, bridge=True, strings=False))
    here = 4 + aspect * gap
    momentum = orbital_momentum + sp.Rational(32, 5) * spin
    share = here**2 / (here**2 + sp.Rational(32, 5))
    rate = filled(emitted_rates(model)[orbital_momentum], {"arm": LAWS["arm"]["midgap"]})
    log_factor = sp.Function("shear.log_factor", real=True)(gap, aspect)
    relaxation = sp.factor(-rate / (orbital_momentum - share * momentum))
    grows = sp.factor(sp.together((DISTANCE**2 / (DISTANCE**2 + sp.Rational(32, 5))).diff(DISTANCE)))
    excess, whole, rest, now, later = sp.symbols("excess whole rest now later", nonnegative=True)
    above = (now + later) * whole + excess - now * (whole - rest)  # J - s L with J >= (s + later) |L|, L = |L| - rest
    ok = (
        not relaxation.free_symbols & {orbital_momentum, spin}
        and (relaxation / (SHEAR * log_factor)).subs(gap, sp.Symbol("x", positive=True)).is_positive is True
        and grows.is_positive is True
        and sp.expand(above).is_nonnegative is True
    )
    return Check(
        "held: momentum", "d|J|/dt <= 0 where |J| >= s(x_f) |L|: dJ/dt = -k (J - s L), s rises", ok, f"k = {relaxation}"
    )


def attraction_certificate() -> tuple[Check, ...]:
    """Every check of the attraction certificate."""
    laws = [law for slot in ("bridge", "attraction") for law in LAWS[slot].values()]
    return (*force_falls(laws), momentum_is_bounded(), margins_are_the_forces())
