"""Sample of the stress test: a quasi-random sample of all scenes, and points close to boundaries."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice, product
from typing import Any

import numpy as np
from scipy.stats import qmc

from ...boundaries.boundary import boundary
from ...errors import InputError
from ...host.emitted import LAWS
from ...scene.scene import Scene
from .verdict import Case

SEED = 20121
DISTANCES = tuple(10.0**-k for k in range(3, 13))  # relative distances in St of points beside a boundary
PER_CHANGE = 2 * len(DISTANCES)
_BESIDE = 0.15  # part of a sample that lies beside boundaries
_LINES = 0.05  # part of a sample whose boundaries are traced
_PER_LINE_MODEL = 400  # sample size per model of traced scenes, each of which compiles kernels of its own
_ANGLES = 3  # lines of a traced scene
_PER_MODEL, _MODELS = 36, (8, 120)  # scenes per structure and laws; fewest and most such models
NUMBERS = 26  # dimensions of a point
_CHOICES = 11  # dimensions of a model
_FASTEST = 5.0  # surface speed of a spin, over v0
_WIDE = {  # lowest and highest value, SI
    "reduced_radius": (1e-6, 1e-2), "film/reduced_radius": (1e-5, 1.0), "density": (300.0, 2e4),
    "roughness/film": (1e-6, 0.9), "viscosity": (1e-5, 1e4), "glass_transition_pressure": (1e3, 1e12),
    "youngs_modulus": (1e5, 1e12), "surface_tension": (1e-4, 1.0), "volume": (1e-5, 1.0), "length": (1.01, 1e4),
    "gravity": (0.1, 100.0), "stokes": (1e-6, 1e4), "degrees from grazing": (0.01, 90.0),
}  # fmt: skip
_MODERATE = _WIDE | {  # what an independent integrator follows in a second
    "reduced_radius": (5e-6, 5e-3), "film/reduced_radius": (1e-3, 0.2), "density": (300.0, 8e3),
    "roughness/film": (1e-4, 0.5), "viscosity": (1e-3, 10.0), "stokes": (1e-2, 30.0),
    "degrees from grazing": (5.0, 90.0),
}  # fmt: skip


def sample(count: int, seed: int = SEED) -> list[Case]:
    """`count` cases, deterministic for a count and seed."""
    beside, traced = max(1, int(_BESIDE * count)) if count else 0, int(_LINES * count)
    cases = [*_lines(traced, count // _PER_LINE_MODEL, seed + 2), *islice(_beside_boundaries(beside), beside)]
    cases += _drawn(count - beside - traced, seed)
    return [*cases, *islice(_drawn(count, seed + 1), count - len(cases))]  # fill up if there are too few boundaries


def _lines(count: int, models: int, seed: int) -> Iterator[Case]:
    """Scenes with the angles of lines along which their boundaries are traced, some head-on."""
    random = np.random.default_rng(seed)
    for case in _drawn(count, seed, max(1, models), moderate=True):
        steepest = random.choice([0.0, 1.5, 1.55], _ANGLES)
        yield replace(case, kind="lines", angles=tuple((steepest * random.random(_ANGLES)).tolist()))


def _drawn(count: int, seed: int, kinds: int | None = None, moderate: bool = False) -> Iterator[Case]:
    """Valid scenes along a Halton sequence; invalid ones are skipped.

    Arguments:
        kinds: number of models; None for what the count is worth.
        moderate: as for `scene_of`.
    """
    drawn = list(models(kinds or min(max(count // _PER_MODEL, _MODELS[0]), _MODELS[1]), seed))
    points, taken = qmc.Halton(NUMBERS, seed=seed), 0
    while taken < count:
        for point in points.random(64):
            try:
                scene = scene_of(f"stress-{seed}-{taken}", drawn[taken % len(drawn)], point, moderate)
            except InputError:
                continue  # an impossible scene, such as a film thicker than its bridge
            yield Case(scene.name, scene)
            taken += 1
            if taken == count:
                return


Model = dict[str, str]


def models(count: int, seed: int) -> Iterator[Model]:
    """Combinations of structure and laws, few enough that several scenes share what an engine builds."""
    bridges, hung, shears, glasses = (tuple(LAWS[slot]) for slot in ("bridge", "strings", "shear", "glass"))
    for k, point in enumerate(qmc.Halton(_CHOICES, seed=seed + 1).random(count)):
        bridge = "" if point[0] < 0.25 else bridges[int((point[0] - 0.25) / 0.75 * len(bridges))]
        films = [law for law, features in LAWS["film"].items() if bridge or "spread" not in features]
        film = films[0] if point[5] < 0.55 else films[1 + int((point[5] - 0.55) / 0.45 * (len(films) - 1))]
        rim = "spread" not in LAWS["film"][film]
        strings = "" if point[1] < 0.75 else hung[int(point[1] >= 0.9)]
        yield {
            "bridge": bridge,
            "strings": strings,
            "partner": "" if strings or point[6] < 0.45 else "sphere" if point[6] < 0.8 else "wall",
            "spins": "" if strings or point[7] < 0.4 else "one" if point[7] < 0.55 else "both",
            "friction": "" if point[8] < 0.5 else "solid" if point[8] < 0.8 else "all",
            "attraction": "yes" if point[9] < 0.25 else "",
            "film": film,
            "tangential": shears[int(point[3] >= 0.7 and rim)],
            "glass": glasses[int(point[4] >= 0.7 and rim)],
            "rupture": "own" if "rupture_distance" in LAWS["bridge"].get(bridge, ()) and point[10] < 0.2 else "common",
            "head-on": "yes" if k % 8 == 3 else "",
        }


def scene_of(name: str, model: Model, point: Sequence[float], moderate: bool = False) -> Scene:
    """The scene of a model and a point in the unit cube of NUMBERS dimensions.

    Arguments:
        moderate: groups that an independent integrator follows in a second, in place of all that a double holds.

    Raises:
        InputError: its entries contradict each other.
    """
    at, ranges = iter(point), _MODERATE if moderate else _WIDE

    def within(name: str) -> float:
        return log(*ranges[name])

    def log(low: float, high: float) -> float:
        return float(low * (high / low) ** next(at))

    def even(low: float, high: float) -> float:
        return float(low + (high - low) * next(at))

    a = within("reduced_radius")
    film = a * within("film/reduced_radius")
    entries: dict[str, Any] = {
        "particles.reduced_radius": a,
        "particles.density": within("density"),
        "particles.roughness": film * within("roughness/film"),
        "particles.dry_restitution": _ends(even(-0.05, 1.05)),
        "liquid.viscosity": within("viscosity"),
        "liquid.film_thickness": film,
        "liquid.glass_transition_pressure": within("glass_transition_pressure"),
    }
    modulus, ratio = within("youngs_modulus"), even(-0.2, 0.5)
    if even(0, 1) < 0.7:
        entries |= {"particles.youngs_modulus": modulus, "particles.poisson_ratio": ratio}
    tension, volume, wetting = within("surface_tension"), within("volume"), math.pi / 2 * _ends(even(-0.2, 1.05))
    if model["bridge"]:
        entries |= {"bridge.surface_tension": tension, "bridge.volume": volume, "bridge.contact_angle": wetting}
        entries |= {"bridge.law": model["bridge"], "bridge.rupture": model["rupture"]}
    length, gravity = within("length"), within("gravity")
    if model["strings"]:
        reach = 2 * a * volume ** (1 / 3) * (1 + wetting / 2) if model["bridge"] else film
        entries |= {"pendulum.length": (4 * a + reach / 2) * length, "pendulum.gravity": gravity}
        entries["pendulum.law"] = model["strings"]
    entries |= {f"model.{name}": model[name] for name in ("film", "tangential", "glass")}
    entries["impact.stokes"] = within("stokes")
    steep, angle, close = even(0, 1) < 0.75, even(0.0, 1.0), within("degrees from grazing")
    degrees = 89.99 * angle if steep else 90.0 - close
    entries["impact.angle"] = 0.0 if model["head-on"] else math.radians(max(degrees, 0.0))
    radius, mass = log(0.1, 10.0), log(0.3, 3.0)
    if model["partner"] == "sphere":
        entries |= {"partner.radius": 2 * a * radius, "partner.density": entries["particles.density"] * mass}
    elif model["partner"]:
        entries["partner.wall"] = "true"
    friction, sticking = log(1e-2, 3.0), _ends(even(-0.3, 1.1))
    if model["friction"]:
        entries |= {"particles.friction": friction, "particles.contact_tangential_restitution": sticking}
        entries["model.contact_friction"] = model["friction"]
    spins, hamaker = (even(-1.0, 1.0), even(-1.0, 1.0)), log(1e-6, 1e-2)
    scene = Scene(name, _rounded(entries))
    speed, _ = scene.need_impact()
    moving = {"": (), "one": ("impact.spin",), "both": ("impact.spin", "impact.partner_spin")}[model["spins"]]
    for entry, share in zip(moving[: 1 if scene.wall else 2], spins):
        entries[entry] = _FASTEST * share**3 * speed / (2 * a)  # of any size
    if model["attraction"]:
        entries["attraction.hamaker"] = 36 * math.pi * entries["liquid.viscosity"] * a * speed * film * hamaker
    return Scene(name, _rounded(entries))


def _rounded(entries: dict[str, Any]) -> tuple[tuple[str, Any], ...]:
    """Entries as a scene keeps them, of a few digits."""
    return tuple(
        (entry, float(f"{value:.6g}") if isinstance(value, float) else value) for entry, value in entries.items()
    )


def _ends(share: float) -> float:
    """A number in 0 to 1, with a part of the draws at each end."""
    return min(max(share, 0.0), 1.0)


def _beside_boundaries(count: int) -> Iterator[Case]:
    """At least `count` points beside changes of outcome of the presets and some variants.

    They are traced at angles that fill the range.
    """
    variants: tuple[tuple[str, dict[str, Any]], ...] = (
        ("granulation", {}),
        ("pendulum", {}),
        ("granulation", {"bridge.law": "willett"}),
        ("granulation", {"bridge.law": "constant"}),
        ("granulation-dry-bridge", {}),
        ("pendulum", {"model.glass": "film-corrected", "pendulum.law": "small-angle"}),
        ("granulation", {"model.tangential": "film", "particles.dry_restitution": 0.5}),
    )
    changes, turn = 0, 0
    while changes < math.ceil(count / PER_CHANGE) and turn < 4 * count + 16:
        preset, entries = variants[turn % len(variants)]
        scene = Scene.load(preset).with_entries(entries)
        golden = (0.3 + 0.6180339887 * (turn // len(variants)) + 0.13 * (turn % len(variants))) % 1.0
        angle = math.radians(20.0 + 65.0 * golden)
        turn += 1
        for change in boundary(scene, angle=np.array([angle]), stokes=(1e-3, 20.0), rtol=1e-12).changes[0]:
            changes += 1
            label = f"{preset} at {math.degrees(angle):.4g} deg, {change.before} to {change.after}"
            for distance, (side, expected) in product(DISTANCES, ((-1, change.before), (1, change.after))):
                moved = scene.with_impact(angle=angle).with_impact(stokes=change.stokes * (1 + side * distance))
                yield Case(f"{label} {side * distance:+.0e}", moved, "beside", distance, expected, change.kind)
