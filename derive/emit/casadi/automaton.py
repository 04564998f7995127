"""The automaton as a Python module for the solvers: enumerations, tables and constants."""

from collections.abc import Iterable, Mapping, Sequence

from ...equations import automaton
from ..provenance import PROVENANCE, digest

_DOC = "A collision as a hybrid automaton: events, their guards and effects, rules, words, outcomes."
_CRITERION_FIELDS = {
    "limit": "str", "name": "str", "contact": "bool", "symbol": "str", "removed_by": "tuple[str, float] | None",
    "sentence": "str",
}  # fmt: skip
EVENT_FIELDS = {
    "name": "str", "functions": "tuple[str, ...]", "where": "tuple[tuple[str, int], ...]", "words": "tuple[str, ...]",
    "actions": "tuple[str, ...]",
    "target": "str", "follows": "str", "dips": "bool", "within_reach": "bool", "driven": "bool", "scale": "str",
    "chosen_by": "str",
}  # fmt: skip


def automaton_digest() -> str:
    """Digest of the tables of the automaton."""
    tables = "COMPONENTS CRITERIA WORDS ACTIONS EVENTS RULES OUTCOMES STATUSES PURPOSES CONSTANTS"
    return digest(*(row for table in tables.split() for row in getattr(automaton, table)))


def provenance() -> str:
    """The header lines of every file of the automaton."""
    return f"{PROVENANCE}\nAutomaton sha256 {automaton_digest()}"


def automaton_module() -> str:
    """Text of `generated/automaton.py`."""
    lines = [f"# {line}" for line in provenance().splitlines()]
    lines += [f'"""{_DOC}"""', "", "from __future__ import annotations", ""]
    lines += ["from enum import IntEnum", "from math import sqrt", "from typing import Any, NamedTuple", ""]
    lines += [f"CLOSING, OPENING = {automaton.CLOSING}, {automaton.OPENING}", ""]
    for outcome in automaton.OUTCOMES:
        lines.append(f'{outcome.name} = "{outcome.word}"  # {outcome.condition}')
    lines.append(f"OUTCOMES = ({', '.join(outcome.name for outcome in automaton.OUTCOMES)})  # by number")
    lines += ["", *_numbers("EventKind", "Number of an event in a report; KINDS has its word.",
                            [(word.name, word.meaning) for word in automaton.WORDS])]  # fmt: skip
    lines += ["", "KINDS = (", *(f"    {_text(word.word)}," for word in automaton.WORDS), ")"]
    lines += _criteria()
    lines += _numbers("Status", "Status returned by the kernel; up to LAST_ANSWER the outcome is valid.",
                      [(status.name, status.meaning) for status in automaton.STATUSES])  # fmt: skip
    last = [status.name for status in automaton.STATUSES if status.answers][-1]
    lines += ["", "", f"LAST_ANSWER = Status.{last}", ""]
    lines += _numbers("Purpose", "Part of a trajectory that the kernel integrates.",
                      [(purpose.name, purpose.meaning) for purpose in automaton.PURPOSES])  # fmt: skip
    lines += ["", ""]
    for constant in automaton.CONSTANTS:
        lines += [f"{constant.name} = {constant.value!r}  # {constant.meaning}"]
    lines += ["", *_tests(), *_events()]
    return "\n".join(lines) + "\n"


def _criteria() -> list[str]:
    doc = "A rebound criterion; `derive/equations/automaton.py` explains the fields."
    lines = ["", "", *_named_tuple("Criterion", doc, _CRITERION_FIELDS), "", ""]
    lines += ["CRITERIA = {  # by word, in the order in which they apply on entry"]
    for criterion in automaton.CRITERIA:
        lines += [f'    "{criterion.word}": Criterion(', *_members(criterion, _CRITERION_FIELDS), "    ),"]
    return [*lines, "}", ""]


def _named_tuple(name: str, doc: str, types: Mapping[str, str]) -> list[str]:
    lines = [f"class {name}(NamedTuple):", f'    """{doc}"""', ""]
    return lines + [f"    {member}: {kind}" for member, kind in types.items()]


def _members(row: object, names: Iterable[str]) -> list[str]:
    return [f"        {name}={_text(getattr(row, name))}," for name in names]


def _numbers(name: str, doc: str, members: Sequence[tuple[str, str]]) -> list[str]:
    lines = ["", f"class {name}(IntEnum):", f'    """{doc}"""', ""]
    return lines + [f"    {member} = {number}  # {meaning}" for number, (member, meaning) in enumerate(members)]


def _tests() -> list[str]:
    """Functions of the conditions of the rules."""
    lines = []
    for name, meaning, test in (test for rule in automaton.RULES for test in rule.tests):
        passed = ", ".join(f"{argument}: float" for argument in automaton.arguments(test))
        lines += ["", f"def {name}({passed}) -> bool:", f'    """True if {meaning}."""', f"    return {test}", ""]
    return lines


def _events() -> list[str]:
    doc = "An event: its guard and its effect; docs/reference/events.md explains them."
    lines = ["", *_named_tuple("Event", doc, EVENT_FIELDS)]
    void = {component.name: component.void_without for component in automaton.COMPONENTS if component.void_without}
    ignored = "# Component of the mode -> event; conditions on it are ignored in structures without that event."
    lines += [
        "",
        "",
        ignored,
        "VOID_WITHOUT = {",
        *(f'    "{name}": "{event}",' for name, event in void.items()),
        "}",
        "",
    ]
    lines += [f"ENDS = {_text(automaton.ENDS)}  # actions that end a collision", ""]
    lines += ["EVENTS = (  # in order of precedence among coincident ones"]
    for event in automaton.EVENTS:
        lines += ["    Event(", *_members(event, EVENT_FIELDS), "    ),"]
    return [*lines, ")"]


def _text(value: object) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, tuple):
        inside = ", ".join(_text(item) for item in value)
        return f"({inside}{',' if len(value) == 1 else ''})"
    return repr(value)
