"""The automaton as a Markdown page: tables of modes, events, rules, outcomes and constants."""

from collections.abc import Iterable, Sequence

from wetdoublet.derive.emit.document.document import watched
from wetdoublet.derive.equations import automaton
from wetdoublet.derive.equations.automaton import Event
from wetdoublet.derive.equations.certificates.table import CERTIFICATES

_INTRODUCTION = """A collision is integrated mode by mode. In each mode the equations are smooth. The first event ends
the mode, is reported by its word, and has its effect; of events at the same time, the one further up in the table
counts. A guard is a function of the state that reaches a target, zero or a gap. Both engines use these tables, which
are declared in `derive/equations/automaton.py`.

At initial contact the mode is closing, moving and inside the film, and inside the tangential edge if that is not below
x0."""
_VOID = """Structures without a film edge (no bridge, or a film whose rim follows the bridge volume) have no
event at x0, and conditions on the film are ignored."""

_REPORTED = """\
If there are two words, the first is reported while closing and the second while opening; at a contact, the
criterion with the largest positive gap is reported, or the last one if none is positive; where the slip
vanishes, whether friction holds the surfaces."""


def page() -> str:
    """What follows the title and the drawing of the page on events."""
    lines = [_INTRODUCTION, "", "## Modes", ""]
    lines += _table(
        ("component", "values", "meaning"),
        [(field.name, ", ".join(name for _, name in field.values), field.meaning) for field in automaton.COMPONENTS],
    )
    lines += ["", _VOID, "", "## Events", ""]
    lines += _table(
        ("event", "guard", "watched while", "reported as", "effect"),
        [
            (f"`{event.name}`", _guard(event), watched(event), _either(event.words), "; ".join(event.actions))
            for event in automaton.EVENTS
        ],
    )
    lines += ["", _REPORTED, "", "The actions of the effects:", ""]
    lines += _table(("action", "meaning"), [(action.name, action.meaning) for action in automaton.ACTIONS])
    lines += ["", "## Words", ""]
    lines += _table(("reported as", "number", "meaning"),
                    [(f"`{word.word}`", str(k), word.meaning) for k, word in enumerate(automaton.WORDS)])  # fmt: skip
    lines += ["", "## Rules", "", "Decisions that are not taken at a zero of an event function:", ""]
    lines += _table(
        ("rule", "if", "then", "reported as"),
        [
            (
                rule.name,
                "; ".join([rule.condition, *(f"`{test}`" for *_, test in rule.tests)]),
                rule.effect,
                _either(rule.words),
            )
            for rule in automaton.RULES
        ],
    )
    lines += ["", "A collision also ends where a [certificate](../explanation/certificates.md) excludes separation;"]
    lines += ["the stick is then `certified`."]
    lines += ["", "## Outcomes", ""]
    outcomes = [(f"`{outcome.word}`", str(k), outcome.condition) for k, outcome in enumerate(automaton.OUTCOMES)]
    lines += _table(("outcome", "number", "condition"), outcomes)
    lines += ["", "## Status returned by the kernel", ""]
    lines += _table(
        ("status", "number", "meaning", "outcome valid"),
        [
            (f"`{status.name}`", str(k), status.meaning, "yes" if status.answers else "no")
            for k, status in enumerate(automaton.STATUSES)
        ],
    )
    lines += ["", "## Constants", ""]
    lines += _table(
        ("name", "value", "meaning"), [(f"`{c.name}`", f"{c.value:g}", c.meaning) for c in automaton.CONSTANTS]
    )
    return "\n".join(lines) + "\n"


def certificates() -> str:
    """The table of the page on certificates."""
    rows = [
        (row.name, row.meaning, "; ".join(f"`{proof.test}`: {proof.meaning}" for proof in row.proofs))
        for row in CERTIFICATES
    ]
    return "\n".join(_table(("certificate", "what holds the doublet", "inequalities"), rows)) + "\n"


def _guard(event: Event) -> str:
    falls, rises = ("falls", "rises") if event.direction > 0 else ("rises", "falls")
    value = {"": "", "motion": f", {rises} while closing", "sliding": f", {rises} while sliding back"}
    value |= dict.fromkeys(("film", "shear"), f", {rises} beyond")
    series = " or ".join(f"`{name}`" for name in event.series)
    guard = f"{series} {falls} to {f'`{event.target}`' if event.target else 'zero'}{value[event.follows]}"
    guard += ", if that lies within reach" if event.within_reach else ""
    return f"{guard}, if a tangential force acts besides dry friction" if event.driven else guard


def _either(words: Iterable[str]) -> str:
    return ", ".join(f"`{word}`" for word in words)


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    return [f"| {' | '.join(heads)} |", "|" + "---|" * len(heads), *(f"| {' | '.join(row)} |" for row in rows)]
