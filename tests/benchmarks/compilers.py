"""Random pairs in space by one exported law, compiled in several ways: sticks, outcomes and restitutions compared.

    python -m tests.benchmarks.compilers [PAIRS]

Prints a table for each scene, every way beside the first. A stick is compared by all that is returned of it. Status 1
where a stick differs by more than 1e-6 of the pair's size, speed or spin, or where an outcome differs though the impact
lies further than 1e-6 from a change of outcome.
"""

# ruff: noqa: T201 -- a script that prints
from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
from wetdoublet.solvers import Scene
from wetdoublet.solvers.export.law.texts import law_name

from ..helpers.exported_law import FOUND, Law, written
from ..solvers.export.test_law_in_space import OWN, arrivals

PAIRS, BESIDE, STICK = 10_000, 1e-6, 0
LENGTHS, SPEEDS, RATES = ("position", "normal"), ("velocities", "centre_velocity"), ("spins", "angular_velocity")
SCENES = {
    "granulation": Scene.load("granulation"),
    "unequal spheres": OWN,
    "lactose, thick film": Scene.load("lactose-pvp").with_entries(
        {"particles.dry_restitution": 0.6, "liquid.viscosity": 0.2}
    ),
}


def builds(scene: Scene, folder: Path) -> dict[str, Law]:
    """The law, compiled with and without optimisation, for one lane and several."""
    upper = law_name(scene).upper()
    written(scene, folder)
    lanes = {many: f"-D{upper}_LANES={many}" for many in (1, 2, 4)}
    ways = {"gcc -O0, 1 lane": ("gcc", ("-O0", lanes[1])), "gcc -O3 -march=native": ("gcc", ("-O3", "-march=native"))}
    ways |= {f"gcc -O2 -mavx2, LANES={many}": ("gcc", ("-O2", "-mavx2", flag)) for many, flag in lanes.items()}
    if "clang" in FOUND:
        ways |= {"clang -O2 -march=native": ("clang", ("-O2", "-march=native"))}
        ways |= {"clang -O3, 1 lane": ("clang", ("-O3", lanes[1]))}
    return {name: Law(scene, folder, *flags, compiler=compiler) for name, (compiler, flags) in ways.items()}


def beside_a_change(law: Law, rows: np.ndarray) -> np.ndarray:
    """Whether outcomes change within a small part of the speeds."""
    outcomes = []
    for factor in (1 - BESIDE, 1.0, 1 + BESIDE):
        moved = rows.copy()
        moved["velocities"] *= factor
        moved["spins"] *= factor
        outcomes.append(law.collide_pairs(moved)["outcome"])
    return np.ptp(outcomes, axis=0) > 0


def scales(scene: Scene, rows: np.ndarray) -> list[tuple[tuple[str, ...], np.ndarray]]:
    """What is returned of a stick, and the size of each kind in each pair."""
    speed = np.abs(rows["velocities"]).reshape(rows.size, -1).max(axis=1)
    spin = np.abs(rows["spins"]).reshape(rows.size, -1).max(axis=1)
    radius = float(scene.material["reduced_radius"])
    return [(LENGTHS, np.full(rows.size, radius)), (SPEEDS, speed), (RATES, speed / radius + spin)]


def compared(name: str, scene: Scene, pairs: int, folder: Path) -> bool:
    """Print the table of a scene; whether all agree."""
    made = builds(scene, folder)
    (first, reference), *others = made.items()
    rows = reference.pairs(*arrivals(scene, pairs, seed=11))
    expected, agree = reference.collide_pairs(rows), True
    stuck = (expected["status"] == 0) & (expected["outcome"] == STICK)
    print(f"{name}, beside {first}: {pairs} pairs, {np.count_nonzero(stuck)} sticks")
    for way, law in others:
        found = law.collide_pairs(rows)
        both = (found["status"] == 0) & (expected["status"] == 0)
        differ = both & (found["outcome"] != expected["outcome"])
        near = beside_a_change(reference, rows[differ])
        sticks = stuck & both & ~differ
        largest = max(
            float(np.max(np.abs(found[each] - expected[each])[sticks].reshape(sticks.sum(), -1).max(axis=1) / size))
            for names, size in scales(scene, rows[sticks])
            for each in names
        )
        parted = both & ~differ & (expected["outcome"] != STICK)
        e, e0 = found["restitution"][parted], expected["restitution"][parted]
        print(
            f"  {way}: sticks {largest:.1e}; {len(near)} other outcomes, {np.count_nonzero(near)} of them beside a"
            f" change; e_n {np.quantile(np.abs(e - e0), 0.999):.1e} (99.9 %);"
            f" {np.count_nonzero(found['status'] != expected['status'])} other statuses"
        )
        agree &= largest <= 1e-6 and bool(near.all())
    return agree


def main() -> int:
    """Compare all scenes."""
    pairs = int(sys.argv[1]) if len(sys.argv) > 1 else PAIRS
    with tempfile.TemporaryDirectory() as folder:
        agree = [compared(name, scene, pairs, Path(folder) / name) for name, scene in SCENES.items()]
    return 0 if all(agree) else 1


if __name__ == "__main__":
    sys.exit(main())
