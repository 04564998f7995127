"""Normal lubrication force of a thin film: the film pressure integrated over the wetted disc."""

from functools import cache

import sympy as sp

from ...vocabulary.quantities import R, a, aspect, gap, mu, u, volume, x, x0
from .base import Law, LawFunction
from .references import BARNOCKY, KANTAK, PITOIS, RAGER

_h = sp.Symbol("h", positive=True)
_rim = sp.Symbol("rim", positive=True)


@cache
def pressure() -> sp.Expr:
    """Film pressure p at local thickness h, from Reynolds' equation for axisymmetric squeeze flow.

    (1/s) d/ds (s h^3/(12 mu) dp/ds) = u with h = x + s^2/(2a), so s ds = a dh; regular on the axis; p = 0 at the
    rim of the film, h = x0.
    """
    s, thickness = sp.Symbol("s", nonnegative=True), x + sp.Symbol("s", nonnegative=True) ** 2 / (2 * a)
    flux = sp.integrate(12 * mu * u * s, s)  # s h^3 dp/ds, zero on the axis
    slope_over_h = sp.simplify(flux / (s * _h**3) / thickness.diff(s))  # dp/dh = (dp/ds)/(dh/ds)
    rise = sp.integrate(slope_over_h, _h)
    return sp.simplify(rise - rise.subs(_h, x0))


def _over_disc(integrand: sp.Expr, rim: sp.Expr) -> sp.Expr:
    """Integral of a function of h over the wetted disc x < h < rim (2 pi s ds = 2 pi a dh)."""
    return sp.integrate(sp.expand(integrand) * 2 * sp.pi * a, (_h, x, rim))


@cache
def normal_force() -> sp.Expr:
    """F_n, positive against separation: minus the pressure integrated over the disc h < x0."""
    return sp.factor(_over_disc(-pressure(), x0))


@cache
def unbounded_force() -> sp.Expr:
    """F_n of a film of unlimited extent: the limit x0 -> infinity, 6 pi mu a^2 u/x."""
    return sp.factor(sp.limit(sp.expand(normal_force()), x0, sp.oo))


@cache
def sustained_force() -> sp.Expr:
    """F_n while opening, of a liquid that sustains no tension: the pressure is cut off at ambient, max(p, 0).

    For u > 0 the pressure is proportional to -(1/h^2 - 1/x0^2) < 0 on the whole disc, so the force vanishes.
    """
    speed, inside = sp.Symbol("speed", positive=True), sp.Symbol("inside", positive=True)
    at = sp.factor(pressure().subs(u, speed).subs(x0, _h + inside))  # anywhere in the disc, h < x0
    return _over_disc(-sp.Max(at, 0), x0)


@cache
def rim_of_constant_volume() -> sp.Expr:
    """H = sqrt(x^2 + V_b/(pi a)): film thickness at the rim of the disc that holds the bridge volume V_b = V R^3."""
    filled = sp.factor(_over_disc(_h, _rim))  # pi a (H^2 - x^2)
    return next(root for root in sp.solve(sp.Eq(filled, volume * R**3), _rim) if root.is_positive)


@cache
def constant_volume_force() -> sp.Expr:
    """F_n with p = 0 at the rim h = H instead of h = x0."""
    return normal_force().subs(x0, _rim)


@cache
def axis_pressure() -> sp.Expr:
    """Pressure on the axis, h = x, where it is largest."""
    return sp.factor(pressure().subs(_h, x))


def _scaled_rim() -> sp.Expr:
    squared = rim_of_constant_volume() ** 2 / x0**2
    return sp.sqrt(sp.expand(squared.subs(x, gap * x0).subs(a, x0 / aspect)))


def _resistance(force: sp.Expr) -> sp.Expr:
    """A force over 6 pi mu a^2 u/x0, with all lengths (also the rim) in x0."""
    viscous_scale = 6 * sp.pi * mu * a**2 * u / x0
    return sp.factor((force / viscous_scale).xreplace({x: gap * x0, _rim: _rim * x0}))


def _taken(force: sp.Expr, name: str) -> LawFunction:
    """Integral of a film's resistance from the gap to the rim: the velocity, times St, that it takes on the way."""
    taken = sp.expand(sp.integrate(sp.expand(_resistance(force)), (gap, gap, 1)))
    return LawFunction(name, (gap,), taken, _TAKEN[name], for_proof=True)


_TAKEN = {
    "stopping": "Velocity, over v0/St, that the film takes from a doublet opening from this gap to x0.",
    "braking": "Velocity, over v0/St, that the film takes from an approach from x0 to this gap.",
}


def _braking_of_constant_volume() -> LawFunction:
    """`braking` of the film of constant volume; d rim/d gap = gap/rim, since rim^2 - gap^2 is constant."""
    taken = sp.log(gap) - 2 * sp.log(gap + _rim) + sp.log(_rim)
    slope = taken.diff(gap) + taken.diff(_rim) * gap / _rim
    if sp.simplify(slope - _resistance(constant_volume_force())) != 0:
        raise ArithmeticError("not an antiderivative of the resistance of a film of constant volume")
    whole = taken.subs({gap: 1, _rim: _scaled_rim().subs(gap, 1)}, simultaneous=True) - taken
    arguments, definitions = (gap, aspect, volume), ((_rim, _scaled_rim()),)
    return LawFunction("braking", arguments, whole, _TAKEN["braking"], definitions, for_proof=True)


_ANYWHERE = "Normal film force over 6 pi mu a^2 u/x0."
_INSIDE = "Normal film force over 6 pi mu a^2 u/x0, for a gap inside the film (gap < 1)."
_CLOSING = "Normal film force over 6 pi mu a^2 u/x0 while closing, for a gap inside the film (gap < 1)."


def _function(force: sp.Expr, doc: str = _INSIDE, name: str = "resistance", falls: bool = True) -> LawFunction:
    return LawFunction(name, (gap,), _resistance(force), doc, falls=falls)


def _uncavitated(force: sp.Expr) -> tuple[LawFunction, ...]:
    """The functions of a film with the same force on approach and rebound."""
    return _function(force), _taken(force, "stopping"), _taken(force, "braking")


FILMS = (
    Law(
        "film", "finite", "Reynolds film of finite thickness, the same on approach and rebound (no cavitation)",
        f"{KANTAK.short}; derived: pressure integrated over the disc h < x0", _uncavitated(normal_force()),
        references=(KANTAK,),
    ),
    Law(
        "film", "infinite",
        "no film correction: the pressure of an unbounded film, which ends where the surfaces leave it, x = x0",
        f"{RAGER.short}; derived: the limit x0 -> infinity of `finite`", _uncavitated(unbounded_force()),
        references=(RAGER,),
    ),
    Law(
        "film", "cavitating",
        "`finite` on approach; on rebound the liquid sustains no suction and cavitates, which leaves no force",
        f"{BARNOCKY.short}; derived: the pressure cut off at ambient",
        (
            _function(normal_force(), _CLOSING),
            _function(sustained_force(), "What of the resistance is left while opening.", "suction", falls=False),
            _taken(normal_force(), "braking"),
        ),
        references=(BARNOCKY,),
    ),
    Law(
        "film", "constant-volume",
        "the rim follows the bridge's liquid, H = sqrt(x^2 + V_b/(pi a)) in place of x0, at any gap",
        f"{PITOIS.short}; derived: a disc of that volume",
        (
            LawFunction("resistance", (gap, aspect, volume), _resistance(constant_volume_force()), _ANYWHERE,
                        ((_rim, _scaled_rim()),), falls=True),
            _braking_of_constant_volume(),
        ),
        references=(PITOIS,),
    ),
)  # fmt: skip
