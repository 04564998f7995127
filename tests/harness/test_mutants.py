"""Each property fails for a package with a fault of its kind."""

import os
import shutil
import subprocess
import sys
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


@pytest.mark.parametrize("name", MUTANTS)
def test_a_property_notices_its_mutant(name: str, copy: Path, tmp_path: Path) -> None:
    """It fails by an assertion, and of an error in one line by another kind of error."""
    mutant = MUTANTS[name]
    file = copy / mutant.file
    text = file.read_text(encoding="utf-8")
    assert mutant.old in text
    file.write_text(text.replace(mutant.old, mutant.new), encoding="utf-8")
    environment = os.environ | {"PYTHONPATH": str(copy.parent), "WETDOUBLET_MUTANT": "1"}
    if mutant.file.startswith("derive/"):  # what is kept of structures is not named by the derivation
        environment["WETDOUBLET_CACHE"] = str(tmp_path)
    command = (sys.executable, "-m", "pytest", "-x", "-p", "no:xdist", "-o", "addopts=--import-mode=importlib -q")
    try:
        done = subprocess.run(
            [*command, "-p", "no:cacheprovider", f"{HERE / mutant.property}"], cwd=HERE.parents[1], text=True,
            env=environment, capture_output=True, timeout=600, check=False,
        )  # fmt: skip
    finally:
        file.write_text(text, encoding="utf-8")
    assert done.returncode == 1, done.stdout[-2000:] + done.stderr[-2000:]
    assert "1 failed" in done.stdout
    assert str(copy) in done.stdout or "AssertionError" in done.stdout or "DID NOT RAISE" in done.stdout
