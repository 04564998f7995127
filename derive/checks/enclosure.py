"""Bounds of the enclosing engine: one step of a relaxing state between bounds of its rate and of the rate's slope."""

import sympy as sp

from ..equations.intermediates import MOMENTUM, ORBITAL_RATE
from ..equations.model import derive, without_partner_spin
from ..equations.observables import excess_energy
from ..physics.structure import Structure, structures
from ..vocabulary import quantities as q
from .base import SIZES, Evidence, check

_h, _s, _r, _y = sp.symbols("h s r y", positive=True)  # distance, steepness, size of the rate, height
_PAIR = Structure(True, True, False, partner="pair")


@check("bounds of a panel", "y' = r - s y, y(0) = 0: r h/(1 + s h) <= y(h) <= min(r h, r/s)")
def relaxation_is_bounded() -> Evidence:
    """The implicit step is below the exact rise, the line and the level that it tends to are above it.

    The exact rise solves its equation. Each difference, over what is positive, vanishes at s h = 0 with a slope of one
    sign: with z = s h, e^z - 1 - z and z - 1 + e^-z start at 0 with slopes e^z - 1 and 1 - e^-z.
    """
    z = sp.Symbol("z", positive=True)
    exact = _r * (1 - sp.exp(-_s * _h)) / _s
    yield exact.diff(_h) - (_r - _s * exact)
    yield exact.subs(_h, 0)
    implicit = (exact - _r * _h / (1 + _s * _h)).subs(_h, z / _s)
    above = sp.exp(z) - 1 - z
    yield implicit - _r * sp.exp(-z) * above / (_s * (1 + z))
    line = (_r * _h - exact).subs(_h, z / _s)
    below = z - 1 + sp.exp(-z)
    yield line - _r * below / _s
    yield from (above.subs(z, 0), below.subs(z, 0))
    yield from ((above.diff(z) - (sp.exp(z) - 1)), below.diff(z) - (1 - sp.exp(-z)))
    yield ((sp.exp(z) - 1).is_positive is not False, "e^z - 1 is positive")
    yield _r / _s - exact - _r * sp.exp(-_s * _h) / _s  # the level is above by what is positive


@check(
    "rupture within a panel",
    "bounds of a panel change one way over the distance: any y(s), s < h, is between both ends",
)
def rupture_is_between_bounds() -> Evidence:
    """What ruptures before the end of a panel lies between the bounds at its start and at its end.

    Of a rate to one side the implicit step r h/(1 + s h), the line r h and a level do not turn back. So over all panels
    from the least rupture gap on, the bounds at their ends hold the state of each pair where it ruptures.
    """
    steps = (_r * _h / (1 + _s * _h), _r * _h, sp.Min(_r * _h, _r / _s))
    for bound in steps:
        yield bound.subs(_h, 0)
    implicit, line, _ = steps
    yield implicit.diff(_h) - _r / (1 + _s * _h) ** 2
    yield line.diff(_h) - _r
    yield ((_r / (1 + _s * _h) ** 2).is_positive is True and _r.is_positive is True, "a bound falls back")


@check("energy over the gap", "w = u^2/2: dw/dx = du/dt where u > 0, and its slope by w is that by u, over u")
def gap_replaces_time() -> Evidence:
    """The chain rule behind the bounds over the gap, for any rate of the normal velocity."""
    t = sp.Symbol("t")
    u, x = sp.Function("u")(t), sp.Function("x")(t)
    w = u**2 / 2
    over_gap = w.diff(t) / x.diff(t)
    yield over_gap.subs(x.diff(t), u) - u.diff(t)
    rate, speed = sp.Function("a"), sp.Symbol("speed", positive=True)
    of_w = rate(sp.sqrt(2 * _y)).diff(_y).doit().subs(_y, speed**2 / 2)
    expected = rate(_s).diff(_s).subs(_s, speed) / speed
    yield sp.simplify((of_w - expected).doit())


@check(
    "logarithm by one correction",
    "d - d^2 <= log(1 + d) <= d for |d| <= 1/2; exp: the rest is 1 to 1.05 times its first term",
)
def remainders_are_bounded() -> Evidence:
    """The bounds that the runtime's logarithm and exponential use.

    d - log(1 + d) is 0 at 0 with slope d/(1 + d), and log(1 + d) - d + d^2 with slope d (1 + 2 d)/(1 + d): both change
    their sign at 0 alone within |d| < 1/2, upwards. The terms of exp(r) from the sixteenth on are below a geometric
    series of ratio r/17, where r is at most log 2 and what rounding adds to it, less than 0.7.
    """
    d = sp.Symbol("d", real=True)
    yield (d - sp.log(1 + d)).diff(d) - d / (1 + d)
    yield (sp.log(1 + d) - d + d**2).diff(d) - d * (1 + 2 * d) / (1 + d)
    yield (
        bool(sp.log(2) < 0.7 and 1 / (1 - sp.Rational(7, 170)) < 1.05),
        "the geometric series is below 1.05 times its first term",
    )
    yield (
        bool(sp.Rational(33, 10) ** 36 / sp.factorial(36) * 2 < sp.Float("1e-22", 30)),
        "the rest of sine and cosine",
    )


@check("energy above the least", "E = E_least + u^2/2 + sum of A_i A_j (omega_i - omega_j)^2 / sum of A_i, A_i > 0")
def excess_is_of_squares() -> Evidence:
    """The energy that the runtime counts above the least at the same gap, in the structures that are enclosed."""
    for structure in (*(item for item in structures() if item.reduced), _PAIR, Structure(False, True, False)):
        model = derive(structure)
        energy = sp.Add(*model["energies"].by_name.values())
        least = model["effective_potential"]["energy"]
        yield model.expanded(energy - least - excess_energy(energy), SIZES)
        for rate in (ORBITAL_RATE, q.spin, q.partner_spin):
            moment = model.expanded(energy.diff(rate, 2)).subs(q.obliquity, sp.Symbol("tangent", positive=True))
            yield (moment == 0 or sp.factor(moment).is_positive is True, "a moment is not positive")


@check("pair over intervals", "the partner's spin from L(0): L stays L(0), from the spin at initial contact on")
def partner_spin_follows() -> Evidence:
    """The spin that is no state there gives the angular momentum of initial contact, which is kept (`partners`)."""
    full, enclosed = derive(_PAIR), without_partner_spin(derive(_PAIR))
    spin, momentum = enclosed.expanded(q.partner_spin), full.expanded(MOMENTUM)
    yield momentum.subs(q.partner_spin, spin) - enclosed.expanded(MOMENTUM)
    first = {state: enclosed["start"][state.name] for state in enclosed.states}
    yield enclosed.expanded(spin.subs(first, simultaneous=True)) - q.initial_partner_spin


@check(
    "contact for good",
    "v' >= f - k v falls by g within 2 g k/f + (2 g/f)^(1/2); momenta do not depend on u, the film force is k u",
)
def rebounds_stay_low() -> Evidence:
    """What the runtime assumes of rebounds: the time of a fall, and how u enters the rates.

    Twice integrated, v + k s >= f t and s + k g t >= f t^2/2, which at the bound exceeds s = g by a product of positive
    factors.
    """
    f, g, k = sp.symbols("f g k", positive=True)
    bound = 2 * g * k / f + sp.sqrt(2 * g / f)
    beyond = sp.simplify(f * bound**2 / 2 - k * g * bound - g)
    yield (beyond.is_positive is True, f"{beyond} is not positive")
    for structure in (*(item for item in structures() if item.reduced), _PAIR, Structure(False, True, False)):
        model = derive(structure)
        for state, rate in model.by_state("right_hand_side").items():
            if state != q.gap:
                yield sp.diff(rate, q.normal_velocity, 2 if state == q.normal_velocity else 1)
