"""Checks of the pendulum certificate: each of its steps, on the emitted equations.

`equations/certificates/pendulum.py` combines the steps. The emitted margins are these bounds in the worst case.
"""

from functools import cache

import sympy as sp

from ..equations.certificates import pendulum
from ..equations.certificates.pendulum import PENDULUM, outward_at, pull_at, rigid_momentum
from ..equations.events import contact_gap
from ..equations.intermediates import BRIDGE_FORCE, CENTRIFUGAL_FORCE, FILM_FORCE, STRING_PULL, rates
from ..equations.model import Model, derive
from ..laws import LAWS, Law, filled, slot_call, slot_calls
from ..physics.forces import FILM, SHEAR
from ..physics.pendulum import offset_squared
from ..physics.scaling import DISTANCE
from ..vocabulary import quantities as q
from .base import MIDGAP, Check, Evidence, check, checks, checks_of, once, positive, readable

_HERE = 4 + q.aspect * q.gap
_HALF = sp.Symbol("half_angle_sine", nonnegative=True)  # sin(beta/2), which grows with beta up to half a turn


def _model() -> Model:
    return derive(PENDULUM)


def _by_shear() -> tuple[sp.Expr, dict[sp.Symbol, sp.Expr]]:
    """What the shear adds to dJ/dt, over its logarithm, and all rates without shear."""
    log_factor = sp.Function("shear.log_factor", real=True)(q.gap, q.aspect)
    rates = _model().by_state("right_hand_side")
    without = {state: rate.subs(log_factor, 0) for state, rate in rates.items()}
    return (rates[q.orbital_momentum] - without[q.orbital_momentum]) / (SHEAR * log_factor), without


@check("strings only take from L", "dL/dt = -r S_t <= 0 while 0 <= beta <= pi")
def momentum_falls() -> Evidence:
    """dL/dt = -r S_t, and S_t has the sign of sin(beta); only the strings exert a torque on the doublet."""
    result = _model().by_state("right_hand_side")
    total = filled(result[q.orbital_momentum] + sp.Rational(32, 5) * result[q.spin], MIDGAP)
    swing = dict(_model().definitions)[offset_squared].subs(DISTANCE, _HERE)
    share = sp.simplify(total / (sp.sin(q.beta) * slot_call("strings", "stiffness", q.string_ratio, swing)))
    yield from (positive(-share), f"dL/dt ~ {share} sin(beta)")


@check("J stays below J_max", "dJ/dt <= 0 where J > L r^2/(r^2 + (32/5) a^2), a share that grows with r and with L")
def orbital_momentum_is_bounded() -> Evidence:
    """J decreases where it exceeds its share of L in rigid rotation, and that share grows with the gap and with L."""
    share = rigid_momentum(q.orbital_momentum + sp.Rational(32, 5) * q.spin, DISTANCE)
    slip = _model().expanded(q.orbital_momentum / DISTANCE**2 - q.spin).subs(DISTANCE, _HERE)
    inverse = 1 / DISTANCE**2 + sp.Rational(5, 32)
    yield slip - ((q.orbital_momentum - share) * inverse).subs(DISTANCE, _HERE)
    shear = sp.simplify(_by_shear()[0] / slip)  # dJ/dt contains only this, with the sign of the slip, and the strings
    rigid = rigid_momentum(sp.Symbol("momentum", positive=True), DISTANCE)
    yield all(map(positive, (-shear, sp.together(rigid.diff(DISTANCE)), rigid)))
    yield f"omega - xi = (J - J_rigid) ({sp.simplify(inverse)})"


@checks
def pull_grows() -> tuple[Check, ...]:
    """S_n grows with the gap and with the angle, for both string laws."""
    checks = []
    for name, law in LAWS["strings"].items():
        pull = filled(pull_at(q.gap, q.beta), {"strings": law}).subs(sp.sin(q.beta / 2), _HALF)
        # 2 * stiffness'/stiffness^3 > 0 and swing' > 0, numerator' > 0: written out in d(pull)
        stiffness = law["stiffness"].result
        hanging = sp.Symbol("hanging", positive=True)  # vertical extent squared, string_ratio^2 - offset_squared
        steeper = stiffness.diff(offset_squared).subs(offset_squared, q.string_ratio**2 - hanging)
        swing = (q.aspect * q.gap) ** 2 / 4 + _HERE * 4 * _HALF**2
        across = sp.simplify(pull / stiffness.subs(offset_squared, swing))
        grows = [positive(slope) for by in (q.gap, _HALF) for slope in (across.diff(by), swing.diff(by))]
        ok = all(grows) and positive(across) and sp.simplify(steeper).is_nonnegative is True
        statement, figure = "dS_n/dr >= 0 and dS_n/dbeta >= 0 up to beta = pi", sp.factor(across / q.weight)
        checks.append(Check(f"S_n grows, {name} strings", statement, ok, f"S_n ~ ({figure}) stiffness"))
    return tuple(checks)


@check("J^2/r^3 falls", "d(J^2/r^3)/dr < 0 at fixed J")
def centrifugal_falls() -> Evidence:
    """At a given J the centrifugal force decreases with the distance."""
    slope = outward_at(sp.Symbol("momentum", positive=True), DISTANCE).diff(DISTANCE)
    yield from (positive(-slope), str(sp.factor(slope)))


@check("the film stops", "d(u St/v0)/dx = -resistance - St (inward)/u <= -resistance")
def film_stops() -> Evidence:
    """While opening against an inward force, u - stopping(gap)/St never grows."""
    stopping, resistance = (LAWS["film"]["finite"][name].result for name in ("stopping", "resistance"))
    opened = rates(PENDULUM)[q.normal_velocity]
    yield from (stopping.diff(q.gap) + resistance, stopping.subs(q.gap, 1), opened.diff(BRIDGE_FORCE))
    yield from (opened.coeff(FILM_FORCE) + 1, opened.coeff(CENTRIFUGAL_FORCE) - 1)
    film = dict(_model().definitions)[FILM_FORCE].diff(q.normal_velocity) * q.stokes / FILM
    yield film - slot_call("film", "resistance", q.gap)


@check("reach of the glass criterion, {0.name}", "pressure(reach(u), u) = p_gt; larger for a larger u")
def reach_of(law: Law) -> Evidence:
    """`reach` is the largest gap at which a glass criterion is met for a given speed, and grows with the speed."""
    speed = sp.Symbol("approach", positive=True)
    pressure, at = law["pressure"], law["reach"](speed, q.glass_number)
    yield pressure(at, speed) - q.glass_number
    for slope in (-pressure(q.gap, speed).diff(q.gap), at.diff(speed)):
        yield sp.simplify(slope).is_positive
    yield str(at)


@checks
def criterion_reach() -> tuple[Check, ...]:
    """`reach_of` the library's criteria."""
    return tuple(map(reach_of, LAWS["glass"].values()))


@cache
def pendulum_certificate() -> tuple[Check, ...]:
    """Every step of the pendulum certificate."""
    return tuple(result for test in checks_of(__name__) for result in once(test))


# ---- the emitted margins


def _bounds() -> dict[str, tuple[sp.Expr, str]]:
    """Each margin with its lemma at the gap, angle and speed of the worst case, and a description."""
    rigid = rigid_momentum(q.orbital_momentum + sp.Rational(32, 5) * q.spin, 4 + q.aspect)
    most = 2 * pull_at(sp.Integer(1), sp.pi)
    fastest = sp.sqrt(sp.Min(q.normal_velocity, 0) ** 2 + most)
    reach = sp.Max(contact_gap, slot_call("glass", "reach", fastest, q.glass_number))

    def margin(velocity: sp.Expr, at: sp.Expr = q.gap) -> sp.Expr:
        return q.stokes * velocity - slot_call("film", "stopping", at)

    speed = -q.normal_velocity
    outward = outward_at(sp.Max(q.orbital_momentum, rigid), 4 + q.aspect * contact_gap)
    return {
        "outward": (outward, "J_max^2/r^3, J_max of r_f, r in contact"),
        "pull": (pull_at(contact_gap, q.beta), "S_n in contact at the present beta"),
        "film": (margin(q.normal_velocity), "u St/v0 - Lf(x)"),
        "recoil": (
            margin(q.e_dry * fastest, reach),
            "e_dry u_max St/v0 - Lf(x_R), u_max^2 = min(u, 0)^2 + 2 S_n(x0, pi) x0/m, x_R = max(contact, reach(u_max))",
        ),
        "rebound": (margin(q.e_dry * speed), "e_dry |u| St/v0 - Lf(x)"),
        "beneath": (
            margin(q.e_dry * (speed + sp.sqrt(most * q.gap))),
            "the same with |u| + sqrt(2 S_n(x0, pi) x/m), the most that closing from x adds",
        ),
    }


@checks
def margins_are_the_lemmas() -> tuple[Check, ...]:
    """The emitted margins are the lemmas' bounds: at contact, at initial contact and half a turn, and at present.

    `impulse` has its own check, `impulse_as_emitted`.
    """
    checks = []
    margins = {key: value for row in pendulum.functions() for key, value in row[2].items()}
    for name, (bound, words) in _bounds().items():
        emitted = _model().expanded(margins[name])
        same = sp.expand(emitted - _model().expanded(bound)) == 0  # same Max and calls: no need to simplify
        figure = "identity" if same else f"emitted is {readable(emitted)}"
        checks.append(Check(f"margin of the stick proof: {name}", f"{name} = {words}", same, figure))
    return tuple(checks)


@check("closing gains the pull", "d(u^2/2)/dx = -S_n/m + what slows: u_max^2 - u^2 <= 2 S x0/m")
def closing_gains_the_pull() -> Evidence:
    """u_max: while closing, only the strings increase the speed, by their pull over a gap of at most x0."""
    yield from (
        rates(PENDULUM)[q.normal_velocity].coeff(STRING_PULL) + 1,  # du/dt = u du/dx, over v0^2/x0
        _model().expanded(STRING_PULL) - pull_at(q.gap, q.beta),  # the bound of the lemmas is the emitted one
        _model().expanded(CENTRIFUGAL_FORCE) - outward_at(q.orbital_momentum, _HERE),
    )


@check("stopping falls", "dLf/dx <= 0: the furthest rebound is the worst")
def stopping_falls() -> Evidence:
    """Lf decreases with the gap, so a velocity stopped by the film from x_R is stopped from any smaller gap."""
    slope = sp.factor(LAWS["film"]["finite"]["stopping"].result.diff(q.gap))
    yield from (sp.factor(-slope).is_nonnegative, f"dLf/dx = {slope}")


# ---- the bound of the impulse


_MOMENTUM, _PULL, _RISE = sp.symbols("momentum pull rise", positive=True)


def _share(distance: sp.Expr) -> sp.Expr:
    return distance**2 / (distance**2 + sp.Rational(32, 5))


def _integrand(momentum: sp.Expr, distance: sp.Expr) -> sp.Expr:
    return (pendulum.outward_at(momentum, distance) - _PULL) / pendulum.turning_at(momentum, distance)


@check("J falls with the strings' torque", "J <= J_max - s D, dD/dt = r S_t, s < 1 grows with r")
def strings_take() -> Evidence:
    """On the level J = J_max - s D, F_t and the strings reduce J by more than s times what the strings take.

    There J >= s L, with s the largest share: F_t reduces J, and the strings take the whole of what they take from L.
    """
    shear, alone = _by_shear()
    torque = _model().expanded(pendulum.torque_at(q.gap, q.beta))
    turned = alone[q.beta] - pendulum.turning_at(q.orbital_momentum, _HERE)
    yield from (alone[q.orbital_momentum] + torque, alone[q.spin], turned)
    reduces = sp.simplify(-sp.simplify(shear) / (q.orbital_momentum / _HERE**2 - q.spin))
    grows, below = _share(DISTANCE).diff(DISTANCE), 1 - _share(DISTANCE)
    yield all(map(positive, (reduces, sp.together(grows), sp.together(below))))
    yield f"dJ/dt = -r S_t - ({reduces}) (omega - xi)"


@check("least torque", "J^2 <= J_max^2 - 2 s r^3 S (cos(beta_0) - cos(beta))")
def torque_is_least_in_contact() -> Evidence:
    """r^3 S_t grows with the gap and the stiffness, which grows with the swing: least in contact, at the first angle.

    With J dD/dbeta >= S sin(beta), J^2 falls by `decrease_by_cosine` (cos(beta_0) - cos(beta)) at least.
    """
    (stiffness,) = slot_calls(torque := pendulum.torque_at(q.gap, q.beta))
    bare = sp.simplify(torque / pendulum.turning_at(sp.Integer(1), _HERE) / stiffness / sp.sin(q.beta))
    named = dict(_model().definitions)
    weighing = named[pendulum.WEIGHING] / q.weight
    swing = weighing.args[1].subs(q.beta, 2 * sp.asin(_RISE))
    in_contact = bare.subs(q.gap, contact_gap) * weighing.subs(named) * q.obliquity**2
    bound = 2 * _share(pendulum.FARTHEST) * in_contact.subs(4 + q.aspect * contact_gap, pendulum.NEAREST)
    yield _model().expanded(pendulum.DECREASE_BY_COSINE) - _model().expanded(bound)
    yield all(map(positive, (bare, sp.together(bare.diff(q.gap)), sp.expand(swing.diff(_RISE)))))
    yield f"r^3 S_t ~ {bare}"


@check("impulse by angle", "grows with J, falls with r and S_n: largest in contact")
def integrand_is_largest_in_contact() -> Evidence:
    """(J^2/r^3 - S_n)/(J/r^2) grows with J and falls with r and S_n, which grows with r and beta (`pull_grows`)."""
    result = _integrand(_MOMENTUM, DISTANCE)
    slopes = (result.diff(_MOMENTUM), -result.diff(DISTANCE), -result.diff(_PULL))
    yield from (all(map(positive, map(sp.together, slopes))), str(sp.factor(result)))


@check("arcsine", "arcsin(z) <= z + (pi/2 - 1) z^3, equal at z = 1")
def angle_is_beyond() -> Evidence:
    """arcsin(z) <= z + (pi/2 - 1) z^3 up to z = 1, where both are equal: (arcsin(z) - z)/z^3 has positive terms."""
    z, n = sp.Symbol("z"), sp.Symbol("n", integer=True, positive=True)
    yield sp.asin(1) - 1 - (sp.pi / 2 - 1)
    first = sp.series(sp.asin(z), z, 0, 12).removeO()
    coefficient = sp.binomial(2 * n, n) / (4**n * (2 * n + 1))
    yield from [first.coeff(z, 2 * k + 1) - coefficient.subs(n, k) for k in range(1, 6)]


@check("impulse: as emitted", "left sums of the falling integrand, up to where it has vanished")
def impulse_as_emitted() -> Evidence:
    """The emitted impulse sums the integrand at the start of equal panels up to the angle at which it has vanished."""
    model = _model()
    named = dict(model.definitions)
    risen = q.aspect * contact_gap + 8 * sp.sin(q.beta / 2) ** 2
    yield model.expanded(pendulum.WEIGHING) * risen - model.expanded(pendulum.pull_at(contact_gap, q.beta))
    yield named[pendulum.SCALED_MOMENTUM] - q.obliquity * pendulum.LARGEST_MOMENTUM
    # at sin(beta/2) = final_half_sine the pull, with the present stiffness, equals the centrifugal force of J_max
    level = named[pendulum.FINAL_HALF_SINE].args[0]
    (zero,) = (argument for argument in next(iter(level.atoms(sp.Min))).args if argument != 1)
    yield model.expanded(pendulum.WEIGHING * (q.aspect * contact_gap + 8 * zero) - pendulum.OUTWARD)
    ahead = 2 * pendulum.FINAL_HALF_SINE + (sp.pi - 2) * pendulum.FINAL_HALF_SINE**3 - q.beta
    yield named[pendulum.WIDTH] * pendulum.PANELS - sp.Max(0, ahead)
    total = sp.Integer(0)
    for k, (angle, later) in enumerate(zip(pendulum.ANGLES, pendulum.SCALED_MOMENTA, strict=True)):
        yield named[angle] - q.beta - k * pendulum.WIDTH
        fall = pendulum.DECREASE_BY_COSINE * (sp.cos(q.beta) - sp.cos(angle))
        yield named[later] ** 2 - sp.Max(0, pendulum.SCALED_MOMENTUM**2 - fall)
        pull = pendulum.WEIGHING * (q.aspect * contact_gap + 4 * (1 - sp.cos(angle)))
        result = _integrand(later / q.obliquity, pendulum.NEAREST)
        total += sp.Max(0, sp.factor(result).subs(_PULL, pull))
    emitted = model["pendulum_impulse"]["impulse"]
    first = {symbol: value for symbol, value in model.definitions if symbol.name == "contact"}
    parts = [sp.expand(factor.subs(first)) for factor in sp.Mul.make_args(emitted) if factor != pendulum.WIDTH]
    ours = sorted((sp.expand(term.args[1]) for term in total.args), key=str)
    theirs = sorted((sp.expand(term.args[1]) for factor in parts for term in sp.Add.make_args(factor)), key=str)
    yield from [a - b for a, b in zip(ours, theirs, strict=True)]


# ---- the bound of the closing speed from initial contact on


@check("{1}: {0.name}", "dB/dx = -resistance, B(x0) = 0")
def taken_by(law: Law, name: str) -> Evidence:
    """A film's `stopping` or `braking` is the integral of its resistance between a gap and x0."""
    taken, resistance = (law[key](*law[key].arguments) for key in (name, "resistance"))
    yield from (taken.diff(q.gap) + resistance, taken.subs(q.gap, 1))


@checks
def braking_is_the_films() -> tuple[Check, ...]:
    """`taken_by` the library's films."""
    return tuple(taken_by(law, "braking") for law in LAWS["film"].values())


@check("approach: closing speed", "dw/dy <= P/w - g/St, and the bound of w rises as fast")
def closing_speed() -> Evidence:
    """Two upper bounds of the closing speed w over the depth y = x0 - x, at a pull of at most P, rise as fast as w.

    dw/dy = (S_n - C)/w - g/St, strings S_n <= P, centrifugal force C >= 0, resistance g of the film. A bound z of w
    holds if it rises by P/z - g/St at least where w reaches it. Without the film's part, P y/w' with the speed w' that
    the film alone would leave, and sqrt(2 P y) do: z >= w', z >= sqrt(2 P y). At w' = sqrt(P y/2) both gains agree, so
    that the larger denominator takes the smaller gain.
    """
    model = _model()
    rate = model.expanded(model["right_hand_side"]["normal_velocity"])
    film, inward = model.expanded(FILM_FORCE), model.expanded(model["inward_force"]["inward_force"])
    yield rate + film + inward
    resistance = sp.Function("film.resistance", real=True)(*pendulum.braking(PENDULUM, q.gap).args)
    yield film - FILM * q.normal_velocity * resistance / q.stokes
    yield inward.subs(q.orbital_momentum, 0) - model.expanded(pull_at(q.gap, q.beta))
    pull, depth, remainder = sp.symbols("pull depth left", positive=True)
    straight, rooted = pull * depth / remainder, sp.sqrt(2 * pull * depth)
    yield from (straight.diff(depth) * remainder - pull, rooted.diff(depth) * rooted - pull)
    yield straight.subs(remainder, sp.sqrt(pull * depth / 2)) - rooted


@check("approach: as emitted", "the step is the bound")
def step_as_emitted() -> Evidence:
    """The emitted step is this bound, with the largest pull, over a part of the film."""
    model, deeper = _model(), pendulum.DEEPER
    named = dict(model.definitions)
    yield from (named[pendulum.LARGEST_PULL] - pull_at(sp.Integer(1), sp.pi), named[deeper] - q.gap * pendulum.RATIO)
    yield named[pendulum.RATIO] ** 24 - sp.Max(contact_gap, sp.Rational(1, 100))
    taken = pendulum.braking(PENDULUM, deeper) - pendulum.braking(PENDULUM, q.gap)
    rest, work = -q.normal_velocity - taken / q.stokes, pendulum.LARGEST_PULL * (q.gap - deeper)
    gain = work / sp.Max(rest, sp.sqrt(work / 2))
    wanted = {
        "deeper_gap": q.gap * pendulum.RATIO,
        "slowed": sp.Max(rest, 0) + gain,
        "fastest": gain - q.normal_velocity,
    }
    for name, value in wanted.items():
        result = model["approach_step"][name]
        for symbol in (pendulum.GAIN, pendulum.LEFT, pendulum.PATH):
            result = result.subs(symbol, named[symbol])
        yield result - value.subs(q.gap * pendulum.RATIO, deeper)
