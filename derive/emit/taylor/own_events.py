"""Declared events of a user's model in C: series of their guards, their values and jumps, and a table of them."""

from collections.abc import Sequence

import sympy as sp

from ...equations.automaton import EVENTS, WORDS
from ...equations.model import Model
from ...user.own_events import OwnEvent
from .constants import Constants
from .layout import comment, function, struct
from .ledger import Valued
from .program import Program
from .recurrences import Recurrences

_FIELDS = "event, kind, motion, film, mark, by_gap, opening, closing, known, harmless"


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
    table += comment("Where each is watched (motion -1 closing, 1 opening; film -1 anywhere), and the signs of its "
                     "guard's slopes.")  # fmt: skip
    table += [f"static const struct {{ int {_FIELDS}; }} OWN[OWN_EVENTS] = {{"]
    everywhere = list(events)
    for event in present:
        where, reach, place = dict(event.proposed.row.where), event.reach(model.structure), everywhere.index(event)
        numbers = [len(EVENTS) + place, len(WORDS) + place, where.get("motion", 0), where.get("film", -1)]
        signs = [sign or 0 for sign in (reach.by_gap, reach.opening, reach.closing)]
        texts = [*map(str, numbers), event.mark.name.upper(), *map(str, signs)]
        table.append(f"    {{{', '.join([*texts, str(int(reach.is_known)), str(int(event.harmless))])}}},")
    return [*table, "};", ""], [*lines, ""]
