"""The theory of the paper's Table 1 as lines of equations: SI equations of the derivation with the laws filled in."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import sympy as sp

from ...equations.automaton import CRITERIA
from ...equations.events import rebound
from ...laws import LAWS, Law, fill, slot_calls
from ...physics import mechanics, scaling
from ...physics.contact_friction import equal_spheres
from ...physics.forces import FILM, SHEAR, force_laws
from ...physics.pendulum import r as string_distance
from ...physics.pendulum import swing_squared
from ...physics.terms import Terms
from ...vocabulary import quantities as q
from .latex import latex

DEFAULTS: Mapping[str, str] = {
    "film": "finite", "shear": "immersed", "arm": "midgap", "glass": "literal", "bridge": "mikami", "strings": "exact",
}  # fmt: skip
"""The law of each slot where no other is asked for."""

_SWING, _COMPLIANCE = sp.symbols("swing compliance", positive=True)  # distance d of the strings, theta_e of the spheres
_SLIP, _TANGENTIAL_MASS, _IMPULSE = sp.symbols("v_s m_t Q")
_RIM = sp.Symbol("rim", positive=True)  # rim H of a film of constant volume, in SI
_ROMAN = ("i", "ii", "iii", "iv", "v", "vi", "vii", "viii", "ix", "x")
_ADDED = {
    "gap": (mechanics.M_x, mechanics.Q_x), "rotation": (mechanics.M_beta, mechanics.Q_beta),
    "spin": (mechanics.M_spin, mechanics.Q_spin),
}  # fmt: skip
_TWO_FIFTHS = sp.Rational(2, 5)


@dataclass(frozen=True)
class Equation:
    """One line `left relation right` under a heading; `expression` is the right side as derived."""

    group: str
    left: str
    expression: sp.Expr
    note: str = ""
    relation: str = "="

    @property
    def latex(self) -> str:
        return f"{self.left} {self.relation} {latex(self.expression)}"


def theory(
    choice: Mapping[str, str | Law] | None = None, friction: bool = False, terms: Terms | None = None
) -> tuple[Equation, ...]:
    """Every line of the theory, with laws from `choice` (slot to name, or a law in SI) or else the default ones.

    Arguments:
        friction: of the dry contact.
        terms: of a model file.
    """
    chosen = {**DEFAULTS, **(choice or {})}
    laws = {slot: law if isinstance(law, Law) else LAWS[slot][law] for slot, law in chosen.items()}
    parts = (
        _motion(laws, terms),
        _film(laws),
        _bridge(laws["bridge"]),
        _attraction(laws),
        _strings(laws),
        _course(laws),
    )
    rubbing = tuple(_friction(laws)) if friction else ()
    return (*(line for section in parts for line in section), *rubbing, *_groups())


def _rate(symbol: sp.Symbol) -> str:
    return rf"\frac{{d {latex(symbol)}}}{{dt}}"


def _motion(laws: Mapping[str, Law], terms: Terms | None) -> Iterator[Equation]:
    group, motion = "Motion", mechanics.equations_of_motion()
    masses, forces = dict[sp.Symbol, sp.Expr](), dict[sp.Symbol, sp.Expr]()
    heavier, more = dict.fromkeys(_ADDED, sp.S.Zero), dict.fromkeys(_ADDED, sp.S.Zero)
    for on, parts in terms.parts.items() if terms else ():
        for symbol, term, named, into in zip(_ADDED[on], parts, (masses, forces), (heavier, more), strict=True):
            if term != 0:
                named[symbol] = term
                into[on] = symbol
    opened = motion.separation_acceleration.subs({} if "attraction" in laws else {mechanics.F_w: 0})
    radial = sp.collect(sp.expand(q.m * opened), q.omega**2, evaluate=False)
    balance = sp.Add(*(sp.factor(term) * power if power != 1 else term for power, term in radial.items()))
    lever = sp.expand(fill(force_laws()[mechanics.arm], laws))
    turning = sp.simplify(mechanics.sphere_inertia() * motion.spin_acceleration).subs(mechanics.arm, lever)
    yield Equation(group, _rate(q.x), q.u, "gap; the paper's $v_n$ is $-u$")
    yield Equation(group, _rate(q.beta), q.omega, "angle of the line of centres")
    pushed = f"{_mass(q.m + heavier['gap'])} {_rate(q.u)}"
    yield Equation(group, pushed, balance + more["gap"], "along the line of centres")
    momentum = rf"\frac{{d}}{{dt}} \left[ {latex(motion.orbital_momentum)} \right]"
    momentum += f" + {latex(heavier['rotation'])} {_rate(q.omega)}" if heavier["rotation"] != 0 else ""
    yield Equation(group, momentum, motion.orbital_momentum_rate + more["rotation"], "across the line of centres")
    spun = f"{_mass(mechanics.sphere_inertia() + heavier['spin'] / 2)} {_rate(q.xi)}"
    yield Equation(group, spun, turning + more["spin"] / 2, f"spin of each sphere ({laws['arm'].name} arm)")
    scaled, square = sp.expand(mechanics.doublet_inertia() / (q.m * q.a**2)), (4 + q.x / q.a) ** 2  # as in the paper
    inertia = sp.Mul(q.m * q.a**2, square + sp.expand(scaled - square), evaluate=False)
    yield Equation(group, f"I({latex(q.x)})", inertia, "inertia in rigid rotation")
    yield from (Equation("Declared terms", latex(symbol), value) for symbol, value in (masses | forces).items())


def _mass(inertia: sp.Expr) -> str:
    return rf"\left( {latex(inertia)} \right)" if inertia.is_Add else latex(inertia)


def _film(laws: Mapping[str, Law]) -> Iterator[Equation]:
    inside = {FILM: 1, SHEAR: 1}
    # written with the factor 1 - x/x0 instead of x0 - x
    law = laws["film"]
    resistance = law["resistance"]
    rim = dict(resistance.definitions).get(_RIM) if law.spread else None
    whole = force_laws(law.spread)[mechanics.F_n].subs(inside)
    (call,) = slot_calls(whole)
    arguments = dict(zip(resistance.arguments, call.args, strict=True))
    result = resistance.result if rim is not None else resistance(*resistance.arguments)
    named = result.subs({**arguments, _RIM: _RIM / q.x0}, simultaneous=True)
    end = q.x0 if rim is None else _RIM
    normal = sp.factor(sp.simplify(whole.xreplace({call: named})))
    normal = normal.subs((q.x - end) ** 2, (end - q.x) ** 2).subs(end - q.x, end * (1 - q.x / end))
    shear = fill(force_laws()[mechanics.F_t].subs(inside), laws)
    for call in shear.atoms(sp.log):
        shear = shear.subs(-call, sp.log(1 / call.args[0]))  # ln(x0/x) instead of -ln(x/x0)
    edge = sp.simplify(q.x0 * laws["shear"]["edge"](q.x0 / q.a))
    sustains = all(function.name != "suction" for function in law.functions)
    where = _inside(q.x0) + ("; the same on the way in and out" if sustains else "; 0 on the way out")
    where = "at any gap, the same on the way in and out" if law.spread else where
    yield Equation("Lubrication", latex(mechanics.F_n), normal, where)
    if rim is not None:
        squared = sp.expand((rim**2).subs(arguments, simultaneous=True) * q.x0**2)
        yield Equation("Lubrication", latex(_RIM), sp.sqrt(squared), "rim of the disc that holds the bridge's volume")
    yield Equation("Lubrication", latex(mechanics.F_t), shear, _inside(edge))


def _attraction(laws: Mapping[str, Law]) -> Iterator[Equation]:
    if "attraction" not in laws:
        return
    law = laws["attraction"]
    yield Equation("Attraction", latex(mechanics.F_w), sp.simplify(fill(force_laws()[mechanics.F_w], laws)), law.source)


def _inside(edge: sp.Expr) -> str:
    return f"${latex(q.x)} < {latex(edge)}$, else 0"


def _bridge(law: Law) -> Iterator[Equation]:
    group, force = "Capillary bridge", law["force"]
    whole = force_laws()[mechanics.F_c]
    (call,) = slot_calls(whole)
    arguments = dict(zip(force.arguments, call.args, strict=True))

    def put(expression: sp.Expr) -> sp.Expr:
        """The expression at the gap over the radius; fitted coefficients as the decimals printed in the source."""
        fitted = {n: sp.Float(str(float(n))) for n in expression.atoms(sp.Rational) if n.q not in (1, 2)}
        return expression.xreplace(fitted).subs(arguments, simultaneous=True)

    yield Equation(group, latex(mechanics.F_c), whole.xreplace({call: put(force.result)}), law.source)
    for symbol, value in force.definitions:
        yield Equation(group, latex(symbol), put(value))


def _strings(laws: Mapping[str, Law]) -> Iterator[Equation]:
    group, named = "Pendulum strings", False
    for force in (mechanics.S_n, mechanics.S_t):
        whole = force_laws()[force]
        (call,) = slot_calls(whole)
        swung = call.func(call.args[0], (_SWING / q.a) ** 2)
        closed = sp.simplify(fill(whole.xreplace({call: swung}), laws))
        named |= _SWING in closed.free_symbols
        yield Equation(group, latex(force), closed, f"{laws['strings'].name} strings")
    if named:
        swing = swing_squared().subs(string_distance - 4 * q.a, q.x).subs(string_distance, q.r)
        yield Equation(group, f"{latex(_SWING)}^2", swing, "swing of either sphere")


def _course(laws: Mapping[str, Law]) -> Iterator[Equation]:
    group, start = "Start, rebound, rupture", scaling.start_values()
    # the criterion is scaled with v0: substitute gap and velocity in SI
    pressure = scaling.LUBRICATION_PRESSURE * laws["glass"]["pressure"](q.gap, -q.normal_velocity)
    pressure = sp.factor(sp.factor(sp.simplify(pressure)).subs({q.gap: q.x / q.x0, q.normal_velocity: q.u / q.v0}))
    length = sp.simplify(scaling.elastic_length() * (_COMPLIANCE / scaling.elastic_compliance()) ** _TWO_FIFTHS)
    cubed = sp.powsimp(sp.expand_power_base(length**5, force=True), force=True)
    yield Equation(group, f"{latex(q.x)}(0)", start[q.x], "initial contact")
    yield Equation(group, f"{latex(q.u)}(0)", start[q.u], "no angle turned yet")
    yield Equation(group, rf"{latex(q.xi)}(0)", start[q.xi], "spin before the collision, 0 if none is given")
    yield Equation(group, latex(q.omega0), scaling.initial_rate())
    printed = {"glass": pressure, "elastic": sp.Pow(sp.sqrt(cubed), _TWO_FIFTHS, evaluate=False)}  # as in the paper
    for number, row in zip(_ROMAN, CRITERIA, strict=False):
        limit = printed.get(row.word, q.x0 * scaling.group_definitions()[q.VOCABULARY[row.limit].symbol])
        yield Equation(group, latex(q.x if row.contact else q.p_gt), limit, f"({number}) {row.name}", r"\leq")
        if limit.has(_COMPLIANCE):
            yield Equation(group, latex(_COMPLIANCE), scaling.elastic_compliance())
    after = rebound((q.normal_velocity,))[q.normal_velocity].subs(q.normal_velocity, q.u)
    yield Equation(group, latex(q.u), after, "if any of these is met", r"\to")
    yield Equation(group, "x_f", scaling.rupture_distance(), f"rupture (${latex(q.x0)}$ without a bridge)")


def _friction(laws: Mapping[str, Law]) -> Iterator[Equation]:
    group, answer = "Friction of the dry contact", equal_spheres()
    lever = sp.expand(fill(force_laws()[mechanics.arm], laws))
    sticking = _TANGENTIAL_MASS * (1 + q.beta_0) * sp.Abs(_SLIP)
    limit = q.mu_f * q.m * (1 + q.e_dry) * sp.Abs(q.u)
    mass = sp.simplify(1 / answer.compliance.subs(mechanics.arm, lever))
    yield Equation(group, latex(_SLIP), answer.slip.subs(mechanics.arm, lever), "slip of the surfaces")
    yield Equation(group, latex(_TANGENTIAL_MASS), mass, f"effective tangential mass ({laws['arm'].name} arm)")
    yield Equation(group, "|Q|", sticking, "tangential impulse of a rebound that sticks")
    yield Equation(group, "|Q|", limit, "of one that slides: the smaller of the two acts")
    for rate, change in answer.rates.items():
        yield Equation(group, rf"\Delta {latex(rate)}", change.subs(mechanics.arm, lever) * _IMPULSE)


def _groups() -> Iterator[Equation]:
    definitions = scaling.group_definitions()
    rotating = sp.simplify(definitions[q.centrifugal] / scaling.initial_rate() ** 2) * q.omega0**2
    for group in (q.stokes, q.capillary, q.centrifugal):
        yield Equation("Groups", latex(group), rotating if group == q.centrifugal else definitions[group])
