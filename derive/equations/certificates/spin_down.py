"""Spin-down certificate: a film alone keeps a doublet without angular momentum, whose rotation dies out.

With L = 0 nothing is left of the rotation once the shear has stopped every slip, and then no force opens the film. Per
unit mass, with the lever arm at mid-gap and neither strings nor attractions, for any partner and any signs:

1. All rotation is slip. At a given gap the shear takes at least the share `rate` of the energy of rotation, E_rot, per
   time: twice the slower decay rate of the slips. They obey ds/dt = -A s, A a mobility of the slips times the friction,
   both symmetric and positive definite. A smaller mobility makes all decay rates smaller. The mobility has a part that
   falls with the distance and a part that rises; the logarithm of the friction falls with the gap. So each at its least
   up to a gap d gives a lower bound of A, and det A/tr A one of its smaller eigenvalue.
2. E_rot only changes by the shear and by the work of the centrifugal force C = 2 E_orb/r <= 2 E_rot/r: it falls while
   the doublet opens, E_rot r^2 falls while it closes, both at `rate` at least. Hence the impulse of C from now on, as
   long as the gap is below d, is at most 2 E_rot r^2/(r_contact^3 rate).
3. The film takes S(x) - S(d) over St from a doublet that opens from x to d, with S the integral of its resistance. So
   one that does not rebound never reaches d if St u + St impulse < S(x) - S(d).
4. Nothing pulls inward: a doublet that closes at -u is slowed, and one that opens never closes again. So there is at
   most one rebound, from a gap x' <= x, with e_dry (St |u| - S(x') + S(x)) over St at most, which is largest in excess
   of S(x') at x' = x. Both cases are one test: St max(u, -e_dry u) + St impulse < S(x) - S(d) (`stays` < 0).

L counts as zero below its own rounding error: it is the sum of an orbital part and of those of the spins. A little more
of it opens the film after all, but by no more than a force ~ L^2: a separation whose figures rounding of L decides.

Beyond the edge of the shear nothing changes J. So with J = 0 there, for any spins, a doublet stays head-on until it has
closed to the edge. The film stops it before if St |u| < S(edge) - S(x), and what opens, at once or after a rebound, if
St max(u, -e_dry u) < S(x), by 4 (`apart` < 0 at gaps where `inside` < 0).

Friction of the dry contact keeps L and never adds to E_rot (`checks.friction`), so that 1 to 4 hold with it. It may set
off J, so that what is said of J = 0 does not: `inside` is then positive.
"""

from dataclasses import replace

import sympy as sp

from ...physics.forces import SHEAR
from ...physics.law import Definition, filled, slot_call, slot_calls
from ...physics.scaling import DISTANCE
from ...physics.slots import MIDGAP
from ...physics.structure import Structure
from ...vocabulary import quantities as q
from ..events import contact_gap, start
from ..intermediates import SLIP, intermediates, rates
from ..observables import energies
from .certificate import Certificate, Functions, Proof

BEYOND, NEAR, FAR = sp.symbols("beyond near far", positive=True)  # d, and the distances in contact and at d, over a
RATE, LEAK, CONTACT, EDGE = sp.symbols("rate leak contact shear_end", positive=True)
FIRST = sp.Symbol("first_momentum", nonnegative=True)  # |L| at initial contact over its parts, beyond rounding
ROUNDING = sp.Float(2.0**-48)  # relative to the parts of L: some steps of doubles


def admits(structure: Structure) -> bool:
    """True for the structures covered: oblique in a plane, a film alone, no wall."""
    alone = not (structure.bridge or structure.attraction or structure.strings)
    return structure.oblique and alone and structure.partner not in ("wall", "space")


def _full(structure: Structure) -> Structure:
    return replace(structure, reduced=False)


def slips(structure: Structure) -> tuple[sp.Symbol, ...]:
    """The slips of the spheres, omega - xi_i, by name."""
    return tuple(s for s, _ in intermediates(_full(structure)) if s.name in (SLIP.name, "partner_slip"))


def decay(structure: Structure, near: sp.Expr, far: sp.Expr, logarithm: sp.Expr) -> sp.Matrix:
    """The matrix A of ds/dt = -A s, its mobility of the line of centres at `far`, of the spins at `near`, per v0/x0.

    It is that of the equations where both are the distance, and `logarithm` is the shear's at the gap.
    """
    full = _full(structure)
    states = [q.spin, q.partner_spin] if structure.partner else [q.spin]
    named, values = rates(full), dict(intermediates(full))
    symbols = {*slips(structure), DISTANCE, *(s for s in values if s.name in _SIZES)}

    def opened(expression: sp.Expr) -> sp.Expr:
        for symbol, value in reversed(list(values.items())):
            if symbol not in symbols:
                expression = expression.subs(symbol, value)
        expression = filled(expression, MIDGAP).subs(SHEAR, 1)
        return sp.expand(expression.xreplace(dict.fromkeys(slot_calls(expression), logarithm)))

    line = opened(named[q.orbital_momentum] / DISTANCE**2).subs(DISTANCE, far)
    turns = [opened(named[state]).subs(DISTANCE, near) for state in states]
    return sp.Matrix([[sp.factor(-(line - turn).coeff(s)) for s in slips(structure)] for turn in turns])


_SIZES = ("centres", "radius", "partner_radius", "spin_inertia", "partner_inertia")


def slowest(matrix: sp.Matrix) -> sp.Expr:
    """A lower bound of the smaller eigenvalue."""
    return matrix[0, 0] if matrix.rows == 1 else sp.factor(matrix.det()) / sp.factor(matrix.trace())


def definitions(structure: Structure) -> tuple[Definition, ...]:
    """Named intermediates of the margins, in order."""
    first = DISTANCE - q.aspect * q.gap
    return (
        (EDGE, slot_call("shear", "edge", q.aspect)),
        (BEYOND, (q.gap + sp.Min(1, EDGE)) / 2),
        (CONTACT, contact_gap),
        (NEAR, first + q.aspect * CONTACT),
        (FAR, first + q.aspect * BEYOND),
        (LEAK, slot_call("shear", "log_factor", BEYOND, q.aspect)),
        (RATE, 2 * slowest(decay(structure, NEAR, FAR, LEAK))),
        (FIRST, first_momentum(structure)),
    )


def impulse(structure: Structure) -> sp.Expr:
    """Bound of the impulse of the centrifugal force below d, over m v0."""
    rotating = energies(structure)["kinetic"] - q.normal_velocity**2 / 2
    return 2 * q.aspect * rotating * DISTANCE**2 / (NEAR**3 * RATE)


def functions(structure: Structure) -> Functions:
    """The margins."""
    doc = (
        "Margins of the spin-down certificate (lever arm at mid-gap, a shear that falls with the gap, L = 0): "
        "stays < 0 and rate > 0 exclude separation; momentum is |L| over its parts at the start, beyond rounding. "
        "So do apart < 0 and inside < 0 where J = 0."
    )
    film = slot_call("film", "stopping", q.gap)
    outward = q.stokes * sp.Max(q.normal_velocity, -q.e_dry * q.normal_velocity)
    yield (
        "spin_down_margins",
        doc,
        {
            "stays": outward + q.stokes * impulse(structure) - film + slot_call("film", "stopping", BEYOND),
            "rate": RATE,
            "apart": sp.Max(outward - film, film - slot_call("film", "stopping", EDGE) - q.stokes * q.normal_velocity),
            "inside": q.gap if structure.friction else EDGE - q.gap,
            "momentum": FIRST,
        },
    )


def first_momentum(structure: Structure) -> sp.Expr:
    """|L| at initial contact over the sum of its parts, in excess of its rounding error."""
    first, terms = start(_full(structure)), dict(intermediates(_full(structure)))
    (whole,) = (sp.expand(value) for symbol, value in terms.items() if symbol.name == "momentum")
    parts = [
        whole.coeff(state) * first[state] for state in (q.orbital_momentum, q.spin, q.partner_spin) if whole.has(state)
    ]
    size, sizes = (sp.Add(*(sp.Max(term, -term) for term in values)) for values in ((sp.Add(*parts),), parts))
    return sp.Max(size / sizes - ROUNDING, 0)


ROW = Certificate(
    "spin_down",
    "without angular momentum the rotation dies out, and a film alone keeps the doublet",
    (
        Proof("spins_down", "without angular momentum, or without orbital momentum, the film keeps the doublet",
              "gap >= contact*(1 - margin) and (momentum <= 0 and rate > 0 and stays < -error"
              " or orbital_momentum == 0 and inside < 0 and apart < -error)"),
    ),
    ("spin_down_certificate",), admits, definitions, functions, lambda _: ("FILM_STOPPING", "SHEAR_LOG_FACTOR_FALLS"),
)  # fmt: skip
