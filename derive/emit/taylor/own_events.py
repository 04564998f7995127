"""Declared events of a user's model in C: series of their guards, their values and jumps, and a table of them."""

from collections.abc import Sequence

import sympy as sp

from ...equations import terms
from ...equations.automaton import EVENTS, WORDS
from ...equations.model import Model
from ...user.kinks import WIDTH
from ...user.own_events import AT_REST, OwnEvent
from ...vocabulary import quantities as q
from .constants import Constants
from .layout import comment, function, struct
from .ledger import Valued
from .program import Program
from .recurrences import Recurrences

_FIELDS = "event, kind, motion, film, mark, by_gap, opening, closing, known, harmless, varies"
_CLOCKS = {q.angle_turned: "ANGLE", q.time_passed: "TIME"}
_VARIES = {f"BY_{name.upper()}": 1 << k for k, name in enumerate(AT_REST)}


def clock_states(model: Model) -> list[str]:
    """Lines for a structure's header: the places of the states that declared events and terms watch, if any."""
    return [f"#define {name}_STATE {clock.name.upper()}" for clock, name in _CLOCKS.items() if clock in model.states]


def own_event_functions(
    model: Model, events: Sequence[OwnEvent], constants: Constants, valued: Valued
) -> tuple[list[str], list[str]]:
    """Lines for a structure's header: what stands before its functions, and these; nothing without events.

    Raises:
        EmissionError: a guard has an operation without a recurrence.
    """
    present = [event for event in events if event.fits(model.structure)]
    if not present:
        return [], []
    guards = model["events"].by_name
    program = Program.for_outputs(model.states, (guards[event.name] for event in present), model.definitions)
    result = {event.name: program.series(sp.sympify(guards[event.name]), f"guard_of_{event.name}") for event in present}
    recurrences = Recurrences(program, constants, lambda name: f"m->{name}")
    body = ["(void)c; (void)m;", *recurrences.lines()]
    body += [f"s->guard[{k}][k] = {recurrences.array(result[event.name])}[k];" for k, event in enumerate(present)]
    lines = comment("Series of the guards of declared events.")
    lines += struct("own_series", [*recurrences.fields(), "vec guard[OWN_EVENTS][TERMS];"])
    head = "static inline void own_coefficients(own_series *s, const series *m, const constants *c, int k)"
    lines += [*function(head, body), ""]
    lines += valued(
        [(event.name, guards[event.name]) for event in present],
        "static inline void own_guards(const constants *c, const vec *y, vec *guard)",
        {event.name: f"guard[{k}]" for k, event in enumerate(present)},
        "Guards of declared events, positive before them.",
    )
    lines += valued(
        [(event.name, _least_over_time(guards[event.name])) for event in present],
        "static inline void own_least(const constants *c, const vec *y, vec *least)",
        {event.name: f"least[{k}]" for k, event in enumerate(present)},
        "Bounds below which no guard falls while nothing but the time goes on: of one that swings.",
    )
    cases = []
    for k, event in enumerate(present):
        jump, release = model[f"jump_{event.name}"], model[f"release_{event.name}"]
        after = {state.name: f"after[{state.name.upper()}]" for state in model.states}
        head = f"static inline void {jump.name}(const constants *c, const vec *y, vec *after)"
        lines += valued(jump.outputs, head, after, jump.doc)
        head = f"static inline vec {release.name}(const constants *c, const vec *y)"
        lines += valued(release.outputs, head, {"released": "return"}, release.doc)
        cases += [
            f"case {k}:",
            f"    {jump.name}(c, y, after);",
            f"    *released = {release.name}(c, y);",
            "    break;",
        ]
    head = "static inline void own_jump(const constants *c, const vec *y, int which, vec *after, vec *released)"
    lines += comment("State after a declared event, and the energy that it may give.")
    lines += function(head, ["switch (which) {", *cases, "}"])
    table = [f"#define OWN_EVENTS {len(present)}"]
    table += comment("What changes a guard in resting contact, and the states that nothing but guards watches.")
    table.append(f"enum {{ {', '.join(f'{name} = {bit}' for name, bit in _VARIES.items())} }};")
    clocks = {clock: clock in model.states and clock not in terms.clocks(model.structure) for clock in _CLOCKS}
    places = (f"{name}_CLOCK = {clock.name.upper() if clocks[clock] else -1}" for clock, name in _CLOCKS.items())
    table.append(f"enum {{ {', '.join(places)} }};")
    table += comment("Where each is watched (motion -1 closing, 1 opening, 0 also at rest; film -1 anywhere), the "
                     "signs of its guard's slopes, whether it is harmless to barriers of the energy (1), and does not "
                     "reverse the motion either (2).")  # fmt: skip
    table += [f"static const struct {{ int {_FIELDS}; }} OWN[OWN_EVENTS] = {{"]
    everywhere = list(events)
    for event in present:
        where, reach, place = dict(event.proposed.row.where), event.reach(model.structure), everywhere.index(event)
        numbers = [len(EVENTS) + place, len(WORDS) + place, where.get("motion", 0), where.get("film", -1)]
        signs = [sign or 0 for sign in (reach.by_gap, reach.opening, reach.closing)]
        free = sp.sympify(guards[event.name]).free_symbols
        varies = [bit for bit, symbols in zip(_VARIES, AT_REST.values(), strict=True) if free & {*symbols}]
        harmless = (1 + event.keeps_direction) * event.harmless
        texts = [*map(str, numbers), event.mark.name.upper(), *map(str, signs), str(int(reach.is_known))]
        table.append(f"    {{{', '.join([*texts, str(harmless), ' | '.join(varies) or '0'])}}},")
    return [*table, "};", ""], [*lines, ""]


def _least_over_time(guard: sp.Expr) -> sp.Expr:
    """A guard at its least for any time, where sines and cosines of the time are all that varies; else -1."""
    swings = {node: sp.Dummy() for node in guard.atoms(sp.sin, sp.cos) if node.has(q.time_passed)}
    plain = guard.xreplace(swings)
    slopes = [plain.diff(swing) for swing in swings.values()]
    if plain.has(q.time_passed) or any(slope.has(*swings.values()) for slope in slopes):
        return sp.Integer(-1)
    middle = plain.xreplace(dict.fromkeys(swings.values(), sp.Integer(0)))
    return middle - sum(sp.sqrt(slope**2 + WIDTH**2) for slope in slopes)
