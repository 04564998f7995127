"""Sticks in space by rebounds and by tumbling, followed on without certificates: none may separate.

    python -m tests.benchmarks.sticks_in_space [STICKS] [SEED] [FURTHER]

STICKS (200) random sticks each that the certificate by rebounds proves (chatter above the barrier) and that the
tumbling rule calls without proof, from random pairs of random scenes. Rosenbrock follows each, without certificates, to
FURTHER (10) times its time. Prints what separates, and the counts; status 1 where anything does. What takes more steps
than an engine has is left out, and counted.
"""

# ruff: noqa: T201 -- a script that prints
import sys
import warnings
from collections import Counter
from collections.abc import Iterator

import numpy as np
from wetdoublet.solvers import Scene, collide_pair
from wetdoublet.solvers.certificates.in_space import ReboundCertificate
from wetdoublet.solvers.engines.casadi.locate import EventLocator
from wetdoublet.solvers.errors import WetDoubletError
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.space.by_casadi import groups_of, own_axes
from wetdoublet.solvers.space.pairs import Pairs, checked
from wetdoublet.solvers.verify.audit import WithoutCertificate

from ..helpers.random_in_space import direction

RTOL, ROUND, EXTRAS = 1e-8, 400, ("rotation",)
GRANULATION = Scene.load("granulation")
CHATTERING = Scene.from_dict(
    {
        "particles": {"radius": 1.704e-3, "mass": 1.191e-5, "roughness": 2.2e-8, "dry_restitution": 0.82},
        "liquid": {"viscosity": 0.0657, "film_thickness": 8.23e-6, "glass_transition_pressure": 1.7e8},
        "bridge": {"law": "mikami", "surface_tension": 0.149, "volume": 0.0676, "contact_angle": 0.18},
        "attraction": {"hamaker": 9e-12},
    }
)


def pairs_of(scene: Scene, draw: np.random.Generator, stokes: tuple[float, float], spinning: float) -> Pairs:
    """Random pairs of a scene with numbers about those given."""
    entries = dict(scene.si)
    changes = {
        name: float(entries[name]) * 2.0 ** draw.uniform(-1, 1)
        for name in ("liquid.viscosity", "bridge.surface_tension", "particles.roughness")
    }
    changes["particles.dry_restitution"] = draw.uniform(0.5, 0.95)
    other = scene.with_entries(changes)
    a = float(other.material["reduced_radius"])
    speed = 10 ** draw.uniform(*stokes, ROUND)[:, None] / other.stokes_per_speed
    normal = np.array([direction(draw) for _ in range(ROUND)])
    velocities = draw.normal(size=(ROUND, 2, 3)) * speed[:, None]
    opening = np.sum(normal * (velocities[:, 1] - velocities[:, 0]), axis=1, keepdims=True)
    velocities[:, 1] -= (opening + speed) * normal
    return checked(other, normal, velocities, spinning * draw.normal(size=(ROUND, 2, 3)) * (speed / a)[:, None])


def sticks(kind: str, seed: int) -> Iterator[Pairs]:
    """Single pairs that the kernel calls sticks: of tumbling those without proof, of chatter those not proved soon."""
    draw = np.random.default_rng(seed)
    while True:
        some = (
            pairs_of(GRANULATION, draw, (-2.5, -0.5), 2.0)
            if kind == "tumbling"
            else pairs_of(CHATTERING, draw, (0.0, 1.5), 0.3)
        )
        found = collide_pair(some.scene, some.normal, some.velocities, some.spins, rtol=RTOL, engine="taylor")
        stuck = (found.outcome.values == 0) & (found.until.values > 0)
        stuck &= found.certified.values == (kind != "tumbling")
        for k in np.flatnonzero(stuck):
            yield some.part(np.array([k]))


def followed(kind: str, pair: Pairs, further: float) -> str:
    """What becomes of a stick of this kind: "stays", "separates", "other" (of another kind), or "left out"."""
    model = load(select_model(pair.scene, True, space=True))
    groups = groups_of(pair, own_axes(pair)).groups
    finder = EventLocator(model, groups, RTOL, EXTRAS)
    try:
        path = finder.run()
    except WetDoubletError:
        return "left out"
    if path.outcome != "stick" or path.certified == (kind == "tumbling"):
        return "other"
    if kind != "tumbling":
        proof = finder.proof
        if not isinstance(proof, ReboundCertificate) or proof.beside.decided(path.y, finder.phase):
            return "other"
    try:
        on = WithoutCertificate(model, groups, RTOL, EXTRAS).on(path.time * further)
    except WetDoubletError:
        return "left out"
    return "separates" if on.separated else "stays"


def main(count: int = 200, seed: int = 25, further: float = 10.0) -> int:
    warnings.simplefilter("ignore")
    wrong = 0
    for kind in ("tumbling", "rebounds"):
        counts: Counter[str] = Counter()
        for pair in sticks(kind, seed):
            one = followed(kind, pair, further)
            counts[one] += 1
            if one == "separates":
                print(kind, pair.scene.to_toml(), pair.normal, pair.velocities, pair.spins, flush=True)
            if counts["stays"] + counts["separates"] + counts["left out"] >= count:
                break
        print(kind, dict(counts), flush=True)
        wrong += counts["separates"]
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main(*(int(each) for each in sys.argv[1:3]), *map(float, sys.argv[3:4])))
