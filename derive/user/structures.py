"""From declarations to laws: SI expressions in terms of the slots' arguments, new groups, extended structures."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations

import sympy as sp
from sympy.core.function import AppliedUndef

from ..equations.model import GROUPS, Model, derive
from ..physics.law import Definition, Law, LawFunction, is_slot_call
from ..physics.scaling import ScalingError, cancelled, dimension_matrix, dimensional, group_definitions, to_groups
from ..physics.slots import MOTION, Place, place_of
from ..physics.structure import Structure
from ..physics.terms import VELOCITIES, Terms
from ..vocabulary.dimensions import ONE, Dimension, DimensionError, dimension_of
from ..vocabulary.quantities import (
    DIMENSIONS,
    VOCABULARY,
    a,
    m,
    mu,
    normal_velocity,
    rate_scale,
    rough_gap,
    u,
    v0,
    x,
    x0,
)
from . import own_events
from .declarations import Criterion, Declarations, Declared, Proposed, unfolded
from .kinks import freed, smooth
from .laws import published
from .names import NO_GROUP, as_written, dimension_as_written
from .own_events import OwnEvent

_ALWAYS = (a, x0, mu, v0, m)  # quantities of every scene, in the order in which a scale is sought
_MOVED = ("separation", "separation_rate", "rotation_rate", "spin_rate")
_MOVING = ("separation", "separation_rate", "rotation_rate", "spin_rate", "rotation", "time", "initial_rate")


@dataclass(frozen=True)
class Group:
    """A dimensionless group of a user's model: `quantity` over `over` (1: the quantity is a plain number)."""

    symbol: sp.Symbol
    quantity: Declared
    over: sp.Expr

    @property
    def definition(self) -> sp.Expr:
        return self.quantity.symbol / self.over


@dataclass(frozen=True, eq=False)
class UserModel:
    """A derived model file: laws in the library's form, groups, and additional arguments of each slot's functions.

    `laws` are as they are emitted, with kinks rounded; `written` has the kinks.
    """

    name: str
    meaning: str
    declarations: Declarations
    laws: tuple[Law, ...]
    written: tuple[Law, ...]
    groups: tuple[Group, ...]
    extra: Mapping[str, tuple[sp.Symbol, ...]]
    events: tuple[OwnEvent, ...] = ()
    terms: Terms | None = None

    @cached_property
    def si(self) -> tuple[Law, ...]:
        """The laws in SI except for the slot's arguments, for print."""
        return tuple(_in_si(law, self.groups) for law in self.written)

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        return tuple(self.declarations.criteria.values())

    @property
    def gaps(self) -> dict[sp.Symbol, sp.Expr]:
        """The gap of each criterion over x0, and that of solid contact by roughness or by any of them: groups in SI."""
        own = {criterion.group: criterion.gap / x0 for criterion in self.criteria}
        return own | {rough_gap: sp.Max(group_definitions()[rough_gap], *own.values())} if own else {}

    @property
    def slots(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(law.slot for law in self.laws))

    def default(self, slot: str) -> Law:
        """The law that fills a slot unless a scene names another: the first one declared."""
        return next(law for law in self.laws if law.slot == slot)

    @property
    def accepted(self) -> set[str]:
        return {check for law in self.declarations.laws.values() for check in law.accept}

    @property
    def terms_in_si(self) -> Terms | None:
        """The terms in the quantities of the file."""
        return _terms(self.declarations, {})

    def derived(self, structure: Structure) -> Model:
        """The model of a structure with all that the file declares."""
        return self.extended(derive(replace(structure, terms=self.terms)))

    def extended(self, model: Model) -> Model:
        """A structure's model with the additional arguments in its calls, and the groups that they require."""

        def call(expression: sp.Expr) -> sp.Expr:
            nodes = {
                node: node.func(*node.args, *self.extra[node.func.__name__])
                for node in sp.sympify(expression).atoms(AppliedUndef)
                if is_slot_call(node) and self.extra.get(node.func.__name__)
            }
            return sp.sympify(expression).xreplace(nodes)

        functions = tuple(
            replace(f, outputs=tuple((key, _stopped(f.name, key, call(value))) for key, value in f.outputs))
            for f in model.functions
        )
        definitions = tuple((symbol, call(value)) for symbol, value in model.definitions)
        reached: set[sp.Basic] = {
            s for key, extra in self.extra.items() if key.split(".")[0] in model.slots for s in extra
        }
        reached |= own_events.groups_of(self.events, model.structure)
        symbols = {*model.groups, *reached}
        groups = [group for group in GROUPS if group in symbols]
        groups += [group.symbol for group in self.groups if group.symbol in symbols]
        wider = replace(model, groups=tuple(groups), functions=functions, definitions=definitions)
        return own_events.extended(wider, self.events)


def _stopped(function: str, key: str, expression: sp.Expr) -> sp.Expr:
    return expression.subs(normal_velocity, 0) if (function, key) == ("effective_potential", "slope") else expression


def express(name: str, meaning: str, declared: Declarations) -> UserModel:
    """The model of declarations; DimensionError or ScalingError names law, function, and the wrong term or quantity."""
    groups = _groups(declared)
    laws = []
    for proposed in declared.laws.values():
        functions = tuple(_function(name, proposed, declared, groups) for name in proposed.functions)
        laws.append(replace(proposed.law, functions=functions))
    marks = (event.mark for event in declared.events.values())
    extra = _extra(laws, (normal_velocity, *marks, *GROUPS, *(group.symbol for group in groups.values())))
    laws = [_widened(law, extra) for law in laws]
    still = {*GROUPS, *(group.symbol for group in groups.values())}
    written = tuple(laws)
    laws = [replace(law, functions=tuple(smooth(f, still, declared.positive) for f in law.functions)) for law in laws]
    terms = _terms(declared, groups)
    called = {symbol for symbols in extra.values() for symbol in symbols}
    events = tuple(_event(event, declared, groups) for event in declared.events.values())
    watched = called.union(*(event.guard.free_symbols for event in events))
    for oblique in (True, False):  # guards that differ by a rotation fall to zero together head-on
        same = own_events.together(events, Structure(oblique, bridge=False, strings=False))
        watched |= {event.mark for event in same.values()}
    events = tuple(replace(event, used=event.mark in watched) for event in events)
    touched = set().union(*(criterion.gap.free_symbols for criterion in declared.criteria.values()))
    used = called.union(*(event.symbols for event in events), terms.symbols if terms else ())
    used |= {group.symbol for group in groups.values() if group.quantity.symbol in touched}
    present = tuple(group for group in groups.values() if group.symbol in used)
    unused = [item.name for item in declared.quantities.values() if item.name not in {g.quantity.name for g in present}]
    if unused:
        raise ScalingError(f"{', '.join(unused)}: declared, but no law, term, event or criterion depends on it")
    return UserModel(name, meaning, declared, tuple(laws), written, present, extra, events, terms)


def _terms(declared: Declarations, groups: Mapping[str, Group]) -> Terms | None:
    """The declared terms with their quantities as groups; None without any."""
    if not (declared.energies or declared.forces):
        return None
    quantities = _as_groups(groups)

    def put(*parts: sp.Expr) -> sp.Expr:
        return sp.sympify(sp.Add(*(unfolded(term, declared) for term in parts))).xreplace(quantities)

    energy = put(*declared.energies)
    potential = energy.subs(dict.fromkeys(VELOCITIES.values(), 0))
    forces = {on: put(*(force for name, force in declared.forces if name == on)) for on in VELOCITIES}
    acting = tuple((on, force) for on, force in forces.items() if force != 0)
    return Terms(sp.expand(energy - potential), potential, acting, tuple(group.symbol for group in groups.values()))


def _event(event: own_events.Proposed, declared: Declarations, groups: Mapping[str, Group]) -> OwnEvent:
    """A declared event with its quantities as groups."""
    quantities = _as_groups(groups)
    of: dict[sp.Basic, Dimension] = {**DIMENSIONS, **{q.symbol: q.dimension for q in declared.quantities.values()}}
    of |= {other.mark: ONE for other in declared.events.values()}

    def scaled(expression: sp.Expr, over: sp.Expr) -> sp.Expr:
        return sp.sympify(unfolded(expression, declared).xreplace(quantities) / over)

    scale = own_events.scale_of(dimension_of(unfolded(event.guard, declared), of) or ONE)
    jump = tuple((target, scaled(value, v0 if target == u else rate_scale)) for target, value in event.jump)
    return OwnEvent(event, scaled(event.guard, scale), jump, scaled(event.releases, m * v0**2))


def _as_groups(groups: Mapping[str, Group]) -> dict[sp.Symbol, sp.Expr]:
    return {g.quantity.symbol: g.symbol * g.over for g in groups.values() if g.quantity.dimension != ONE}


def _extra(laws: Iterable[Law], order: Iterable[sp.Symbol]) -> dict[str, tuple[sp.Symbol, ...]]:
    """The additional arguments of a slot's functions, over all its laws."""
    added: dict[str, set[sp.Symbol]] = {}
    for law in laws:
        for f in law.functions:
            more = {*f.arguments} - {*place_of(law.slot, f.name, law.spread).arguments}
            added.setdefault(f"{law.slot}.{f.name}", set()).update(more)
    return {key: tuple(s for s in order if s in more) for key, more in added.items() if more}


def _widened(law: Law, extra: Mapping[str, tuple[sp.Symbol, ...]]) -> Law:
    """The law with the additional arguments of its slot."""
    more = {f.name: extra.get(f"{law.slot}.{f.name}", ()) for f in law.functions}
    arguments = {f.name: (*(s for s in f.arguments if s not in more[f.name]), *more[f.name]) for f in law.functions}
    return replace(law, functions=tuple(replace(f, arguments=arguments[f.name]) for f in law.functions))


def _groups(declared: Declarations) -> dict[str, Group]:
    """The group of each quantity, by the quantity's name."""
    result = {}
    for item in declared.quantities.values():
        if item.dimension == ONE:
            result[item.name] = Group(item.symbol, item, sp.Integer(1))
            continue
        over = item.over if item.over is not None else _scale(item, declared)
        of = DIMENSIONS | {other.symbol: other.dimension for other in declared.quantities.values()}
        dimension = dimension_as_written(over, of)
        if dimension != item.dimension:
            problem = f"{as_written(over)} has dimension {dimension}, {item.name} has {item.dimension}"
            raise DimensionError(f"{item.name}.over: {problem}")
        signs = [key for key in ("positive", "nonnegative", "real") if item.symbol.assumptions0.get(key)]
        result[item.name] = Group(sp.Symbol(item.group, **dict.fromkeys(signs, True)), item, over)
    return result


def _scale(quantity: Declared, declared: Declarations) -> sp.Expr:
    """A monomial of a scene's quantities with the dimension of `quantity`; those of the related scale are preferred."""
    functions = [
        (formula.expression, place_of(proposal.law.slot, name, proposal.law.spread).scale)
        for proposal in declared.laws.values()
        for name, formula in proposal.functions.items()
    ]
    functions += [(value, sp.Integer(1)) for event in declared.events.values() for value in event.expressions]
    functions += [(criterion.gap, sp.Integer(1)) for criterion in declared.criteria.values()]
    functions += [(value, sp.Integer(1)) for value in (*declared.energies, *(force for _, force in declared.forces))]
    near: list[sp.Symbol] = []
    for expression, scale in functions:
        full = unfolded(expression, declared)
        if quantity.symbol in full.free_symbols:
            near += _by_vocabulary(scale.free_symbols) + _by_vocabulary(full.free_symbols)
    candidates = [s for s in dict.fromkeys([*near, *_ALWAYS]) if s.name not in _MOVING and any(DIMENSIONS[s].exponents)]
    target = sp.Matrix(quantity.dimension.exponents)
    for count in (1, 2, 3):
        for chosen in combinations(candidates, count):
            matrix = dimension_matrix(chosen)
            if matrix.rank() < count or matrix.row_join(target).rank() > count:
                continue  # dependent, or too few
            powers = (matrix.T * matrix).inv() * matrix.T * target
            return sp.prod([s**power for s, power in zip(chosen, powers, strict=True)])
    raise ScalingError(
        f"{quantity.name}: no monomial of {', '.join(map(str, map(as_written, candidates)))} has its dimension"
    )


def _by_vocabulary(symbols: Iterable[sp.Symbol]) -> list[sp.Symbol]:
    return [quantity.symbol for quantity in VOCABULARY.values() if quantity.symbol.name in {s.name for s in symbols}]


def _function(name: str, proposed: Proposed, declared: Declarations, groups: Mapping[str, Group]) -> LawFunction:
    """A function in the slot's arguments, states and groups; dimensionless parts keep their names."""
    law, formula = proposed.law, proposed.functions[name]
    label, place = f"law {law.slot} {law.name}, {name}", place_of(law.slot, name, law.spread)
    expression = formula.expression
    of: dict[sp.Basic, Dimension] = {**DIMENSIONS, **dict.fromkeys(place.arguments, ONE)}
    of |= {quantity.symbol: quantity.dimension for quantity in declared.quantities.values()}
    marks = tuple(event.mark for event in declared.events.values())
    of |= dict.fromkeys(marks, ONE)
    parts: list[Definition] = []
    inline: dict[sp.Basic, sp.Basic] = {}
    try:
        reached = _reached(expression, declared)
        for step in (item for item in declared.intermediates.values() if item.symbol in reached):
            dimension = dimension_as_written(step.expression, of) or ONE
            of[step.symbol] = dimension
            value = step.expression.xreplace(inline)
            if dimension == ONE:
                parts.append((step.symbol, _settled(label, place, value, groups)))
            else:
                inline[step.symbol] = value
        total = dimension_as_written(expression, of)
    except DimensionError as error:
        raise DimensionError(f"{label}: {error}") from None
    value = expression.xreplace(inline)
    if total not in (None, ONE):
        if total != place.dimension:
            wanted = "" if place.dimension == ONE else f"{place.dimension} or "
            raise DimensionError(
                f"{label}: {as_written(expression)} has dimension {total}, expected {wanted}a pure number"
            )
        value = sp.Add(*(term / place.scale for term in sp.Add.make_args(value)))
    result = _settled(label, place, value, groups)
    named = {symbol for symbol, _ in parts}
    used = set().union(*(e.free_symbols for e in (result, *(value for _, value in parts)))) - named
    motion = () if place.closed else MOTION.get(place.slot, ())
    more = set() if place.closed else {*motion, *marks, *GROUPS, *(group.symbol for group in groups.values())}
    if wrong := sorted(str(as_written(s)) for s in used - {*place.arguments, *more}):
        possible = ", ".join(s.name for s in (*place.arguments, *motion)) + (" only" if place.closed else " and groups")
        what = name if place.closed else f"a {place.slot} law"
        raise ScalingError(f"{label}: depends on {', '.join(wrong)}; {what} may depend on {possible}")
    extra = [s for s in (normal_velocity, *marks, *GROUPS, *(g.symbol for g in groups.values())) if s in used]
    arguments = (*place.arguments, *(s for s in extra if s not in place.arguments))
    source, references = published(formula.source, formula.remark)
    doc = (formula.doc or place.doc) + (f"\n\nSource: {source}." if source else "")
    falls = proposed.falls and name == next(iter(proposed.functions))
    return LawFunction(name, arguments, result, doc, tuple(parts), place.for_proof, falls, references)


def _reached(expression: sp.Expr, declared: Declarations) -> set[sp.Basic]:
    reached = set(expression.free_symbols)
    for item in reversed(declared.intermediates.values()):
        if item.symbol in reached:
            reached |= item.expression.free_symbols
    return reached


def _settled(label: str, place: Place, expression: sp.Expr, groups: Mapping[str, Group]) -> sp.Expr:
    """A dimensionless SI expression in the slot's arguments, states and groups."""
    quantities = _as_groups(groups)
    if not dimensional(expression) and not expression.free_symbols & set(quantities):
        return expression  # kept as written
    for argument, at in zip(place.arguments, place.at, strict=False):
        for moving in (x, u):
            if moving in at.free_symbols and moving in expression.free_symbols:
                expression = expression.subs(moving, sp.solve(sp.Eq(at, argument), moving)[0])
    expression = expression.subs(u, v0 * normal_velocity).subs(quantities, simultaneous=True)
    arguments = {s: s for s in place.arguments}
    rules = {s: value for s, value in to_groups().items() if s not in arguments and s.name not in _MOVED}
    for _ in range(3):
        expression = expression.subs(rules, simultaneous=True)
    expression = freed(expression)
    terms = sp.Add.make_args(expression)  # kept as written if no quantity remains to cancel
    by_term = sp.Add(*(sp.simplify(term) if dimensional(term) else term for term in terms))
    if foreign := [str(as_written(s)) for s in NO_GROUP if s in by_term.free_symbols]:
        raise ScalingError(f"{label}: {', '.join(foreign)} is not known to a law: declare a quantity for it")
    return cancelled(label, by_term, expression)


def _in_si(law: Law, groups: Iterable[Group]) -> Law:
    """The law with its groups as quantities, in the slot's own arguments only."""
    back: dict[sp.Basic, sp.Basic] = {g.symbol: g.definition for g in groups}
    back |= dict(group_definitions())
    functions = []
    for f in law.functions:
        arguments = place_of(law.slot, f.name, law.spread).arguments
        rules = {s: value for s, value in {**back, normal_velocity: u / v0}.items() if s not in arguments}

        def put(expression: sp.Expr, rules: Mapping[sp.Basic, sp.Basic] = rules) -> sp.Expr:
            return expression.subs(rules, simultaneous=True)

        parts = tuple((symbol, put(value)) for symbol, value in f.definitions)
        functions.append(LawFunction(f.name, arguments, put(f.result), f.doc, parts))
    return replace(law, functions=tuple(functions))
