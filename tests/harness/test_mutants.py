"""Each property fails for a package with a fault of its kind."""

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import wetdoublet.solvers

from .mutants import MUTANTS

HERE = Path(__file__).resolve().parent
PACKAGE = Path(wetdoublet.solvers.__file__).resolve().parents[1]
ROOMS = ("derive", "generated", "solvers")

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The package, copied into a folder that is before it on the path of modules."""
    folder = tmp_path_factory.mktemp("mutants") / "wetdoublet"
    for room in ROOMS:
        shutil.copytree(PACKAGE / room, folder / room, ignore=shutil.ignore_patterns("__pycache__", "*.so"))
    for file in filter(Path.is_file, Path(wetdoublet.__path__[0]).glob("*.py")):
        shutil.copyfile(file, folder / file.name)
    return folder


@pytest.fixture(scope="module")
def outcome(copy: Path) -> Iterator[Callable[[str], tuple[int, str]]]:
    """Exit status and output of a test with the package that is copied."""
    with subprocess.Popen(
        (sys.executable, "-m", "tests.harness.forks", copy.parent), cwd=HERE.parents[1], text=True,
        env=os.environ | {"WETDOUBLET_MUTANT": "1"}, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
    ) as process:  # fmt: skip
        assert process.stdin and process.stdout

        def ask(test: str) -> tuple[int, str]:
            print(test, file=process.stdin, flush=True)
            status, text = json.loads(process.stdout.readline())
            return status, text

        yield ask
        process.stdin.close()


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


@pytest.mark.parametrize("name", MUTANTS)
def test_a_property_notices_its_mutant(name: str, copy: Path, outcome: Callable[[str], tuple[int, str]]) -> None:
    """It fails by an assertion, and of an error in one line by another kind of error."""
    mutant = MUTANTS[name]
    file = copy / mutant.file
    text = file.read_text(encoding="utf-8")
    assert mutant.old in text
    mutated, manifest = text.replace(mutant.old, mutant.new), copy / "generated" / "manifest.json"
    listed = manifest.read_text(encoding="utf-8")  # lest a digest that disagrees is what is noticed
    file.write_text(mutated, encoding="utf-8")
    manifest.write_text(listed.replace(_digest(text), _digest(mutated)), encoding="utf-8")
    try:
        status, shown = outcome(f"{HERE / mutant.property}")
    finally:
        file.write_text(text, encoding="utf-8")
        manifest.write_text(listed, encoding="utf-8")
    assert status == 1, shown[-2000:]
    assert "1 failed" in shown
    assert str(copy) in shown or "AssertionError" in shown or "DID NOT RAISE" in shown
