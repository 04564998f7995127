"""Sphere against wall: the limit of a pair for infinite radius and mass of the partner, in quantities that stay finite.

In the limit r omega becomes the velocity v along the wall, while omega and the centrifugal force m v^2/r vanish: the
line of centres does not turn, and the normal motion is independent of the tangential motion. The wall does not spin.

Friction is linear in sliding and rolling, and its matrix depends on the gap through one common factor only. Its two
eigenmodes are therefore constant along the trajectory: slide and roll are sums of exp(-decay) and exp(-ratio decay),
with one state `decay`, the integral of the slower mode's rate. A decayed mode is then a small exponential that limits
no step size and keeps its sign. A tangential impulse of the dry contact starts the modes anew, from the slide and roll
just after it, which are then states that only a rebound changes.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import sympy as sp

from ...vocabulary import quantities as q
from ..forces import SHEAR
from ..law import Definition, slot_call
from ..scaling import nondimensional
from .base import Rotation
from .bodies import CENTRES, T_1, F_t, centres, equations_of_motion, inertias, r, radii
from .rolling import R_1, R_2, torque_matrix
from .vectors import dot

SHEAR_FORCE, TORQUE = sp.symbols("shear_force torque", real=True)
SLOW_MODE, FAST_MODE = sp.symbols("slow_mode fast_mode", positive=True)


def limit(expression: sp.Expr) -> sp.Expr:
    """An SI expression of the pair in the wall limit: omega = v/r, no spin of the partner, R_2 and M_2 to infinity."""
    at_rest = expression.subs(q.partner_spin_rate, 0).subs(q.omega, q.slide_rate / r)
    radius, other = radii()
    in_ratios = at_rest.subs({R_1: radius, R_2: other}).subs(CENTRES, centres())
    for ratio in (q.mass_ratio, q.radius_ratio):
        in_ratios = sp.limit(sp.factor(in_ratios), ratio, sp.oo)
    return sp.factor(in_ratios)


@cache
def friction() -> tuple[sp.Expr, sp.Expr]:
    """Torque on the sphere and force against its sliding, in SI, over ln(h_outer/x)."""
    torques = torque_matrix() * sp.Matrix([q.omega - q.xi, q.omega - q.partner_spin_rate])
    return limit(torques[0]), limit((torques[0] + torques[1]) / (R_1 + R_2))


@cache
def accelerations() -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Accelerations in SI: of the gap (without forces along it), along the wall (v = r omega), and of the spin."""
    motion = equations_of_motion().accelerations
    opened = motion["x"]
    along = q.u * q.omega + r * motion["beta"]  # d(r omega)/dt
    return limit(opened - opened.subs(q.omega, 0)), limit(along), limit(motion["alpha_1"])


def scaled(expression: sp.Expr) -> sp.Expr:
    """A dimensionless SI expression in states and groups; v over v0 T, spin over v0 T/a."""
    sideways = q.v0 * q.obliquity
    moving = {q.slide_rate: sideways * q.slide, q.xi: sideways / q.a * q.roll}
    return nondimensional(expression.subs(moving, simultaneous=True))


@dataclass(frozen=True)
class Modes:
    """Slide and roll as sums of two decaying modes.

    Arguments:
        rate: decay rate of the slower mode, per v0/x0; only this depends on the gap.
        ratio: decay rate of the faster mode over that of the slower.
        slide, roll: weights of the slower and the faster mode.
    """

    rate: sp.Expr
    ratio: sp.Expr
    slide: tuple[sp.Expr, sp.Expr]
    roll: tuple[sp.Expr, sp.Expr]


def modes(rates: Mapping[sp.Symbol, sp.Expr], start: Mapping[sp.Symbol, sp.Expr]) -> Modes:
    """The modes of rates that are linear in slide and roll, with a constant matrix times one common factor.

    Raises:
        ValueError: the rates do not have this form, or a mode does not decay.
    """
    moving = sp.Matrix([q.slide, q.roll])
    result = sp.Matrix([sp.expand(rates[state]) for state in moving])
    matrix = -result.jacobian(moving)
    factor = matrix[0, 0]
    numbers = (matrix / factor).applyfunc(sp.simplify)
    if (result + matrix * moving).applyfunc(sp.expand) != sp.zeros(2, 1) or numbers.free_symbols:
        raise ValueError(f"sliding and rolling are not damped by one constant matrix: {numbers}")
    (slow, _, (mode,)), (fast, _, (other,)) = sorted(numbers.eigenvects(), key=lambda triple: triple[0])
    if not (slow.is_positive and fast.is_positive):
        raise ValueError(f"a mode of sliding and rolling does not decay: {slow}, {fast}")
    vectors = sp.Matrix.hstack(mode, other)
    weights = vectors * sp.diag(*vectors.LUsolve(moving.subs(start)))
    along, spun = (tuple(sp.expand(sp.radsimp(sp.simplify(weight))) for weight in weights.row(k)) for k in range(2))
    return Modes(factor * sp.together(slow), sp.expand(sp.radsimp(fast / slow)), along, spun)


@cache
def friction_rates() -> tuple[tuple[Definition, ...], dict[sp.Symbol, sp.Expr]]:
    """Friction force and torque by name, and the rates of slide and roll in terms of them, per v0/x0."""
    log = SHEAR * slot_call("shear", "log_factor", q.x / q.x0, q.x0 / q.a)
    torque, force = friction()
    unit = _force_unit()
    opened, along, spun = accelerations()
    assert opened == 0  # no centrifugal force
    named = {F_t: unit * SHEAR_FORCE, T_1: unit * q.a * TORQUE}
    definitions = ((SHEAR_FORCE, scaled(log * force / unit)), (TORQUE, scaled(log * torque / (unit * q.a))))
    return definitions, {
        q.slide: scaled(along.subs(named) * q.x0 / (q.v0 * q.v0 * q.obliquity)),
        q.roll: scaled(spun.subs(named) * q.x0 / q.v0 * q.a / (q.v0 * q.obliquity)),
    }


def _force_unit() -> sp.Expr:
    return q.m * q.v0 * q.obliquity * q.v0 / q.x0


@cache
def rotation(impulses: bool = False) -> Rotation:
    """The rotation of a sphere beside a wall, for its equations.

    Arguments:
        impulses: with tangential impulses, so that the modes may start from any slide and roll.
    """
    definitions, rates = friction_rates()
    first = {q.slide: q.initial_turning, q.roll: q.initial_spin}
    begin = {q.slide: q.last_slide, q.roll: q.last_roll} if impulses else first
    last = {begin[state]: value for state, value in first.items()} if impulses else {}
    result = modes({state: rate.subs(dict(definitions)) for state, rate in rates.items()}, begin)
    both, unit = (SLOW_MODE, FAST_MODE), _force_unit()
    kinetic = (q.m * q.slide_rate**2 + limit(inertias()[0]) * q.xi**2) / 2
    power = (F_t * q.slide_rate - T_1 * q.xi).subs({F_t: unit * SHEAR_FORCE, T_1: unit * q.a * TORQUE})
    return Rotation(
        states=(q.decay, *last),
        definitions=(
            (SLOW_MODE, sp.exp(-q.decay)),
            (FAST_MODE, sp.exp(-result.ratio * q.decay)),
            (q.slide, dot(result.slide, both)),
            (q.roll, dot(result.roll, both)),
            *definitions,
        ),
        centrifugal=sp.Integer(0),
        rates={q.decay: result.rate, **dict.fromkeys(last, sp.Integer(0))},
        turning=None,
        kinetic=scaled(kinetic / (q.m * q.v0**2)),
        power=scaled(power * q.x0 / q.v0 / (q.m * q.v0**2)),
        momentum=None,
        outputs={
            "tangential_restitution": q.slide / q.initial_turning,
            "final_rotation_rate": sp.Integer(0),
            "final_spin": q.roll,
        },
        surface_slip=q.slide - q.roll,
        least=(sp.Integer(0), sp.Integer(0)),
        rigid={state: state for state in (q.decay, *last)},
        start={q.decay: sp.Integer(0), **last},
    )
