"""Symbolic verdicts are made once for the same equations, and again where anything that they depend on is another."""

import ast
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import wetdoublet
from wetdoublet import derive
from wetdoublet.solvers.host.emitted import DERIVE, sources_of_derivation
from wetdoublet.solvers.verify.build import needed
from wetdoublet.solvers.verify.identities import kept_verdicts, symbolic_key
from wetdoublet.solvers.verify.report import Finding, Report
from wetdoublet.solvers.verify.verdicts import PROVED, findings, proved, shipped

of_these_versions = pytest.mark.skipif(not shipped(), reason="the package's verdicts were proved with another sympy")
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
    last = "(2 verdicts kept from an earlier run, on the same equations; --recompute proves them here)"
    assert " ".join(str(Report(tuple(second))).split()).endswith(last)
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


def test_the_package_has_the_verdicts_of_its_own_derivation() -> None:
    """None is missing, left over or of another text; after a change `python -m wetdoublet.solvers.verify.build`."""
    content = json.loads(PROVED.read_bytes())
    assert content["of"]["derivation"] == sources_of_derivation()
    assert content["verdicts"].keys() == needed().keys()


@pytest.mark.slow
def test_the_verdicts_of_the_package_are_what_is_proved() -> None:
    """Each is made again from the derivation as it is, in the same words."""
    for key, proof in needed().items():
        assert [list(row) for row in proved(proof)] == json.loads(PROVED.read_bytes())["verdicts"][key]


@of_these_versions
def test_verdicts_of_the_package_say_so() -> None:
    """Without sympy's work, all that the presets ask for; the report counts them, and `recompute` takes none."""
    known = list(findings({}))
    assert all(finding.shipped and not finding.kept for finding in known)
    last = f"({len(known)} verdicts proved when this version was built, on the same equations; --recompute"
    assert last in " ".join(str(Report(tuple(known))).split())
    assert not next(findings({}, recompute=True)).shipped


_FINDINGS = """
import json, sys
from wetdoublet.solvers.verify import verdicts
every = verdicts.proofs_of
verdicts.proofs_of = lambda laws: (proof for proof in every(laws) if proof.function.__name__ == sys.argv[1])
print(json.dumps([[finding.name, finding.ok, finding.shipped, finding.kept] for finding in verdicts.findings({})]))
"""
MUTANTS = {  # file, text, what is put there, the function that proves it, and the check that fails
    "a law that a check names": (
        "laws/constant.py", "cos(phi)", "cos(phi / 2)", "generalised_number", "generalised centrifugal number",
    ),
    "a law that a check is asked about": (
        "laws/film.py", "stopping=_taken(normal_force())", "stopping=2 * _taken(normal_force())",
        "head_on_closed_form", "head-on closed form: finite",
    ),
}  # fmt: skip


@pytest.mark.slow
@of_these_versions
@pytest.mark.parametrize("name", MUTANTS)
def test_a_changed_term_is_proved_anew_and_fails(name: str, tmp_path: Path) -> None:
    """The package's verdict on the law as it was is not taken for it."""
    path, old, new, function, failing = MUTANTS[name]
    package = tmp_path / "wetdoublet"
    for room in ("derive", "generated", "solvers"):
        ignored = shutil.ignore_patterns("__pycache__", "*.so", "built")
        shutil.copytree(DERIVE.with_name(room), package / room, ignore=ignored)
    for file in filter(Path.is_file, Path(wetdoublet.__path__[0]).glob("*.py")):
        shutil.copyfile(file, package / file.name)
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "WETDOUBLET_CACHE": str(tmp_path / "cache")}
    text = (package / "derive" / path).read_text(encoding="utf-8")
    assert old in text
    (package / "derive" / path).write_text(text.replace(old, new), encoding="utf-8")
    command = [sys.executable, "-c", _FINDINGS, function]
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert [failing, False, False, False] in json.loads(done.stdout)
