"""The Fortran module: all that the header declares, and the same numbers as from C."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import Scene

from ...helpers.exported_law import FOUND, Law, written

BEADS = Scene.load("glass-beads-water")
NEED = pytest.mark.skipif("gcc" not in FOUND or shutil.which("gfortran") is None, reason="needs gcc and gfortran")
PROGRAM = """\
program all_of_it
  use, intrinsic :: iso_c_binding
  use glass_beads_water
  implicit none
  type(glass_beads_water_pair_entries) :: entries
  type(glass_beads_water_material) :: material
  type(glass_beads_water_impact) :: impacts(2)
  type(glass_beads_water_collision) :: found(2)
  type(glass_beads_water_contact) :: contact
  type(glass_beads_water_pair) :: pair
  type(glass_beads_water_pair_after) :: after
  type(glass_beads_water_particle) :: first, second
  entries = glass_beads_water_default_pair_entries()
  entries%partner_radius = 4.0d-4
  print *, glass_beads_water_material_of(entries, material)
  print *, material%reduced_radius, material%volume, material%mass_ratio
  impacts%speed = [0.3d0, 1.0d0]
  impacts%angle = [0.7d0, 0.0d0]
  impacts%spin = [100.0d0, 0.0d0]
  impacts%partner_spin = 0
  print *, glass_beads_water_collide_many(material, impacts, 2_c_long, 1.0d-9, 0_c_int, found)
  print *, found%restitution, found%contact_time, found%final_spin
  print *, glass_beads_water_begin(material, impacts(1), 1.0d-9, 0_c_int, contact)
  print *, glass_beads_water_advance(contact, 1.0d-6)
  print *, contact%gap, contact%normal_velocity, c_sizeof(contact)
  pair%normal = [0, 0, 1]
  pair%velocities = reshape([0.1d0, 0.0d0, 1.0d0, 0.0d0, 0.2d0, 0.0d0], [3, 2])
  pair%spins = reshape([10.0d0, 20.0d0, 30.0d0, 0.0d0, 0.0d0, 5.0d0], [3, 2])
  print *, glass_beads_water_collide_pair(material, pair, 1.0d-9, 0_c_int, after)
  print *, after%restitution, after%velocities, after%spins
  first%position = 0
  second%position = [0.0d0, 0.0d0, glass_beads_water_contact_distance(material)]
  first%velocity = pair%velocities(:, 1)
  second%velocity = pair%velocities(:, 2)
  first%spin = pair%spins(:, 1)
  second%spin = pair%spins(:, 2)
  print *, glass_beads_water_collide_particles(material, first, second, 1.0d-9, 1.0d-9, 0_c_int, after)
  print *, second%position, second%velocity
  if (found(2)%outcome /= GLASS_BEADS_WATER_BOUNCE .or. GLASS_BEADS_WATER_IN_SPACE /= 1) error stop
  impacts(1)%speed = -1
  print '(a)', glass_beads_water_message(glass_beads_water_collide(material, impacts(1), 1.0d-9, 0_c_int, found(1)))
end program all_of_it
"""


def test_everything_of_the_header_is_there(folder: Path):
    """Constants, structures and functions by the same names."""
    header, module = ((folder / f"glass_beads_water.{end}").read_text() for end in ("h", "f90"))
    header = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)
    names = {*re.findall(r"\bglass_beads_water_\w+", header), *re.findall(r"\bGLASS_BEADS_WATER_(?!H\b)\w+", header)}
    declared = re.findall(r"(?:parameter ::|function|type, bind\(c\) ::) (\w+)", module, re.IGNORECASE)
    assert len(names) > 60
    assert names - {*declared} == set()


@NEED
@pytest.mark.slow
def test_numbers_are_those_of_c(tmp_path: Path):
    """Materials, collisions, a contact, pairs and particles in space; the module compiles without a warning."""
    folder = written(BEADS, tmp_path)
    (folder / "all_of_it.f90").write_text(PROGRAM)
    strict = ["gfortran", "-std=f2018", "-Wall", "-Wextra", "-pedantic", "-Werror", "-ffree-line-length-none"]
    law = Law(BEADS, folder)
    subprocess.run(["gcc", "-std=c99", "-O1", "-fno-math-errno", "-c", "glass_beads_water.c"], cwd=folder, check=True)
    files = ["glass_beads_water.f90", "all_of_it.f90", "glass_beads_water.o"]
    subprocess.run([*strict, "-o", "all_of_it", *files, "-lm"], cwd=folder, check=True)
    *said, words = subprocess.run(
        ["./all_of_it"], cwd=folder, capture_output=True, text=True, check=True
    ).stdout.splitlines()
    assert words == "speed must be > 0, m/s"
    numbers = np.array(" ".join(said).split(), float)
    entries = BEADS.with_entries({"partner.radius": 4e-4, "partner.density": 2500.0})
    material, own = law.material(), entries.material
    for name in material.dtype.names or ():
        material[name] = own.get(name, material[name])
    impacts = law.impacts(speed=np.array([0.3, 1.0]), angle=np.array([0.7, 0.0]), spin=np.array([100.0, 0.0]))
    found = law.collide(impacts, material=material)
    contact = law.begin(impacts[:1], material=material)
    law.advance(contact, 1e-6)
    velocities, spins = [[0.1, 0, 1], [0, 0.2, 0]], [[10, 20, 30], [0, 0, 5]]
    pairs = law.pairs([0, 0, 1], np.array([velocities], float), np.array([spins], float))
    after = law.collide_pairs(pairs, material=material)[0]
    both = np.zeros(2, law.dtype("particle"))
    both["velocity"], both["spin"] = velocities, spins
    both["position"][1, 2] = 6.5e-4 + own["film_thickness"]
    law.collide_particles(both, material=material)
    expected = [
        0, own["reduced_radius"], own["volume"], own["mass_ratio"], 0, *found["restitution"], *found["contact_time"],
        *found["final_spin"], 0, 0, contact["gap"][0], contact["normal_velocity"][0], contact.dtype.itemsize,
        0, after["restitution"], *after["velocities"].ravel(), *after["spins"].ravel(), 0, *both["position"][1],
        *both["velocity"][1],
    ]  # fmt: skip
    np.testing.assert_allclose(numbers, np.array(expected, float), rtol=1e-9, atol=1e-18)
