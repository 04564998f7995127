"""One exported law, compiled once, which has all that a law may have: unequal spheres, coatings, a bridge, spins."""

from pathlib import Path

import pytest
from wetdoublet.solvers import Scene

from ...helpers.exported_law import FOUND, Law, law_alone, written
from ...helpers.flags import QUICK

SPHERES = Scene.load("glass-beads-water").with_entries(
    {
        "particles.dry_restitution": 0.8, "partner.diameter": "0.6 mm", "partner.mass": "2e-7 kg",
        "partner.coating_thickness": "3 um", "liquid.viscosity": "20 mPa s",
    }
)  # fmt: skip
WALL = Scene.load("granulation").with_entries({"partner.wall": True})
OWN = Scene.load("granulation").with_entries(  # equal masses, which is far from the presets
    {
        "particles.reduced_radius": "0.2 mm", "particles.reduced_mass": "3e-5 g", "particles.dry_restitution": 0.8,
        "liquid.viscosity": 0.3, "partner.radius": "0.3 mm", "partner.mass": "3e-5 g", "bridge.volume": 0.02,
    }
)  # fmt: skip
STRICT = (*QUICK.split(), "-pedantic", "-Wall", "-Wextra", "-Werror")
STRICT += ("-Wconversion", "-Wdouble-promotion", "-Wshadow", "-Wundef")


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The exported folder."""
    if "gcc" not in FOUND:
        pytest.skip("needs gcc and g++")
    return written(SPHERES, tmp_path_factory.mktemp("law") / "spheres")


@pytest.fixture(scope="session")
def walled(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Law]:
    """The folder and the law of granulation beside a wall."""
    folder = law_alone(WALL, tmp_path_factory.mktemp("law") / "wall")
    return folder, Law(WALL, folder, *STRICT)


@pytest.fixture(scope="session")
def law(folder: Path) -> Law:
    """The law, as strict C99 without a warning, and without contraction of products and sums."""
    return Law(SPHERES, folder, *STRICT, "-march=native", "-ffp-contract=off")
