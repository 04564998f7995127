"""Hold the atlas of random scenes against collisions at random points of its plane.

    python -m tests.benchmarks.atlas_random [SCENES] [POINTS] [SEED] [FOLDER]

SCENES (20) scenes, entries scaled over two decades about the presets, all laws, films, partners and attractions; half
of the planes are of the angle, the others of an entry. POINTS (4000) collisions each, none nearer to a curve than is
stated that its chords are. With FOLDER every picture is drawn there. The last line is a summary; status 1 where a
collision disagrees with its region, or a place is not settled.
"""

# ruff: noqa: T201 -- a script that prints
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from wetdoublet.solvers import InputError, Scene
from wetdoublet.solvers.boundaries.arcs import CHORD, Arc
from wetdoublet.solvers.boundaries.boundary import Atlas, atlas
from wetdoublet.solvers.boundaries.plane import ANGLE, check_plane
from wetdoublet.solvers.boundaries.regions import apart
from wetdoublet.solvers.scene.schema import BRIDGE_LAWS, FILM_LAWS

SCALED = (
    "particles.reduced_radius", "particles.reduced_mass", "particles.roughness", "particles.youngs_modulus",
    "liquid.viscosity", "liquid.film_thickness", "liquid.glass_transition_pressure", "bridge.surface_tension",
    "bridge.volume", "pendulum.length",
)  # fmt: skip
ACROSS = (
    "liquid.viscosity", "particles.roughness", "liquid.glass_transition_pressure", "particles.dry_restitution",
    "bridge.volume", "pendulum.length", "liquid.film_thickness",
)  # fmt: skip
Plane = tuple[Scene, str, tuple[float, float]]


def planes(seed: int) -> Iterator[Plane]:
    """Random scenes, each with an entry across and its span."""
    random = np.random.default_rng(seed)
    while True:
        try:
            scene = _scene(random)
            over, span = _across(random, scene)
            check_plane(scene, over, span, (1e-4, 100.0), 1e-9)
        except InputError:
            continue
        yield scene, over, span


def _scene(random: np.random.Generator) -> Scene:
    base = Scene.load(str(random.choice(["granulation", "pendulum", "granulation-dry-bridge"])))
    tables = base.to_dict()
    entries = {name: float(base.entries[name]) for name in SCALED if name in base.entries}
    changes: dict[str, float | str] = {
        name: value * 10 ** random.uniform(-1, 1) for name, value in entries.items() if random.random() < 0.7
    }
    changes["particles.dry_restitution"] = float(random.uniform(0.2, 1.0))
    changes |= {
        "model.tangential": str(random.choice(["immersed", "film"])),
        "model.glass": str(random.choice(["literal", "film-corrected"])),
        "model.film": str(random.choice(["finite", "finite", *FILM_LAWS])),
    }
    if "bridge" in tables:
        changes |= {
            "bridge.law": str(random.choice(BRIDGE_LAWS)),
            "bridge.contact_angle": float(random.uniform(0, 0.8)),
        }
    scene = base.with_entries(changes)
    kind = random.random()
    if kind < 0.1:
        tables = scene.to_dict() | {"partner": {"wall": True}}
        scene = Scene.from_dict(tables)
    elif kind < 0.25 and "pendulum" not in tables:
        radius, density = 2 * scene.reduced_radius, 2500.0
        own = {"radius": radius, "density": density}
        particles = {
            k: v for k, v in scene.to_dict()["particles"].items() if k not in ("reduced_radius", "reduced_mass")
        }
        partner = {
            "radius": radius * 10 ** random.uniform(-0.7, 0.7),
            "density": density * 10 ** random.uniform(-0.5, 0.5),
        }
        scene = Scene.from_dict(scene.to_dict() | {"particles": particles | own, "partner": partner})
    if random.random() < 0.2 and "pendulum" not in tables:
        scene = Scene.from_dict(scene.to_dict() | {"attraction": {"hamaker": 10 ** random.uniform(-21, -18)}})
    return scene.with_entries({"impact.angle": float(random.uniform(0.2, 1.4))})


def _across(random: np.random.Generator, scene: Scene) -> tuple[str, tuple[float, float]]:
    if random.random() < 0.5:
        return ANGLE, (float(random.choice([0.0, 0.2])), float(random.uniform(1.0, 1.5)))
    name = str(random.choice([name for name in ACROSS if name in scene.entries]))
    value = float(scene.entries[name])
    if name == "particles.dry_restitution":
        return name, (0.05, 1.0)
    return name, (value / random.uniform(2, 5), value * random.uniform(2, 5))


def disagreements(found: Atlas, points: int, seed: int) -> tuple[int, list[tuple[float, float, int, int]]]:
    """How many random collisions could be compared, and those that do not lie in a region of their outcome."""
    assert found.scene is not None
    plane = check_plane(found.scene, found.over, found.span, found.window, 1e-9)
    at = np.random.default_rng(seed).random((points, 2))
    outcomes = plane.labels(at)
    x, stokes = plane.x(at), plane.stokes_at(at)
    says = found.region(x, stokes)
    differ = np.flatnonzero((says != outcomes) & (outcomes >= 0))
    arcs = [Arc(found.unit(one.x, one.stokes), 0, 0) for one in found.curves]
    differ = differ[apart(arcs, at[differ]) > 2 * CHORD]
    wrong = [(float(x[k]), float(stokes[k]), int(outcomes[k]), int(says[k])) for k in differ]
    return int(np.count_nonzero(outcomes >= 0)), wrong


def main(scenes: int = 20, points: int = 4000, seed: int = 1, folder: Path | None = None) -> int:
    """Print a line for each scene, and a summary."""
    compared = bad = unsettled = 0
    start = time.perf_counter()
    drawn = planes(seed)
    for k in range(scenes):
        scene, over, span = next(drawn)
        begun, cpu = time.perf_counter(), time.process_time()
        found = atlas(scene, over=over, span=span)
        took, cpu = time.perf_counter() - begun, time.process_time() - cpu
        count, wrong = disagreements(found, points, seed + k)
        compared, bad, unsettled = compared + count, bad + len(wrong), unsettled + len(found.unsettled)
        kinds = ", ".join(one.kind for one in found.points)
        print(f"{k} {over}: {len(found.curves)} curves, {took:.1f} s ({cpu:.1f} s CPU), {count} compared, "
              f"{len(wrong)} wrong, {len(found.unsettled)} unsettled; {kinds}", flush=True)  # fmt: skip
        for one in wrong[:3]:
            print("    wrong:", one)
        for place in found.unsettled[:3]:
            print("    unsettled:", place)
        if folder is not None:
            (folder / f"{k}.toml").write_text(scene.to_toml())
            found.plot(folder / f"{k}.png")
    print(f"{scenes} planes, {compared} collisions compared, {bad} wrong, {unsettled} places unsettled, "
          f"{time.perf_counter() - start:.0f} s")  # fmt: skip
    return int(bad + unsettled > 0)


if __name__ == "__main__":
    numbers = [int(text) for text in sys.argv[1:4]]
    sys.exit(main(*numbers, folder=Path(sys.argv[4])) if len(sys.argv) > 4 else main(*numbers))
