"""The excess of e_n over 1: its exact decomposition by the ledger, and an upper bound from L and the energy."""

import sympy as sp

from ..physics.mechanics import doublet_inertia, equations_of_motion
from ..physics.scaling import initial_rate, nondimensional, start_values
from ..vocabulary import quantities as q
from .base import Evidence, check, models
from .conservation import energy_balance

_final = sp.Symbol("x_f", positive=True)  # gap at rupture
_work = sp.Symbol("W_c", real=True)  # of the bridge, W_c(x_f) - W_c(x0)


def ceiling() -> sp.Expr:
    """Upper bound of e_n^2 of a free doublet from L and the ledger, keeping W_c and dropping every other loss, in SI.

    For any spin at initial contact.

    e_n^2 m v0^2/2 = T(0) - T_rot(t_f) - W_c - losses. Among all (omega_f, xi_f) with the initial L, the one with the
    least rotational energy is used: a stationary point, and a minimum because the energy is convex.
    """
    motion, at_start = equations_of_motion(), start_values()
    energy, momentum = motion.kinetic_energy, motion.angular_momentum
    initial, fixed = energy.subs(at_start), momentum.subs(at_start)
    turning = energy.subs(q.u, 0).subs(q.x, _final)
    held = sp.solve(sp.Eq(momentum.subs(q.x, _final), fixed), q.xi)[0]
    along = sp.expand(turning.subs(q.xi, held))
    if not sp.factor(along.diff(q.omega, 2)).is_positive:
        raise ArithmeticError("the rotational energy has no minimum at fixed angular momentum")
    least = along.subs(q.omega, sp.solve(along.diff(q.omega), q.omega)[0])
    return sp.factor(initial - least) * 2 / (q.m * q.v0**2) - 2 * _work / (q.m * q.v0**2)


@check(
    "ceiling of e_n^2", "e_n^2 <= 1 + (r0 tan(theta0)/4a)^2 (1 - m r0^2/I(x_f)) - 2 W_c/(m v0^2), from L and the ledger"
)
def ceiling_is_the_published() -> Evidence:
    """The derived bound and the emitted one are 1 + (r0 tan/(4a))^2 (1 - m r0^2/I(x_f)) - 2 W_c/(m v0^2)."""
    result = ceiling()
    start_distance, inertia = q.r.subs(q.x, q.x0), doublet_inertia().subs(q.x, _final)
    turned_by = (start_distance * sp.tan(q.theta0) / (4 * q.a)) ** 2
    published = 1 + turned_by * (1 - q.m * start_distance**2 / inertia) - 2 * _work / (q.m * q.v0**2)
    yield result.subs(q.impact_spin, 0) - published
    grows = True
    first = {sp.tan(q.theta0): q.obliquity * q.initial_turning, q.impact_spin: q.rate_scale * q.initial_spin}
    turned = result.subs({_final: q.x, **first})
    scaled = nondimensional(turned + 2 * _work / (q.m * q.v0**2))
    for model in models(lambda s: not s.strings):
        emitted = model.expanded(model["restitution_ceiling"]["squared"])
        oblique = model.structure.oblique
        yield emitted - (model.expanded(scaled) if oblique else 1)
        if oblique:  # from 1 upwards with the angle and, since I(x) grows, with the gap
            yield emitted.subs({q.obliquity: 0}) - 1
            slope = sp.factor(emitted.diff(q.gap) / q.obliquity**2)  # a square, of L, times what is positive
            grows &= slope.subs({q.initial_spin: 0, q.initial_turning: 1}).is_positive is True
            grows &= slope.subs(q.initial_spin, sp.Symbol("any", positive=True)).is_nonnegative is True
    yield grows, "it does not grow with the gap"
    yield "minimum of T over (omega_f, xi_f) at the L of the start; equal to the published form"


@check(
    "decomposition of e_n^2 - 1", "e_n^2 - 1 = 2 (rotational energy released - D_n - D_t - W_c - D_dry - dU_s)/(m v0^2)"
)
def decomposition() -> Evidence:
    """e_n^2 - 1 is the rotational energy released minus all losses, over m v0^2/2: exactly the ledger.

    Both sides vanish at the start. The emitted equations and energy_rates keep them equal along the trajectory, the
    emitted jump and rebound_loss at a rebound. The energy released is rotational, and the normal part of T is e_n^2/2,
    at all times.
    """
    for model in models(lambda s: not s.reduced):  # whose shear loss follows from L and not from energy_rates
        kinetic = model.expanded(model["energies"]["kinetic"])
        start = model.by_state("start")
        jump = model.by_state("rebound")
        lost = model.expanded(model["rebound_loss"]["dry_contact"])
        turning = sp.expand(kinetic - q.normal_velocity**2 / 2)
        released = turning.subs(start, simultaneous=True) - turning
        # normal_velocity^2 - 1 - 2 (released - taken); `taken` is the integral of energy_rates plus the strings' energy
        open_by = q.normal_velocity**2 - 1 - 2 * released
        yield open_by.subs(start, simultaneous=True)
        yield open_by.subs(jump, simultaneous=True) + 2 * lost - open_by
        # half its rate, since normal_velocity^2/2 + the rotational energy is `kinetic`
        yield energy_balance(model.structure)
        yield turning.diff(q.normal_velocity)


@check(
    "rotational energy released", "d/dx L^2/(2 I(x)) < 0: a doublet that opens gives rotational energy to the opening"
)
def rotation_can_be_released() -> Evidence:
    """The energy that rigid rotation can release grows with the gap: I(x) grows and L^2/(2 I) decreases."""
    begun = equations_of_motion().angular_momentum.subs(start_values())
    momentum = begun.subs({initial_rate(): q.omega, q.impact_spin: 0})
    slope = sp.factor((momentum**2 / (2 * doublet_inertia())).diff(q.x))
    yield sp.factor(-slope / q.omega**2).is_positive
    per_gap = sp.factor(slope.subs(q.x0, q.aspect * q.a).subs(q.x, q.gap * q.aspect * q.a) / (q.m * q.a * q.omega**2))
    yield f"slope {per_gap} m a omega0^2"
