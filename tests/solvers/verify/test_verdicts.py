"""Symbolic verdicts are made once for the same equations, and again where anything that they depend on is another."""

import ast
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from wetdoublet import derive
from wetdoublet.solvers.verify.identities import kept_verdicts, symbolic_key
from wetdoublet.solvers.verify.report import Finding, Report

Verdicts = Callable[..., list[Finding]]
FINDINGS = [
    Finding("Symbolic", "one", "it holds", "identity", "", True, about=("a line",)),
    Finding("Symbolic", "two", "it does not", "left over: x", "", False),
]


@pytest.fixture
def verdicts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Verdicts:
    """Verdicts of a key from an empty cache; `verdicts.made` has those that were not kept."""
    monkeypatch.setenv("WETDOUBLET_CACHE", str(tmp_path / "cache"))

    def told(key: str, **more: bool) -> list[Finding]:
        return list(kept_verdicts(key, made, **more))

    def made() -> Iterator[Finding]:
        for finding in FINDINGS:
            told.made.append(finding)  # type: ignore[attr-defined]  # the function keeps a count
            yield finding

    told.made = []  # type: ignore[attr-defined]  # the function keeps a count
    return told


def test_a_second_run_makes_none_and_says_so(verdicts: Verdicts) -> None:
    """The same findings, a failure and its lines included, are read and not made; the report counts them."""
    first, second = verdicts("a"), verdicts("a")
    assert verdicts.made == first == FINDINGS  # type: ignore[attr-defined]  # the function keeps a count
    assert [(one.name, one.ok, one.about) for one in second] == [(one.name, one.ok, one.about) for one in FINDINGS]
    assert str(Report(tuple(second))).endswith("(2 verdicts kept from an earlier run on the same equations)")
    assert "kept" not in str(Report(tuple(first)))


def test_what_is_asked_for_anew_is_made(verdicts: Verdicts) -> None:
    """Another key, and `recompute`, make all verdicts."""
    for key, more in (("a", {}), ("b", {}), ("a", {"recompute": True})):
        verdicts(key, **more)
    assert len(verdicts.made) == 6  # type: ignore[attr-defined]  # the function keeps a count


def test_the_key_has_the_laws_and_the_settings(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other laws, and other settings of sympy's, are another key."""
    keys = {symbolic_key({}), symbolic_key({"bridge": "mikami"}), symbolic_key({"bridge": "willett"})}
    monkeypatch.setenv("SYMPY_USE_CACHE", "no")
    assert len(keys | {symbolic_key({})}) == 4


def test_the_derivation_depends_on_its_own_files_sympy_and_casadi_alone() -> None:
    """What its modules import is one of these or the standard library: files and versions are in the digest."""
    folder, outside = Path(derive.__file__).parent, {"sympy", "casadi", *sys.stdlib_module_names}
    for file in folder.rglob("*.py"):
        depth = len(file.relative_to(folder).parts)
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                for name in node.names:
                    assert name.name.partition(".")[0] in outside, file
            elif isinstance(node, ast.ImportFrom):
                root = (node.module or "").partition(".")[0]
                own = (node.module or "").startswith("wetdoublet.derive.")  # of a model file of the library
                assert own or (node.level <= depth if node.level else root in outside), file
