"""Checks of the attraction certificate: its margins as emitted, and the laws whose force decreases with the gap."""

from collections.abc import Iterable

import sympy as sp

from ..equations.certificates.attraction import admits
from ..equations.events import contact_gap
from ..equations.model import derive
from ..laws import LAWS, Law, filled
from ..physics.forces import SHEAR
from ..physics.scaling import DISTANCE
from ..physics.structure import Structure, structures
from ..vocabulary import quantities as q
from .base import MIDGAP, Check, Evidence, check, checks

_COSINE = sp.Symbol("cosine", nonnegative=True)  # for a contact angle up to 90 deg


def force_falls(laws: Iterable[Law], last: sp.Expr = sp.oo) -> tuple[Check, ...]:
    """dF/dx <= 0 for every law declared to decrease with the gap, up to the gap `last`."""
    checks = []
    for law in laws:
        for entry in law.functions:
            if entry.falls:
                first = sp.Symbol(entry.arguments[0].name, positive=True)
                force = entry(*entry.arguments).subs(entry.arguments[0], first).subs(sp.cos(q.contact_angle), _COSINE)
                if q.aspect in entry.arguments:  # a volume per film thickness, to keep the expressions short
                    force = force.subs(q.volume, sp.pi * q.aspect**2 * q.volume)
                slope = sp.factor(force.diff(first))
                if slope.is_nonpositive is None or slope.has(sp.log):  # roots in a sum; numbers in exponents
                    slope = sp.factor(sp.simplify(sp.simplify(force).diff(first)))
                if slope.is_nonpositive is None and last != sp.oo:
                    slope = sp.factor(slope.subs(first, last / (1 + first)))  # any gap below the last
                falls = slope.is_nonpositive is True
                checks.append(Check(f"force falls: {law.name}", "dF/dx <= 0", falls, f"dF/dh = {slope}"))
    return tuple(checks)


@check("held: margins", "inward force at its least, at J_max and at the rupture distance")
def margins_are_the_forces() -> Evidence:
    """`hold`, `escape` and `rebound` from the emitted inward force at the gaps and momenta that bound it."""
    for structure in structures():
        if not admits(structure) or structure.reduced:
            continue
        model = derive(structure)
        emitted = model["inward_force"]["inward_force"]
        force = model.expanded(emitted).subs(DISTANCE, 4 + q.aspect * q.gap)
        attraction = force.subs({q.weight: 0, q.orbital_momentum: 0})
        strings, outward = force.subs(q.orbital_momentum, 0) - attraction, force.subs(q.orbital_momentum, 0) - force
        contact, end = contact_gap, q.rupture_gap
        share = (4 + q.aspect * end) ** 2 / ((4 + q.aspect * end) ** 2 + sp.Rational(32, 5))
        momentum = q.orbital_momentum + sp.Rational(32, 5) * q.spin
        least, most = attraction.subs(q.gap, end), strings.subs({q.gap: end, q.beta: sp.pi}, simultaneous=True)
        largest = sp.Max(*(s * j for j in (q.orbital_momentum, momentum * share) for s in (1, -1)))
        away = outward.subs({q.gap: contact, q.orbital_momentum: largest}, simultaneous=True)
        hold = least + strings.subs(q.gap, contact) - away
        result = model.results("attraction_margins")
        escape = sp.Max(q.normal_velocity, -q.e_dry * q.normal_velocity) ** 2 / 2 - hold * (end - q.gap)
        yield from (result["hold"] - hold, result["escape"] - escape)
        yield result["rebound"] - (q.e_dry**2 * (least + most) - hold)


@checks
def momentum_is_bounded() -> Check:
    """|J| falls where it exceeds |s L|, the largest in rigid rotation up to a gap, for L of either sign.

    Let J be positive (`mirror`: a reflection reverses every rotation), and at least the share at the end of |L|. There
    J - s L, to which the slip is proportional, is positive for every L between -|L| and |L|.
    """
    model = derive(Structure(oblique=True, bridge=True, strings=False))
    here = 4 + q.aspect * q.gap
    momentum = q.orbital_momentum + sp.Rational(32, 5) * q.spin
    share = here**2 / (here**2 + sp.Rational(32, 5))
    rate = filled(model.by_state("right_hand_side")[q.orbital_momentum], MIDGAP)
    log_factor = sp.Function("shear.log_factor", real=True)(q.gap, q.aspect)
    relaxation = sp.factor(-rate / (q.orbital_momentum - share * momentum))
    grows = sp.factor(sp.together((DISTANCE**2 / (DISTANCE**2 + sp.Rational(32, 5))).diff(DISTANCE)))
    excess, whole, rest, now, later = sp.symbols("excess whole rest now later", nonnegative=True)
    above = (now + later) * whole + excess - now * (whole - rest)  # J - s L with J >= (s + later) |L|, L = |L| - rest
    ok = (
        not relaxation.free_symbols & {q.orbital_momentum, q.spin}
        and (relaxation / (SHEAR * log_factor)).subs(q.gap, sp.Symbol("x", positive=True)).is_positive is True
        and grows.is_positive is True
        and sp.expand(above).is_nonnegative is True
    )
    statement = "d|J|/dt <= 0 where |J| >= s(x_f) |L|: dJ/dt = -k (J - s L), s rises"
    return Check("held: momentum", statement, ok, f"k = {relaxation}")


@checks
def attractions_fall() -> tuple[Check, ...]:
    """`force_falls` for the attractions."""
    return force_falls(law for slot in ("bridge", "attraction") for law in LAWS[slot].values())
