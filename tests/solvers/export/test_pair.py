"""Materials of pairs in C: those of scenes with the same entries, whatever the sizes; bad entries are named."""

import ctypes
import math
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, collide_many

from ...helpers.exported_law import FOUND, Law, law_alone
from ...helpers.flags import QUICK
from .conftest import SPHERES

pytestmark = pytest.mark.skipif("gcc" not in FOUND, reason="needs gcc and g++")
PAGE = Path(__file__).parents[3] / "docs" / "how-to" / "c-law.md"
GRANULATION, BEADS = Scene.load("granulation"), Scene.load("glass-beads-water")
RUBS = {"particles.friction": 0.3, "particles.contact_tangential_restitution": 0.4, "model.contact_friction": "all"}
SCENES = {
    "by volume": GRANULATION.with_entries({"bridge.volume": "2e-14 m^3", "model.film": "constant-volume"}),
    "by a part": BEADS.with_entries({"bridge.coating_fraction": 0.2, "model.film": "cavitating", **RUBS}),
    "wall": BEADS.with_entries({"partner.wall": True, "partner.coating_thickness": "1 um"}),
    "strings": Scene.load("pendulum"),
}


class Pairs:
    """The materials of pairs by the exported law in a folder."""

    def __init__(self, scene: Scene, law: Law) -> None:
        self.scene, self.law = scene, law
        kind = self.law.dtype("pair_entries")
        fields = [(name, ctypes.c_double) for name in kind.names]
        function = self.law.function("default_pair_entries")
        function.restype = type("Entries", (ctypes.Structure,), {"_fields_": fields})
        self.entries = np.frombuffer(bytearray(function()), kind).copy()

    def material(self, entries: np.ndarray) -> tuple[int, np.ndarray]:
        """The status, and the material."""
        made = np.full(1, np.nan, self.law.dtype("material"))
        pointers = (ctypes.c_void_p(each.ctypes.data) for each in (entries, made))
        return self.law.function("material_of")(*pointers), made

    def random(self, draw: np.random.Generator) -> np.ndarray:
        """Entries far from the scene's; what is not given there stays absent in one of two."""
        rows = self.entries.copy()
        for name in rows.dtype.names or ():
            rows[name] *= 10 ** draw.uniform(-1, 1)
            if name.endswith(("restitution", "fraction", "poisson_ratio")):
                rows[name] = draw.uniform(0, 0.5)
            elif name.endswith("contact_angle"):
                rows[name] = draw.uniform(0, math.pi / 2)
            elif rows[name] > 1e50:
                rows[name] = 10 ** draw.uniform(6, 11) if draw.random() < 0.5 else self.entries[name]
        return rows

    def scene_of(self, entries: np.ndarray) -> Scene:
        """The scene with these entries."""
        given = {name.replace("_", ".", 1): float(entries[name][0]) for name in entries.dtype.names or ()}
        sizes = ("reduced_radius", "radius", "diameter", "reduced_mass", "mass", "density")
        kept = {name: value for name, value in self.scene.given if name.partition(".")[0] != "impact"}
        kept = {name: value for name, value in kept.items() if name.partition(".")[2] not in sizes}
        if given.get("particles.youngs_modulus", 0) > 1e50:  # no such criterion
            del given["particles.youngs_modulus"], given["particles.poisson_ratio"]
            kept = {name: value for name, value in kept.items() if name not in _ELASTIC}
        if given["liquid.glass_transition_pressure"] > 1e50:
            del given["liquid.glass_transition_pressure"]
        if self.scene.ways.volume == "absolute":
            given["bridge.volume"] = f"{given['bridge.volume']!r} m^3"  # type: ignore[assignment]
        return Scene("", tuple((kept | given).items()), package=self.scene.package)


_ELASTIC = ("particles.youngs_modulus", "particles.poisson_ratio")


@pytest.fixture(scope="module")
def own(law: Law) -> Pairs:
    """Of the law that all tests share."""
    return Pairs(SPHERES, law)


def test_materials_are_those_of_a_scene(own: Pairs):
    """By coatings, of unequal spheres."""
    check(own, 15, 2)


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_materials_are_those_of_scenes(name: str, tmp_path: Path):
    """By a number, a volume and a part of coatings, beside a wall and on strings."""
    check(Pairs(SCENES[name], Law(SCENES[name], law_alone(SCENES[name], tmp_path), *QUICK.split())), 40, 0)


def check(own: Pairs, count: int, collided: int):
    """Of random entries, to rounding; what a scene refuses is refused, and collisions are those of the scene."""
    draw = np.random.default_rng(1)
    status, material = own.material(own.entries)
    assert status == 0
    for member in material.dtype.names or ():
        assert material[member] == pytest.approx(own.law.material()[member], rel=1e-14), member
    sound = 0
    for _ in range(count):
        entries = own.random(draw)
        status, material = own.material(entries)
        try:
            scene = own.scene_of(entries)
        except InputError:
            assert status != 0
            continue
        assert status == 0, own.law.message(status)
        for member in set(material.dtype.names or ()) & scene.material.keys():
            assert material[member] == pytest.approx(scene.material[member], rel=1e-14), member
        if sound < collided:
            speed = 10 ** np.linspace(-2, 1, 12) / scene.stokes_per_speed
            expected = collide_many(scene, speed=speed, angle=0.7, of=("outcome", "restitution"))
            found = own.law.collide(own.law.impacts(speed=speed, angle=0.7), material=material)
            answered = (expected.outcome.values >= 0) & (found["status"] == 0)
            assert np.count_nonzero(answered) >= 10
            assert np.array_equal(found["outcome"][answered], expected.outcome.values[answered])
            np.testing.assert_allclose(found["restitution"][answered], expected.restitution.values[answered], rtol=1e-6)
        sound += 1
    assert sound >= count // 4


def test_bad_entries_are_named(own: Pairs):
    """Each has a status whose message begins with its name; the material is then zero, and the law refuses it."""
    for name in own.entries.dtype.names or ():
        for bad in (math.nan, math.inf, -1.5, 1e308):
            entries = own.entries.copy()
            entries[name] = bad
            status, material = own.material(entries)
            assert status == own.law.number(f"BAD_{name.upper()}")
            assert own.law.message(status).startswith(f"{name} must be ")
            assert not any(material[member][0] for member in material.dtype.names or ())
            assert own.law.one(own.law.impacts(speed=1.0), material=material)["status"][0] >= 200
    dry = own.entries.copy()
    dry["liquid_coating_thickness"] = dry["partner_coating_thickness"] = 0.0
    assert own.material(dry)[0] == own.law.number("BAD_FILM_THICKNESS")
    small = own.entries.copy()
    small["partner_radius"] *= 1e-5
    assert own.material(small)[0] == own.law.number("BAD_RADIUS_RATIO")


def test_the_pages_mixture_compiles_and_runs(law: Law, folder: Path):
    """All pairs of three kinds of beads but the dry ones collide; of these the film is named."""
    [program] = [text for text in re.findall(r"```c\n(.*?)```", PAGE.read_text(), re.DOTALL) if "int main" in text]
    (folder / "mixture.c").write_text(program)
    library = next(path.name for path in folder.glob("*.so"))
    command = f"gcc -std=c99 -pedantic -Wall -Wextra -Werror -o mixture mixture.c {library} -Wl,-rpath,{folder} -lm"
    subprocess.run(command.split(), cwd=folder, check=True)
    said = subprocess.run(["./mixture"], cwd=folder, capture_output=True, text=True, check=True).stdout.splitlines()
    assert [" outcome " in line for line in said] == [True] * 5 + [False]
    assert said[-1] == "2 and 2: film_thickness must be > 0, m"
