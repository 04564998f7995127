"""The automaton in C: enumerations, constants, and the kernel's switch over the effects of events."""

import ast
from collections.abc import Iterable, Sequence

from ...equations import automaton
from ...equations.automaton import Event
from ...equations.certificates.table import CERTIFICATES
from ..provenance import PROVENANCE, digest
from .guards import event_name, target_of
from .layout import comment, function

_KIND = {word.word: f"KIND_{word.name}" for word in automaton.WORDS}

# C statements of the actions but "gap = target"; "rebound" is a function of the word. What they call is in
# `engines/taylor/runtime/`.
_STATEMENTS = {
    "velocity = 0": ("LANE(l->y[NORMAL_VELOCITY], lane) = 0.0;",),
    "turn": ("LANE(l->closing, lane) = LANE(l->closing, lane) ? 0 : TRUTH;",),
    "cross film edge": (
        "LANE(l->film, lane) = 1.0 - LANE(l->film, lane);",
        "if (LANE(f->edge, lane) == 1.0)",
        "    LANE(l->shear, lane) = LANE(l->film, lane);",
    ),
    "cross tangential edge": ("LANE(l->shear, lane) = 1.0 - LANE(l->shear, lane);",),
    "open": ("LANE(l->y[NORMAL_VELOCITY], lane) = RELEASE_SPEED;", "opens(l, f, lane);"),
    "roll or slide": (),  # the function that decides between the two words
    "slide": ("slides(l, f, lane);",),
    "separate": ("parts(q, l, f, lane);",),
    "cut off": ("finish(q, l, f, lane, DECIDED, STICK, 0);",),
}


def automaton_header(provenance: str, user_events: Sequence[Event] = (), meanings: Sequence[str] = ()) -> str:
    """Text of `generated/taylor/automaton.h`: enumerations and constants of the rules.

    Arguments:
        user_events: events that a user's model declares, behind the library's; `meanings` are those of their words.
    """
    lines = comment(provenance)
    lines += ["", "#ifndef AUTOMATON_H", "#define AUTOMATON_H", "#include <math.h>", ""]
    lines += comment("What is watched for, in order of precedence among coincident events.")
    lines += _enumeration(event_name(event) for event in (*automaton.EVENTS, *user_events))
    lines += ["", *comment("What is reported.")]
    words = [(_KIND[word.word], word.meaning) for word in automaton.WORDS]
    words += [(own_kind(event), meaning) for event, meaning in zip(user_events, meanings, strict=True)]
    lines += _described(words)
    lines += ["", *comment("How a collision ends.")]
    lines += _described((outcome.name, outcome.condition) for outcome in automaton.OUTCOMES)
    last = [status.name for status in automaton.STATUSES if status.answers][-1]
    lines += ["", *comment(f"What is said of a collision; up to {last} the outcome stands.")]
    lines += _described((status.name, status.meaning) for status in automaton.STATUSES)
    lines += [f"enum {{ LAST_ANSWER = {last} }};"]
    lines += ["", *comment("What a collision is integrated for.")]
    lines += _described((purpose.name, purpose.meaning) for purpose in automaton.PURPOSES)
    lines.append("")
    for constant in automaton.CONSTANTS:
        if isinstance(constant.value, int):
            lines.append(f"enum {{ {constant.name} = {constant.value} }}; /* {constant.meaning} */")
        else:
            lines.append(f"static const double {constant.name} = {constant.value!r}; /* {constant.meaning} */")
    for rule in automaton.RULES:
        for name, meaning, test in rule.tests:
            passed = ", ".join(f"double {argument}" for argument in automaton.arguments(test))
            test = test.replace(" and ", " && ").replace(" or ", " || ").replace("abs(", "fabs(")
            lines += ["", *comment(f"Whether {meaning}.")]
            lines += function(f"static inline int {name}({passed})", [f"return {test};"])
    return "\n".join([*lines, "", "#endif"]) + "\n"


def proofs_header() -> str:
    """Text of `generated/taylor/proofs.h`: the inequalities of stick certificates, in all lanes at once."""
    proofs = [proof for row in CERTIFICATES for proof in row.proofs]
    origin = f"{PROVENANCE}\nStick certificates sha256 {digest(*proofs)}"
    lines = comment(f"{origin}\n\nInequalities of stick certificates. Included where `vec` and `mask` are known.")
    for inequality in proofs:
        passed = ", ".join(
            f"{'double' if name == 'margin' else 'vec'} {name}" for name in automaton.arguments(inequality.test)
        )
        body = [f"return {_in_lanes(ast.parse(inequality.test, mode='eval').body)};"]
        lines += ["", *comment(f"Lanes in which {inequality.meaning}.")]
        lines += function(f"static inline mask {inequality.name}({passed})", body)
    return "\n".join(lines) + "\n"


def _in_lanes(node: ast.expr) -> str:
    if isinstance(node, ast.BoolOp):
        joined = (" & " if isinstance(node.op, ast.And) else " | ").join(map(_in_lanes, node.values))
        return f"({joined})"
    return f"({ast.unparse(node).replace('abs(', 'vec_abs(').replace(' * ', '*')})"


def criteria_header(provenance: str) -> str:
    """Text of `generated/taylor/criteria.h`: the contact gaps as functions of a collision's constants."""
    groups = [f"c->{criterion.limit}" for criterion in automaton.CONTACTS]
    kinds = [_KIND[criterion.word] for criterion in automaton.CONTACTS]
    *first, last = zip(groups, kinds, automaton.CONTACTS, strict=True)
    lines = comment(f"{provenance}\n\nRebound criteria that are met at a gap. Included where `constants` is known.")
    lines += ["", *comment("The gap at which the solids meet: the largest at which a criterion is met.")]
    lines += function("static inline vec contact_gap(const constants *c)", [f"return {_nested('vec_max', groups)};"])
    lines += ["", *comment("What is reported of contact: the first whose gap is largest and positive, else the last.")]
    lines += function(
        "static inline int contact_kind(const constants *c, int lane)",
        [
            "double contact = in_lane(contact_gap(c), lane);",
            *(
                line
                for group, kind, _ in first
                for line in (f"if (LANE({group}, lane) == contact && contact > 0.0)", f"    return {kind};")
            ),
            f"return {last[1]};",
        ],
    )
    lines += ["", *comment("The first criterion that holds at a gap where one does.")]
    lines += function(
        "static inline int kind_at_gap(const constants *c, double gap, int lane)",
        [
            *(line for group, kind, _ in first for line in (f"if (gap <= LANE({group}, lane))", f"    return {kind};")),
            f"return {last[1]};",
        ],
    )
    lines += ["", *comment("The second largest of the gaps; 0 if there is none.")]
    lines += function(
        "static inline double second_gap(const constants *c, int lane)",
        [
            f"double gaps[] = {{{', '.join(f'LANE({group}, lane)' for group in groups)}}};",
            "double largest = 0.0, second = 0.0;",
            f"for (int k = 0; k < {len(groups)}; k++)",
            "    if (gaps[k] > largest) {",
            "        second = largest;",
            "        largest = gaps[k];",
            "    } else if (gaps[k] > second)",
            "        second = gaps[k];",
            "return second;",
        ],
    )
    lines += ["", "#if GRADIENTS", *comment("Lanes whose contact gap is this group.")]
    body = ["vec contact = contact_gap(c);", "mask before = splat_mask(0);"]
    for group, _, criterion in first:
        body += [f"if (group == BY_{criterion.limit.upper()})", f"    return ({group} == contact) & NOT(before);"]
        body.append(f"before |= {group} == contact;")
    body.append(f"return group == BY_{last[2].limit.upper()} ? NOT(before) : splat_mask(0);")
    lines += function("static inline mask contact_moves_with(const constants *c, int group)", body)
    return "\n".join([*lines, "#endif"]) + "\n"


def _nested(operation: str, values: Sequence[str]) -> str:
    *first, last = values
    return f"{operation}({_nested(operation, first)}, {last})" if first else last


def effects_header(provenance: str, user_events: Sequence[Event] = ()) -> str:
    """Text of `generated/taylor/effects.h`: the switch over an event's effect, those of `user_events` last."""
    lines = comment(
        f"{provenance}\n\nWhat an event does to a lane. Included where `queue`, `lanes`, `fixed` and the functions"
        " that it calls, are known."
    )
    body = ["switch (event) {"]
    for event in automaton.EVENTS:
        lines_of = [f"case {event_name(event)}:", *(f"    {line}" for line in _effect(event)), "    break;"]
        body += ["#if ROLLS", *lines_of, "#endif"] if dict(event.where).keys() & {"rolling"} else lines_of
    for event in user_events:
        body += [f"case {event_name(event)}:", *(f"    {line}" for line in _own_effect(event)), "    break;"]
    body.append("}")
    head = "static void act(queue *q, lanes *l, fixed *f, int lane, int event)"
    return "\n".join([*lines, "", head, "{", *(f"    {line}" for line in body), "}"]) + "\n"


def own_kind(event: Event) -> str:
    """The name of the word of a user's event in the C enumeration."""
    return f"KIND_OWN_{event.name.upper()}"


def _own_effect(event: Event) -> list[str]:
    """C statements of the effect of a user's event (runtime/transitions.h)."""
    ending = {
        "go on": "goes_on(q, l, f, lane);",
        "part": "finish(q, l, f, lane, DECIDED, LANE(l->reversal, lane) >= 0 ? BOUNCE : ROTATE, 0);",
        "cut off": "finish(q, l, f, lane, DECIDED, STICK, 0);",
    }[event.actions[-1]]
    noted = f"note(q, LANE(l->index, lane), {own_kind(event)}, LANE(l->time, lane));"
    return [noted, "if (own_event_jumps(q, l, f, lane, event))", f"    {ending}"]


def _effect(event: Event) -> list[str]:
    """C statements of an effect; the word is logged first unless a rule of the action logs its own."""
    *landing, last = event.actions
    word = _chosen(event)
    if last == "rebound":
        return [*_done(event, landing), f"rebounds(q, l, f, lane, {word});"]
    if last == "separate":  # logs its own word
        return _done(event, event.actions)
    noted = f"note(q, LANE(l->index, lane), {word}, LANE(l->time, lane));"
    return [noted, *([] if event.ends else ["new_phase(l, lane);"]), *_done(event, event.actions)]


def _chosen(event: Event) -> str:
    names = [_KIND[word] for word in event.words]
    if event.chosen_by == "motion":
        return f"LANE(l->closing, lane) ? {names[0]} : {names[1]}"
    if event.chosen_by == "larger gap":
        return "contact_kind(&f->c, lane)"
    if event.chosen_by == "grip":
        return "grips(l, f, lane)"
    return names[0]


def _done(event: Event, actions: Iterable[str]) -> list[str]:
    target = target_of(event)
    put = f"LANE(l->y[GAP], lane) = {'1.0' if target == 'one' else f'LANE({target}, lane)'};"
    return [line for action in actions for line in ((put,) if action == "gap = target" else _STATEMENTS[action])]


def _enumeration(names: Iterable[str]) -> list[str]:
    return ["enum {", *(f"    {name}," for name in names), "};"]


def _described(members: Iterable[tuple[str, str]]) -> list[str]:
    return ["enum {", *(f"    {name}, /* {meaning} */" for name, meaning in members), "};"]
