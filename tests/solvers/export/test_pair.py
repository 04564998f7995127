"""Materials of pairs in C: those of scenes with the same entries, whatever the sizes; bad entries are named."""

import ctypes
import math
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, collide_many
from wetdoublet.solvers.scene.schema import BRIDGE_LAWS

from ...helpers.exported_law import FOUND, SANITIZED, Law, written

pytestmark = pytest.mark.skipif("gcc" not in FOUND, reason="needs gcc and g++")
PAGE = Path(__file__).parents[3] / "docs" / "how-to" / "c-law.md"
GRANULATION, BEADS, PENDULUM = (Scene.load(name) for name in ("granulation", "glass-beads-water", "pendulum"))
RUBS = {"particles.friction": 0.3, "particles.contact_tangential_restitution": 0.4, "model.contact_friction": "all"}
WALL = {"partner.wall": True}
SCENES = {
    "by number": GRANULATION,
    "by volume": GRANULATION.with_entries({"bridge.volume": "2e-14 m^3", "model.film": "constant-volume"}),
    "by coating": BEADS,
    "by a part": BEADS.with_entries({"bridge.coating_fraction": 0.2, "model.film": "cavitating", **RUBS}),
    "unequal": GRANULATION.with_entries({"partner.diameter": "320 um", "partner.mass": "2e-8 kg", **RUBS}),
    "attraction": Scene.load("granulation-dry-bridge").with_entries({"attraction.hamaker": 1e-19}),
    "wall": BEADS.with_entries({**WALL, "partner.coating_thickness": "1 um"}),
    "strings": PENDULUM,
    **{f"bridge {law}": GRANULATION.with_entries({"bridge.law": law}) for law in BRIDGE_LAWS},
}
FEW = ("by coating", "unequal", "wall")
HOSTILE = (math.nan, math.inf, -math.inf, -1.0, 0.0, 1e308, -1e308, 5e-324)


class Pairs:
    """The materials of pairs by the exported law in a folder."""

    def __init__(self, scene: Scene, folder: Path, *flags: str) -> None:
        self.folder = written(scene, folder)
        self.scene, self.law = scene, Law(scene, self.folder, *flags)
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
def made(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Pairs]:
    """Laws that are exported already."""
    return {}


def pairs(name: str, made: dict[str, Pairs], folder: Path) -> Pairs:
    if name not in made:
        made[name] = Pairs(SCENES[name], folder, "-O0")
    return made[name]


@pytest.mark.parametrize(
    "name", [name if name in FEW else pytest.param(name, marks=pytest.mark.slow) for name in SCENES]
)
@pytest.mark.slow
def test_materials_are_those_of_scenes(name: str, made: dict[str, Pairs], tmp_path: Path):
    """Of random entries, to rounding; what a scene refuses is refused, and collisions are those of the scene."""
    own, draw = pairs(name, made, tmp_path / "law"), np.random.default_rng(len(name))
    status, material = own.material(own.entries)
    assert status == 0
    for member in material.dtype.names or ():
        assert material[member] == pytest.approx(own.law.material()[member], rel=1e-14), member
    sound = 0
    for _ in range(40):
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
        if sound < 3:
            speed = 10 ** np.linspace(-2, 1, 12) / scene.stokes_per_speed
            expected = collide_many(scene, speed=speed, angle=0.7, of=("outcome", "restitution"))
            found = own.law.collide(own.law.impacts(speed=speed, angle=0.7), material=material)
            answered = (expected.outcome.values >= 0) & (found["status"] == 0)
            assert np.count_nonzero(answered) >= 10
            assert np.array_equal(found["outcome"][answered], expected.outcome.values[answered])
            np.testing.assert_allclose(found["restitution"][answered], expected.restitution.values[answered], rtol=1e-6)
        sound += 1
    assert sound >= 10


def test_bad_entries_are_named(made: dict[str, Pairs], tmp_path: Path):
    """Each has a status whose message begins with its name; the material is then zero, and the law refuses it."""
    own = pairs("by coating", made, tmp_path / "law")
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


def test_sizes_that_a_structure_has_not_cannot_be_given(made: dict[str, Pairs], tmp_path: Path):
    """Spheres on strings are equal, and a wall has no size: there are no such members."""
    header = pairs("wall", made, tmp_path / "law").law.header
    assert "double partner_coating_thickness" in header
    assert "double partner_radius" not in header


def test_the_pages_mixture_compiles_and_runs(made: dict[str, Pairs], tmp_path: Path):
    """All pairs of three kinds of beads but the dry ones collide; of these the film is named."""
    pairs("by coating", made, tmp_path / "law")
    folder = made["by coating"].folder
    [program] = [text for text in re.findall(r"```c\n(.*?)```", PAGE.read_text(), re.DOTALL) if "int main" in text]
    (folder / "mixture.c").write_text(program)
    command = "gcc -std=c99 -pedantic -Wall -Wextra -Werror -o mixture mixture.c glass_beads_water.c -lm"
    subprocess.run(command.split(), cwd=folder, check=True)
    said = subprocess.run(["./mixture"], cwd=folder, capture_output=True, text=True, check=True).stdout.splitlines()
    assert [" outcome " in line for line in said] == [True] * 5 + [False]
    assert said[-1] == "2 and 2: film_thickness must be > 0, m"


@pytest.mark.slow
def test_hostile_entries_under_the_sanitizers(tmp_path: Path):
    """Two bad numbers at a time: a status or a material of numbers, nothing undefined, and no warning of any kind."""
    for name in (*FEW, "strings", "attraction"):
        folder = written(SCENES[name], tmp_path / name.replace(" ", "-"))
        law = next(path.stem for path in folder.glob("*.f90") if path.stem != "example")
        numbers = ", ".join(
            "NAN" if math.isnan(x) else f"{'-' if x < 0 else ''}INFINITY" if math.isinf(x) else repr(x) for x in HOSTILE
        )
        (folder / "hostile.c").write_text(
            HOSTILE_C.replace("law_", f"{law}_").replace("NAME", law).replace("VALUES", numbers)
        )
        warned = ["-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]
        for compiler in (["gcc", "-std=c99"], ["g++", "-x", "c++", "-std=c++20"], ["gcc", "-std=c99", "-march=native"]):
            subprocess.run(
                [*compiler, *warned, "-fsyntax-only", f"{law}.c", "hostile.c", "check.c"], cwd=folder, check=True
            )
        built = subprocess.run(
            ["gcc", "-std=c99", *SANITIZED["gcc"], "-o", "hostile", "hostile.c", f"{law}.c", "-lm"],
            cwd=folder,
            check=False,
            capture_output=True,
            text=True,
        )
        if "cannot find" in built.stderr:
            pytest.skip("gcc has no sanitizers here")
        assert built.returncode == 0, built.stderr
        done = subprocess.run(["./hostile"], cwd=folder, capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, ""), done.stderr[:2000]
        assert re.fullmatch(r"0 wrong of \d+\n", done.stdout), done.stdout


HOSTILE_C = """\
#include "NAME.h"
#include <math.h>
#include <stdio.h>

int main(void)
{
    static const double BAD[] = {VALUES};
    enum { MEMBERS = sizeof(law_pair_entries)/sizeof(double), COUNT = sizeof BAD/sizeof *BAD };
    int wrong = 0, tried = 0;
    union { law_pair_entries entries; double numbers[MEMBERS]; } pair;
    union { law_material material; double numbers[sizeof(law_material)/sizeof(double)]; } made;
    for (int i = 0; i < MEMBERS; i++)
        for (int j = 0; j <= i; j++)
            for (int k = 0; k < COUNT*COUNT; k++) {
                pair.entries = law_default_pair_entries();
                pair.numbers[i] = BAD[k/COUNT];
                pair.numbers[j] = BAD[k%COUNT];
                int status = law_material_of(&pair.entries, &made.material);
                double sum = 0.0;
                for (unsigned n = 0; n < sizeof made/sizeof(double); n++)
                    sum += fabs(made.numbers[n]);
                wrong += !(sum < INFINITY) || (status != 0) != (sum == 0.0);
                tried++;
            }
    printf("%d wrong of %d\\n", wrong, tried);
    return 0;
}
"""
