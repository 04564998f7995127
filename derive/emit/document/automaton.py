"""The automaton as a page of Markdown: modes, events, rules, outcomes and constants as tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ...equations import automaton
from ...equations.automaton import Event

DIAGRAM = "automaton.svg"
_INTRODUCTION = """A collision is integrated mode by mode. In each mode the equations are smooth, and events are watched
for. The first one to happen ends the mode, is reported by its word, and has its effect; of events at one time
the one further up in the table counts. Both engines read it; it is written down in `derive/equations/automaton.py`.

At initial contact the mode is closing, moving and inside the film, and inside the tangential edge if that is not below
x0."""
_VOID = """Where nothing happens at x0 (no bridge, or a film that ends with the bridge) there is no film edge, and there
are no conditions on the film."""


def automaton_page(provenance: str) -> str:
    """Text of `generated/automaton.md`."""
    lines = [*(f"<!-- {line} -->" for line in provenance.splitlines()), "", "# The events of a collision", ""]
    lines += [_INTRODUCTION, "", f"![Modes and the events between them]({DIAGRAM})", "", "## Modes", ""]
    lines += _table(
        ("part", "values", "which is"),
        [(each.name, ", ".join(name for _, name in each.values), each.meaning) for each in automaton.COMPONENTS],
    )
    lines += ["", _VOID]
    lines += ["", "## Events", ""]
    lines += _table(
        ("event", "guard falls through zero", "watched while", "reported as", "effect"),
        [
            (f"`{each.name}`", _guard(each), _where(each), _either(each.words), "; ".join(each.actions))
            for each in automaton.EVENTS
        ],
    )
    lines += ["", *_reported_by(), "", "The effects, one by one:", ""]
    lines += _table(("action", "meaning"), [(each.name, each.meaning) for each in automaton.ACTIONS])
    lines += ["", "## Words", ""]
    lines += _table(("reported as", "number", "meaning"),
                    [(f"`{each.word}`", str(k), each.meaning) for k, each in enumerate(automaton.WORDS)])  # fmt: skip
    lines += ["", "## Rules", "", "What is decided where no function falls through zero:", ""]
    lines += _table(
        ("rule", "if", "then", "reported as"),
        [(each.name, each.condition, each.effect, _either(each.words)) for each in automaton.RULES],
    )
    lines += [
        "",
        "A mode also ends where a certificate proves that the two never separate; the stick is then `certified`.",
    ]
    lines += ["", "## Outcomes", ""]
    outcomes = [(f"`{each.word}`", str(k), each.condition) for k, each in enumerate(automaton.OUTCOMES)]
    lines += _table(("outcome", "number", "where"), outcomes)
    lines += ["", "## What the kernel says of a collision", ""]
    lines += _table(
        ("status", "number", "meaning", "outcome stands"),
        [
            (f"`{each.name}`", str(k), each.meaning, "yes" if each.answers else "no")
            for k, each in enumerate(automaton.STATUSES)
        ],
    )
    lines += ["", "## Constants", ""]
    lines += _table(
        ("name", "value", "meaning"), [(f"`{c.name}`", f"{c.value:g}", c.meaning) for c in automaton.CONSTANTS]
    )
    return "\n".join(lines) + "\n"


def _reported_by() -> list[str]:
    return [
        "Where two words stand, the first is reported while closing, the second while opening; at a contact, the first",
        "whose gap is the largest and positive, else the last.",
    ]


def _guard(event: Event) -> str:
    functions = [f"`{name}`" for name in event.functions]
    sign = {"": "", "motion": ", negative while closing", "film": ", negative beyond", "shear": ", negative beyond"}
    said = (functions[0] if len(functions) == 1 else f"the smallest of {', '.join(functions)}") + sign[event.follows]
    return f"{said}, if its gap lies within reach" if event.within_reach else said


def _where(event: Event) -> str:
    names = {(each.name, value): name for each in automaton.COMPONENTS for value, name in each.values}
    return ", ".join(names[condition] for condition in event.where) or "always"


def _either(words: Iterable[str]) -> str:
    return ", ".join(f"`{word}`" for word in words)


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    return [f"| {' | '.join(heads)} |", "|" + "---|" * len(heads), *(f"| {' | '.join(row)} |" for row in rows)]
