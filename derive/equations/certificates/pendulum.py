"""Pendulum certificate: margins of a doublet on strings that exclude separation, with their derivation.

Per unit mass, lever arm at mid-gap, strings and a film (no bridge), 0 <= beta <= pi and omega >= 0 (otherwise a
cut-off has ended the trajectory as a stick). On strings nothing spins at first, and F_t drives xi towards omega >= 0:
xi, J and L are never negative.

1. L decreases, since the strings pull back with the torque r S_t >= 0, and F_t reduces the slip omega - xi. So
   J = r^2 omega never exceeds J_max, the larger of its present value and the share s = r_f^2/(r_f^2 + (32/5) a^2) of L,
   that of rigid rotation at r_f. Nor does it exceed J_max - s D, where D is what the strings have taken from L: on that
   level J > s L, so F_t reduces it, and the strings take 1 >= s of what they take from L.
2. beta grows at the rate J/r^2, so dD/dbeta = r^3 S_t/J. With (J_max - s D) for J this integrates to
   J^2 <= J_max^2 - 2 s r^3 S (cos(beta_0) - cos(beta)), where S_t >= S sin(beta) in contact, S at the present angle.
3. Film and forces: u + G(x)/St, with G the film's integral, changes only by the forces other than the film's and by
   rebounds. The outward impulse of these forces is at most the integral of (J^2/r^3 - S_n)/(J/r^2) over beta, where it
   is positive. The integrand grows with J and falls with r and beta: in contact, with the bound of J and at the start
   of each of PANELS equal parts up to the angle at which it has vanished, its sum is the bound `impulse`. It is zero
   if J_max^2/r^3 < S_n in contact (`outward` < `pull`): all forces except lubrication then point inward for good.
4. So without a rebound, u St + St impulse below the integral of the film's resistance from the present gap to x0
   excludes separation (`film` + St impulse < 0), for a doublet that closes as for one that opens.
5. While closing, u^2 grows by at most 2 max(S_n/m) x0. A rebound happens at a gap of at most `reach`, the larger of the
   contact gap and the gap at which the glass criterion is met at that speed. If the film stops the rebound from there
   (`recoil` + St impulse < 0), it stops every later rebound.
6. From initial contact on the centrifugal force slows the approach. With g the film's resistance and P the largest
   pull, over the depth y = x0 - x the closing speed w obeys dw/dy <= P/w - g/St. Over one part of the film, of length
   h, w thus stays below w + min(P h/left, sqrt(2 P h)) - (loss in the film), where left = w - (loss over the part): of
   the two, the first needs left > 0. So `gain` = P h/max(left, sqrt(P h/2)) bounds what w gains against the film, and w
   is at most max(left, 0) + gain at the end of the part, at most w + gain within it. Later approaches start slower.
7. The glass pressure grows with the speed and as the gap closes. If it stays below its limit at the end of each part
   for the largest speed within the part, and the gap above solid contact, no criterion is met. A rebound from a gap
   and speed is stopped if `rebound` + St impulse < 0; one at any smaller gap, if `beneath` + St impulse < 0. If no
   criterion is met, or its rebound is stopped, in each part of the film, the doublet sticks.

`checks.pendulum_certificate` proves the steps on the emitted equations.
"""

import sympy as sp

from ...physics.forces import FILM, scaled_strings
from ...physics.law import Definition, slot_call, slot_calls
from ...physics.mechanics import doublet_inertia
from ...physics.pendulum import offset_squared
from ...physics.scaling import DISTANCE, INERTIA, nondimensional
from ...physics.structure import Structure
from ...vocabulary import quantities as q
from ..automaton import APPROACH_PARTS, DEEPEST_PART
from ..events import contact_gap
from ..intermediates import FILM_FORCE, MOMENTUM, ORBITAL_RATE, STRING_SIDEWAYS, forces, rates, turning_rate
from .certificate import Certificate, Functions, Proof

# gap of solid contact; largest later closing speed; largest gap of a rebound at that speed
CONTACT, FASTEST, REACH = sp.symbols("contact fastest reach", positive=True)
NEAREST, FARTHEST = sp.symbols("nearest farthest", positive=True)  # smallest and largest centre distance over a
SPUN_UP, LARGEST_MOMENTUM = sp.symbols("spun_up largest_momentum", real=True)  # the share s of L, J_max
LARGEST_PULL = sp.Symbol("largest_pull", positive=True)  # largest normal string force in the film
PANELS = 8
# outward: centrifugal force at J_max in contact; pull: normal string force there, at the present angle
# weighing: weight times the strings' stiffness, now
# scaled_momentum: J_max times the obliquity; with a number, its bound at the start of that panel
# decrease_by_cosine: decrease of the square of scaled_momentum over that of cos(beta)
# final_half_sine: sin(beta/2) where the outward force vanishes
# width: of a panel, rad; angle: beta at the start of each
OUTWARD, PULL, WEIGHING, SCALED_MOMENTUM, DECREASE_BY_COSINE, FINAL_HALF_SINE, WIDTH = sp.symbols(
    "outward pull weighing scaled_momentum decrease_by_cosine final_half_sine width", nonnegative=True
)
# of a part of the film: ratio of the gaps at its ends, the deeper one, its length, speed left by the film, and gained
RATIO, DEEPER, PATH, GAIN = sp.symbols("part_ratio deeper path gain", positive=True)
LEFT = sp.Symbol("left", real=True)
ANGLES = sp.symbols(f"angle_:{PANELS}", nonnegative=True)
SCALED_MOMENTA = sp.symbols(f"scaled_momentum_:{PANELS}", nonnegative=True)

PENDULUM = Structure(oblique=True, bridge=False, strings=True)


def admits(structure: Structure) -> bool:
    """True for the structures covered: oblique, on strings, with a film only."""
    alone = not (structure.bridge or structure.attraction or structure.friction)
    return structure.oblique and structure.strings and alone


def rigid_momentum(momentum: sp.Expr, distance: sp.Expr) -> sp.Expr:
    """r^2 omega over a^2 Omega in rigid rotation with this angular momentum."""
    inertia = nondimensional(doublet_inertia() / (q.m * q.a**2)).subs(DISTANCE, distance)
    return momentum * distance**2 / inertia


def pull_at(at: sp.Expr, angle: sp.Expr) -> sp.Expr:
    """Normal string force over m v0^2/x0 at this gap and angle."""
    return _swung(scaled_strings(oblique=True)[0], at, angle)


def _swung(force: sp.Expr, at: sp.Expr, angle: sp.Expr) -> sp.Expr:
    swing = scaled_strings(oblique=True)[2]
    whole = force.subs(offset_squared, swing).subs(DISTANCE, 4 + q.aspect * q.gap)
    return whole.subs({q.gap: at, q.beta: angle}, simultaneous=True)


def outward_at(momentum: sp.Expr, distance: sp.Expr) -> sp.Expr:
    """Centrifugal force over m v0^2/x0 for this orbital momentum and centre distance."""
    force = nondimensional(q.m * q.r * q.omega**2 / INERTIA)
    return force.subs({q.orbital_momentum: momentum, DISTANCE: distance}, simultaneous=True)


def torque_at(at: sp.Expr, angle: sp.Expr) -> sp.Expr:
    """Rate at which the strings take from J, over a^2 Omega v0/x0, at this gap and angle."""
    _, sideways, _ = scaled_strings(oblique=True)
    rate = rates(PENDULUM)[q.orbital_momentum]
    return _swung(-sp.expand(rate).coeff(STRING_SIDEWAYS) * sideways, at, angle)


def share(distance: sp.Expr) -> sp.Expr:
    """Fraction of L that is orbital momentum J in rigid rotation at this centre distance."""
    return rigid_momentum(sp.Integer(1), distance)


def turning_at(momentum: sp.Expr, distance: sp.Expr) -> sp.Expr:
    """Rate of beta (dbeta/dt) over v0/x0 for this orbital momentum and centre distance."""
    rate = turning_rate()
    assert rate is not None
    return rate.subs(ORBITAL_RATE, momentum / distance**2)


def impulse_by_angle(scaled_momentum: sp.Expr, pull: sp.Expr) -> sp.Expr:
    """(centrifugal force - pull) over dbeta/dt in contact; `scaled_momentum` is J times tan(impact angle)."""
    momentum = scaled_momentum / q.obliquity
    result = (outward_at(momentum, NEAREST) - PULL) / turning_at(momentum, NEAREST)
    return sp.factor(result).subs(PULL, pull)  # a single quotient: -infinity, and no NaN, at the end of the rotation


def decrease_by_cosine() -> sp.Expr:
    """Decrease of the squared `scaled_momentum` over that of cos(beta), with the stiffness of the present angle."""
    torque = torque_at(CONTACT, q.beta).subs(sp.sin(q.beta), 1) / _stiffness() / q.weight * WEIGHING
    per_angle = torque * q.obliquity**2 / turning_at(sp.Integer(1), NEAREST)
    return sp.simplify(2 * share(FARTHEST) * per_angle.subs(4 + q.aspect * CONTACT, NEAREST))


def _pull_by_stiffness(angle: sp.Expr) -> sp.Expr:
    """Least pull in contact at a later angle, with the stiffness of the present one (`weighing`)."""
    across = pull_at(CONTACT, q.beta) / _stiffness()
    risen = sp.expand(across / q.weight).subs(sp.sin(q.beta / 2) ** 2, (1 - sp.cos(angle)) / 2)
    return sp.expand(risen) * WEIGHING


def _stiffness() -> sp.Expr:
    (call,) = slot_calls(pull_at(CONTACT, q.beta))
    return call


def impulse_definitions() -> tuple[Definition, ...]:
    """Symbols of `impulse` and their expressions, each after those that it uses; the first are margins too."""
    final_angle = 2 * FINAL_HALF_SINE + (sp.pi - 2) * FINAL_HALF_SINE**3  # arcsin z <= z + (pi/2 - 1) z^3
    level = (OUTWARD / WEIGHING - _pull_by_stiffness(sp.Integer(0)) / WEIGHING) / 8  # sin(beta/2)^2 where it vanishes
    falls = (DECREASE_BY_COSINE * (sp.cos(q.beta) - sp.cos(angle)) for angle in ANGLES)
    momenta = (sp.sqrt(sp.Max(0, SCALED_MOMENTUM**2 - fall)) for fall in falls)
    return (
        (OUTWARD, outward_at(LARGEST_MOMENTUM, NEAREST)),
        (PULL, pull_at(CONTACT, q.beta)),
        (WEIGHING, q.weight * _stiffness()),
        (SCALED_MOMENTUM, LARGEST_MOMENTUM * q.obliquity),
        (DECREASE_BY_COSINE, decrease_by_cosine()),
        (FINAL_HALF_SINE, sp.sqrt(sp.Max(0, sp.Min(1, level)))),
        (WIDTH, sp.Max(0, final_angle - q.beta) / PANELS),
        *((angle, q.beta + k * WIDTH) for k, angle in enumerate(ANGLES)),
        *zip(SCALED_MOMENTA, momenta, strict=True),
    )


def impulse() -> sp.Expr:
    """Bound of the outward impulse from now on, over m v0."""
    panels = zip(SCALED_MOMENTA, map(_pull_by_stiffness, ANGLES), strict=True)
    return WIDTH * sp.Add(*(sp.Max(0, impulse_by_angle(momentum, pull)) for momentum, pull in panels))


def braking(structure: Structure, at: sp.Expr) -> sp.Expr:
    """Velocity, over v0/St, that the film takes from x0 to a gap: the film's call, but of its antiderivative."""
    (call,) = slot_calls(forces(structure)[FILM_FORCE].subs(FILM, 1))
    return slot_call("film", "braking", at, *call.args[1:])


def definitions(_structure: Structure = PENDULUM) -> tuple[Definition, ...]:
    """Symbols and their expressions, each after those that it uses, for the margins."""
    closing = sp.Min(q.normal_velocity, 0)
    return (
        (CONTACT, contact_gap),
        (NEAREST, 4 + q.aspect * CONTACT),
        (FARTHEST, 4 + q.aspect),
        (SPUN_UP, rigid_momentum(MOMENTUM, FARTHEST)),
        (LARGEST_MOMENTUM, sp.Max(q.orbital_momentum, SPUN_UP)),
        (LARGEST_PULL, pull_at(sp.Integer(1), sp.pi)),
        (FASTEST, sp.sqrt(closing**2 + 2 * LARGEST_PULL)),
        (REACH, sp.Max(CONTACT, slot_call("glass", "reach", FASTEST, q.glass_number))),
        *impulse_definitions(),
        (RATIO, sp.exp(sp.log(sp.Max(contact_gap, sp.nsimplify(DEEPEST_PART))) / APPROACH_PARTS)),
        (DEEPER, q.gap * RATIO),
        (PATH, q.gap - DEEPER),
        (LEFT, -q.normal_velocity - (braking(PENDULUM, DEEPER) - braking(PENDULUM, q.gap)) / q.stokes),
        (GAIN, LARGEST_PULL * PATH / sp.Max(LEFT, sp.sqrt(LARGEST_PULL * PATH / 2))),
    )


def functions(_structure: Structure = PENDULUM) -> Functions:
    """The margins; the cheap and usually decisive ones in functions of their own."""
    doc = "The strings outweigh the rotation from now on if outward < pull (lever arm at mid-gap)."
    yield "pendulum_inward", doc, {"outward": OUTWARD, "pull": PULL}
    doc = "Bound of the outward impulse of all forces but the film's from now on."
    yield "pendulum_impulse", doc, {"impulse": impulse()}
    taken = slot_call("film", "stopping", q.gap)
    doc = "The film then stops the opening and every rebound if film < 0 and recoil < 0, the impulse added."
    recoil = q.stokes * q.e_dry * FASTEST - slot_call("film", "stopping", REACH)
    yield "pendulum_stops", doc, {"film": q.stokes * q.normal_velocity - taken, "recoil": recoil}
    doc = "It stops a rebound from this gap and speed, or one from any smaller gap, if these are negative."
    faster = -q.normal_velocity + sp.sqrt(2 * LARGEST_PULL * q.gap)
    rebounds = {"rebound": -q.normal_velocity, "beneath": faster}
    yield "pendulum_rebounds", doc, {name: q.stokes * q.e_dry * speed - taken for name, speed in rebounds.items()}
    doc = (
        "Bounds over the next part of the film, from a gap and a bound of the closing speed there (the normal "
        "velocity): the part's end, the largest speed there and within it."
    )
    step = {"deeper_gap": DEEPER, "slowed": sp.Max(LEFT, 0) + GAIN, "fastest": GAIN - q.normal_velocity}
    yield "approach_step", doc, step


ROW = Certificate(
    "pendulum",
    "strings outweigh the rotation, and the film stops every rebound",
    (Proof("points_inward", "all forces but that of the film point inward",
           "outward - pull + margin*(outward + pull) < 0"),),
    ("pendulum_certificate",), admits, definitions, functions,
)  # fmt: skip
