"""The automaton has what the structures have and what the interface promises, and is emitted without being read."""

import ast
import subprocess
import sys

import pytest
from wetdoublet.derive.emit.write import GENERATED
from wetdoublet.derive.equations.automaton import EVENTS, OUTCOMES, RULES, STATUSES, WORDS
from wetdoublet.derive.equations.model import derive
from wetdoublet.derive.physics.structure import Structure

# as the interface has them; further criteria add theirs
KINDS = {
    "glass", "elastic", "rough", "turned", "fell back", "film edge", "tangential edge", "rests", "released", "rupture",
    "rotation reverses", "half turn",
}  # fmt: skip


def event_functions(name: str) -> set[str]:
    """Keys of what `events` of an emitted structure returns."""
    tree = ast.parse((GENERATED / name).read_text())
    found = [node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == "events"]
    dicts = [node for function in found for node in ast.walk(function) if isinstance(node, ast.Dict)]
    return {str(ast.literal_eval(key)) for each in dicts for key in each.keys if key is not None}


COMMITTED = {path.name: found for path in GENERATED.glob("*.py") if (found := event_functions(path.name))}
ROUGH = Structure(True, True, False, friction="solid")  # derived when a scene asks for friction


@pytest.fixture(scope="module")
def watched() -> dict[str, set[str]]:
    """Event functions of structures by name."""
    return COMMITTED | {ROUGH.name: set(dict(derive(ROUGH)["events"].outputs))}


@pytest.mark.parametrize("name", [*sorted(COMMITTED), ROUGH.name])
def test_every_event_function_of_a_structure_is_a_guard(name, watched):
    """Nothing that a structure watches for is without an event."""
    assert watched[name] <= {function for event in EVENTS for function in event.functions}


def test_every_guard_is_an_event_function_of_some_structure(watched):
    """Nothing is watched for that no structure has."""
    assert {function for event in EVENTS for function in event.functions} == set().union(*watched.values())


def test_the_words_are_those_of_the_interface():
    """Outcomes in the order of their numbers, and kinds of events: none is missing."""
    assert [each.word for each in OUTCOMES] == ["stick", "stick-rotate-separate", "bounce"]
    assert {each.word for each in WORDS} >= KINDS


def test_every_word_is_reported_by_an_event_or_a_rule():
    """And neither reports another."""
    reported = {word for each in (*EVENTS, *RULES) for word in each.words}
    assert reported == {word.word for word in WORDS}


def test_statuses_that_answer_come_first():
    """One number tells them from those that hand over."""
    answers = [each.answers for each in STATUSES]
    assert answers == sorted(answers, reverse=True)


_COMMAND = """
import sys
from wetdoublet.solvers.commands.cli import main
import wetdoublet.derive.emit.write
try:
    main(["generate", "--template"])
except SystemExit as ended:
    assert not ended.code
print([name for name in sys.modules if name.startswith("wetdoublet.generated")], file=sys.stderr)
"""


@pytest.mark.slow
def test_generate_reads_nothing_emitted():
    """So it emits, and checks, where the emitted automaton is broken or missing."""
    done = subprocess.run([sys.executable, "-c", _COMMAND], capture_output=True, text=True, timeout=300, check=False)
    assert (done.returncode, done.stderr.strip()) == (0, "[]")
