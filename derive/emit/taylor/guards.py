"""The kernel's search for the events of the automaton, and what their derivatives need, in C."""

from ...equations.automaton import CLOSING, COMPONENTS, EVENTS, OPENING, Event
from ...equations.events import SERIES
from ...equations.model import Model
from ..casadi.printer import EmissionError
from .constants import Constants
from .layout import comment, compiled_if, documented, function, struct
from .ledger import Valued
from .program import Program
from .recurrences import Recurrences

# Series of the kernel and their values at the states `y`; then the series of resting contact with friction
_STATES = ("gap", "normal_velocity", "rotation", "orbital_momentum", "spin")
_SERIES = {name: (f"s->{name}", f"{{y}}[{name.upper()}]") for name in _STATES} | {
    "glass_clearance": ("s->glass.result", "glass_clearance(&f->c, {y})"),
    "acceleration": ("s->acceleration", "-inward_force(&f->c, {y})"),
}
_AT_REST = {name: f"r->rest_{name}" for name in ("slip", "grip_backward", "grip_forward")}
_DIFFERENTIATED = ("gap", "normal_velocity", "glass_clearance")
# Targets that are no groups: value, derivative by a group, and the preprocessor's condition for that derivative
_TARGETS = {
    "": ("zero", "", ""),
    "contact": ("f->contact", "choose(contact_moves_with(&f->c, group), splat(1.0), splat(0.0))", ""),
    "rupture": ("f->end", "group == BY_RUPTURE_GAP ? splat(1.0) : splat(0.0)", "BRIDGE"),
    "film edge": ("one", "", ""),
    "tangential edge": ("f->edge", "tangential_edge_along(&f->c, group)", "OBLIQUE"),
    "half turn": ("splat(PI)", "", ""),
}
_REACH = "(f->edge != 1.0) & (f->edge < f->end) & (f->edge > vec_min(f->contact, one))"
_DRIVEN = "DRIVEN(l->shear)"
_LANES = {("resting", 0): "moves", ("resting", 1): "rests", ("motion", CLOSING): "l->closing",
          ("motion", OPENING): "NOT(l->closing)", ("film", 1): "inside", ("film", 0): "beyond",
          ("rolling", 0): "(l->rolling == 0.0)", ("rolling", 1): "(l->rolling != 0.0)"}  # fmt: skip
_AWAY = "const vec zero = splat(0.0), one = splat(1.0), away = choose(l->closing, one, -one);"
_UNUSED = "(void)zero; (void)moves; (void)rests; (void)inside; (void)beyond;"


def event_name(event: Event) -> str:
    """The name of an event in the C enumeration."""
    return f"AT_{event.name.upper()}"


def target_of(event: Event) -> str:
    """The target of an event as C text."""
    return _TARGETS[event.target][0] if event.target in _TARGETS else f"f->c.{event.target}"


def guards_header(provenance: str) -> str:
    """Text of `generated/taylor/guards.h`."""
    lines = comment(f"{provenance}\n\nThe search for the events of a step. Included behind what it calls.")
    return "\n".join([*lines, "", *_next_gap(), *_find(), *_find_at_rest(), *_kept(), *_derivatives()]).rstrip() + "\n"


def _next_gap() -> list[str]:
    body = [*_film(), _AWAY, "vec gap = away*-HUGE_VAL;", "mask nearer;", "(void)zero; (void)inside; (void)beyond;",
            "*event = splat_mask(0);"]  # fmt: skip
    for event in EVENTS:
        if event.at_gap:
            target = target_of(event)
            lanes = [_LANES[condition] for condition in event.where if condition != ("resting", 0)]
            if event.follows:  # from beyond while closing, from inside while opening
                lanes += [f"(l->closing ^ (l->{event.follows} != 0.0))", f"(away*({target} - gap) > 0.0)"]
            else:
                lanes.append(f"({target} {'>' if event.direction > 0 else '<'} gap)")
            lanes += [_REACH] if event.within_reach else []
            body += _present(event, [
                f"nearer = {' & '.join(lanes)};",
                f"gap = choose(nearer, {target}, gap);",
                f"*event = choose_whole(nearer, splat_mask({event_name(event)}), *event);",
            ])  # fmt: skip
    return documented(
        "The nearest gap ahead at which an event is watched, and that event; of several the first in the table.",
        "static inline vec next_gap(const lanes *l, const fixed *f, mask *event)",
        [*body, "return gap;"],
    )


def _find() -> list[str]:
    body = [*_film(), _AWAY, "const mask moves = l->alive & NOT(l->resting), rests = l->alive & l->resting;", _UNUSED,
            "first_event first;", "first.time = splat(NO_ROOT);", "first.event = splat_mask(0);", "vec part = one;",
            "mask close, event;", "vec gap = next_gap(l, f, &event);"]  # fmt: skip
    gaps = ["close = moves & NOT(away*(first.gap - gap) > 0.0);", "if (bits(close))",
            "    look(&first, close, s->gap, gap, away, h, event);"]  # fmt: skip
    for event in EVENTS:
        if event.at_gap:
            body, gaps = [*body, *gaps], []
        elif event.series[0] not in _AT_REST:
            body += _present(event, _search(event))
        if event.series == ("normal_velocity",):
            body += ["part = up_to_turn(&first);", "h *= part;", "first.gap = sum_at(s->gap, h);"]
    body += ["#if OWN_EVENTS", "find_own_events(s, l, f, h, &first);", "#endif /* OWN_EVENTS */"]
    return documented(
        "The first event of a step in each lane; of coincident ones the first in the table. The turn comes first: up "
        "to there the gap is monotonic, and extremal at the end. Under a constant force steps are unlimited, and all "
        "events before the turn lie in a tiny part of the step.",
        "static first_event find_events(const series *s, const lanes *l, const fixed *f, vec h)",
        [*body, "first.time *= part;", "return first;"],
    )


def _find_at_rest() -> list[str]:
    body = [
        "const vec zero = splat(0.0), one = splat(1.0);",
        "const mask rests = l->alive & l->resting;",
        "mask close;",
    ]
    for event in EVENTS:
        if event.series[0] in _AT_REST:
            body += _search(event)
    lines = documented(
        "The same in resting contact with friction; an earlier event is kept.",
        "OUTLINE void find_events_at_rest(const rubbing *r, const lanes *l, vec h, first_event *first)",
        [line.replace("look(&first", "look(first") for line in body],
    )
    return [*compiled_if("ROLLS", lines[:-1]), ""]


def _search(event: Event) -> list[str]:
    """C lines that search for an event that is not at a gap, in the lanes in which it is watched and not excluded."""
    lines, target = [], target_of(event)
    watched = _watched(event) or ["l->alive"]
    sign = {"": "one", "motion": "-away"}.get(event.follows, f"l->{event.follows}")
    sign = sign if event.direction > 0 else f"-{sign}"
    if event.follows not in ("", "motion"):
        watched.append(f"({sign} != 0.0)")
    for name in event.series:
        lines.append(f"close = {' & '.join(watched)};")
        series = _AT_REST.get(name) or _SERIES.get(name, (f"{name}.result",))[0]
        if series == f"{name}.result":
            lines += [f"{name}_series {name};", "if (bits(close))", "    for (int k = 0; k <= ORDER; k++)",
                      f"        {name}_coefficients(&{name}, s, &f->c, k);"]  # fmt: skip
        if event.least:
            target = f"only({sign}*{series}[0] < {event.least}, -{event.least}*{sign})"
        if event.bound == "terms" or event.target:  # `least_of` tells of zero alone
            excluded = f"{_guard(event, f'{series}[0]')} > reach({series}, h)"
        elif event.follows:  # the component has the sign of the series
            excluded = f"least_of({series}, h) > 0.0"
        else:
            excluded = f"({_guard(event, f'{series}[0]')} > 0.0) & (least_of({series}, h) > 0.0)"
        search = f"look(&first, close, {series}, {target}, {sign}, h, splat_mask({event_name(event)}));"
        lines += ["if (bits(close))", f"    close &= NOT({excluded});", "if (bits(close))", f"    {search}"]
    return lines


def _watched(event: Event) -> list[str]:
    """Factors of the mask of the lanes in which an event is watched."""
    return [_LANES[condition] for condition in event.where] + ([_DRIVEN] if event.driven else [])


def _guard(event: Event, value: str) -> str:
    """C text of an event's guard for this text of its series: positive until the event, zero at it.

    Only for an event with an empty `follows`.
    """
    if not event.target:  # a leading minus applies to the whole text
        return value if event.direction > 0 else value[1:] if value.startswith("-") else f"-{value}"
    return f"{value} - {target_of(event)}" if event.direction > 0 else f"{target_of(event)} - {value}"


def _kept() -> list[str]:
    body = [*_film(), _AWAY, "const mask moves = NOT(l->resting), rests = l->resting;", _UNUSED, "mask event, far;",
            "vec gap = next_gap(l, f, &event);",
            "mask kept = rests | (2.0*away*(to[GAP] - gap) > away*(from[GAP] - gap));"]  # fmt: skip
    for event in EVENTS:
        (name, *_), watched = event.series, _watched(event)
        if not event.at_gap and name not in _AT_REST and name != "normal_velocity":
            value = _SERIES.get(name, ("", f"{name}_at(&f->c, {{y}})"))[1]
            before, after = (_guard(event, value.format(y=y)) for y in ("from", "to"))
            lanes = f"NOT({' & '.join(watched)}) | far" if watched else "far"
            body += _present(event, [f"far = 2.0*({after}) > vec_max({before}, zero);", f"kept &= {lanes};"])
    return documented(
        "Lanes in which no event lies between two states, as far as shows: each guard keeps half its value. Turns and "
        "resting contact with friction are left to the caller.",
        "static mask guards_kept(const lanes *l, const fixed *f, const vec *from, const vec *to)",
        [*body, "return kept;"],
    )


def _derivatives() -> list[str]:
    moving = [event for event in EVENTS if event.at_gap and _TARGETS.get(event.target, ("", "a group"))[1]]
    names = [f"GAP_OF_{event.name.upper()}" for event in moving]
    lines = comment("Gaps of events that move with a group, and their events.")
    lines += [f"enum {{ {', '.join(names)}, MOVING_GAPS }};",
              f"static const int EVENT_AT[MOVING_GAPS] = {{{', '.join(map(event_name, moving))}}};", ""]  # fmt: skip
    body = ["(void)f; (void)group;", "switch (which) {"]
    for event, name in zip(moving, names, strict=True):
        by_group = f"group == BY_{event.target.upper()} ? splat(1.0) : splat(0.0)", _structures(event)
        by, condition = _TARGETS[event.target][1:] if event.target in _TARGETS else by_group
        case = [f"case {name}:", f"    return {by};"]
        body += compiled_if(condition, case) if condition else case
    lines += documented(
        "Derivative of such a gap by a group.",
        "static inline vec moving_gap_along(const fixed *f, int which, int group)",
        [*body, "default:", "    return splat(0.0);", "}"],
    )
    for name in _DIFFERENTIATED:
        events = [f"(event == {event_name(event)})" for event in EVENTS if event.series == (name,)]
        lines += function(f"static inline mask is_on_{name}(mask event)", [f"return {' | '.join(events)};"])
        lines.append("")
    return compiled_if("GRADIENTS", lines[:-1])


def _film() -> list[str]:
    """The lanes inside the film and beyond it; all lanes in structures in which conditions on the film are void."""
    (void,) = (component.void_without for component in COMPONENTS if component.name == "film")
    (edge,) = (event for event in EVENTS if event.name == void)
    inside, beyond = (
        "const mask inside = l->film != 0.0, beyond = NOT(inside);",
        "const mask inside = splat_mask(TRUTH)",
    )
    return [f"#if {_structures(edge)}", inside, "#else", f"{beyond}, beyond = inside;", "#endif"]


def _structures(event: Event) -> str:
    """The condition of the preprocessor for the structures that have an event."""
    return " && ".join(feature.upper().replace("NOT ", "!") for feature in event.structures)


def _present(event: Event, lines: list[str]) -> list[str]:
    return compiled_if(_structures(event), lines) if event.structures else lines


def series_of_guards(model: Model, constants: Constants, valued: Valued) -> list[str]:
    """C functions for a structure's header: series and values that events watch and the flow does not compute."""
    lines: list[str] = []
    for event in EVENTS:
        for name in event.series if model.structure.has(*event.structures) else ():
            if name not in _SERIES and name not in _AT_REST:
                expression = SERIES[name](model.structure)
                program = Program.for_outputs(model.states, [expression], model.definitions)
                result = program.series(expression, f"value_of_{name}")
                recurrences = Recurrences(program, constants, lambda series: f"m->{series}")
                lines += struct(f"{name}_series", [*recurrences.fields(), "vec result[TERMS];"])
                arguments = f"{name}_series *s, const series *m, const constants *c, int k"
                lines += documented(
                    f"Coefficient k of the series that the event {event.name} watches.",
                    f"static inline void {name}_coefficients({arguments})",
                    ["(void)c; (void)m;", *recurrences.lines(), f"s->result[k] = {recurrences.array(result)}[k];"],
                )
                head = f"static inline vec {name}_at(const constants *c, const vec *y)"
                lines += valued([(name, expression)], head, {name: "return"}, "The same at given states.")
    return lines


def check_differentiable(model: Model) -> None:
    """Raise EmissionError if a structure has an event that goes on and whose derivative the kernel does not take."""
    for event in EVENTS:
        rests = ("resting", 1) in event.where  # resting contact is a boundary, where no derivative exists
        derivable = rests or event.ends or set(event.series) <= set(_DIFFERENTIATED)
        if not derivable and model.structure.has(*event.structures):
            raise EmissionError(f"the event {event.name} has no derivatives in C")
