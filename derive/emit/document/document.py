"""A model's equations as a LaTeX document, arranged as in Table 1 of the paper."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

from ...equations.automaton import COMPONENTS, Event
from ...laws import LAWS, Law
from ...physics.mechanics import F_c, S_n, S_t
from ...user.declarations import latex_names, unfolded
from ...user.own_events import OwnEvent
from ...user.structures import UserModel
from ...vocabulary.quantities import p_gt
from .latex import latex, naming
from .theory import Equation, theory

_ABSENT = {"bridge": ("Capillary bridge", (F_c,)), "strings": ("Pendulum strings", (S_n, S_t))}
_PREAMBLE = r"""% Emitted by wetdoublet from its derivation.
\documentclass[a4paper,10pt]{article}
\usepackage{amsmath}
\usepackage[margin=2cm]{geometry}
\usepackage{tabularx}
\allowdisplaybreaks"""
_QUANTITY_HEADS = ("quantity", "symbol", "unit", "default", "accepted", "meaning")
_EVENT_HEADS = ("event", "watched while", "effect", "meaning", "source")
EFFECTS = {"": "goes on", "separated": "ends: separated", "stick": "cut off: a stick"}
_DOLLAR = "$"
_RELATIONS = {"<": "<", ">": ">", "<=": r"\leq", ">=": r"\geq"}


@dataclass(frozen=True)
class Document:
    """Rendered equations by group; `laws` and `quantities` are rows of text."""

    title: str
    lines: tuple[tuple[str, str, str, str, str], ...]  # group, left, relation, right, note
    laws: tuple[tuple[str, ...], ...]
    quantities: tuple[tuple[str, ...], ...]
    events: tuple[tuple[str, ...], ...] = ()

    def tex(self) -> str:
        """A LaTeX document that compiles on its own."""
        body: list[str] = []
        for group, members in groupby(self.lines, key=lambda line: line[0]):
            rows = []
            for _, left, relation, right, note in members:
                remark = rf" && \text{{{_tex(note)}}}" if note else ""
                rows.append(rf"  {left} &{relation} {right}{remark}")
            body += [rf"\section*{{{_tex(group)}}}", r"\begin{align*}", " \\\\\n".join(rows), r"\end{align*}"]
        body += [r"\section*{Laws}", *_tabular("lll", ("slot", "law", "source"), self.laws)]
        if self.quantities:
            body += [r"\section*{Quantities of the model}", *_tabular("llllll", _QUANTITY_HEADS, self.quantities)]
        if self.events:
            body += [r"\section*{Events of the model}", *_tabular("lllll", _EVENT_HEADS, self.events)]
        title = rf"\title{{{_tex(self.title)}}}"
        return "\n".join(
            [_PREAMBLE, title, r"\date{}", r"\begin{document}", r"\maketitle", *body, r"\end{document}", ""]
        )


def document(
    title: str, laws: Mapping[str, str], user: UserModel | None, absent: Iterable[str] = (), friction: bool = False
) -> Document:
    """The document for a choice of laws.

    Arguments:
        laws: slot -> name of its law, of the library or of `user`.
        user: the user's model, if there is one.
        absent: slots that the scene lacks (`bridge`, `strings`, `glass`): their terms are left out.
        friction: of the dry contact.
    """
    result: dict[str, Law] = {slot: law_of(slot, name, user) for slot, name in laws.items()}
    with naming(_names(user)):
        lines = [
            line
            for line in _without(theory(result, friction, user.terms_in_si if user else None), tuple(absent))
            if line.expression != 0
        ]
        lines += [
            Equation("Groups", latex(group.symbol), group.definition, group.quantity.meaning)
            for group in (user.groups if user else ())
            if group.symbol != group.quantity.symbol
        ]
        lines += [line for event in (user.events if user else ()) for line in _of_event(event, user)]
        rendered = tuple((e.group, e.left, e.relation, latex(e.expression), e.note) for e in lines)
    rows = tuple((slot, f"{law.name}: {law.meaning}", law.source) for slot, law in result.items() if slot not in absent)
    return Document(title, rendered, rows, _quantities(user), _events(user))


def _of_event(event: OwnEvent, user: UserModel | None) -> Iterator[Equation]:
    """Guard, jump and release of a declared event, in SI."""
    assert user is not None
    rule, group, declarations = event.proposed, "Declared events", user.declarations
    yield Equation(group, "0", unfolded(rule.guard, declarations), f"before the event {rule.word}", "<")
    for target, value in rule.jump:
        yield Equation(group, f"{latex(target)}^+", unfolded(value, declarations), f"just after {rule.word}")
    if rule.releases != 0:
        yield Equation(group, "W", unfolded(rule.releases, declarations), f"that {rule.word} may give to the motion")


def _events(user: UserModel | None) -> tuple[tuple[str, ...], ...]:
    """Rows on the declared events, which come after the library's where they coincide."""
    events = [event.proposed for event in (user.events if user else ())]
    effects = [EFFECTS[event.ends] + ("; the motion jumps" if event.jump else "") for event in events]
    rows = zip(events, effects, strict=True)
    return tuple((event.word, watched(event.row), effect, event.meaning, event.source) for event, effect in rows)


def watched(event: Event) -> str:
    """Where an event is watched, in words."""
    names = {(component.name, value): name for component in COMPONENTS for value, name in component.values}
    return ", ".join(names[condition] for condition in event.where) or "always"


def law_of(slot: str, name: str, user: UserModel | None) -> Law:
    """A law by slot and name, of a user's model (in SI) or of the library."""
    for law in user.si if user else ():
        if (law.slot, law.name) == (slot, name):
            return law
    return LAWS[slot][name]


def _names(user: UserModel | None) -> dict[str, str]:
    if user is None:
        return {}
    groups = {g.symbol.name: rf"\Pi_{{{g.quantity.latex}}}" for g in user.groups if g.symbol != g.quantity.symbol}
    return latex_names(user.declarations, groups)


def _without(lines: Sequence[Equation], absent: Sequence[str]) -> list[Equation]:
    headings = {_ABSENT[slot][0] for slot in absent if slot in _ABSENT}
    nothing = {force: 0 for slot in absent if slot in _ABSENT for force in _ABSENT[slot][1]}
    glass = latex(p_gt) if "glass" in absent else None
    selection = [line for line in lines if line.group not in headings and line.left != glass]
    return [replace(line, expression=line.expression.subs(nothing)) if nothing else line for line in selection]


def _quantities(user: UserModel | None) -> tuple[tuple[str, ...], ...]:
    if user is None:
        return ()
    return tuple(
        (entry.name, f"${entry.latex}$", entry.unit, str(entry.default or "-"), entry.bounds.text, entry.meaning)
        for entry in user.declarations.quantities.values()
    )


def _tabular(columns: str, heads: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    shape = "lXX" if len(columns) == 3 else columns[:-1] + "X"
    lines = [rf"\noindent\begin{{tabularx}}{{\linewidth}}{{{shape}}}", " & ".join(heads) + r" \\ \hline"]
    lines += [" & ".join(_tex(cell) for cell in row) + r" \\" for row in rows]
    return [*lines, r"\end{tabularx}"]


def _tex(text: str) -> str:
    """Text escaped for LaTeX; parts between dollar signs are LaTeX already."""
    parts = text.split(_DOLLAR)
    for place in range(0, len(parts), 2):
        for sign, instead in (("\\", r"\textbackslash{}"), ("&", r"\&"), ("%", r"\%"), ("#", r"\#"), ("_", r"\_")):
            parts[place] = parts[place].replace(sign, instead)
        for sign in "^~":
            parts[place] = parts[place].replace(sign, rf"\{sign}{{}}")
        parts[place] = re.sub(r"[<>]=?", lambda match: rf"\ensuremath{{{_RELATIONS[match[0]]}}}", parts[place])
    return _DOLLAR.join(parts)
