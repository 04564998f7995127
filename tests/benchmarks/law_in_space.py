"""The exported law in space beside `collide_pair`, on random pairs of random scenes.

    python -m tests.benchmarks.law_in_space [COUNT] [SEED] [MODELS]

COUNT (3000) random pairs of MODELS (10) structures and laws, in scenes of random numbers: spheres equal and unequal,
walls, films, attractions, any directions, spins up to five times the approach speed at the surface. Each model is
exported and compiled once, and the numbers of a scene are put into its material. Both at rtol 1e-9. Prints, by model,
outcomes, how many differ, and the largest difference beside that which velocities larger by 1e-9 make; status 1 where a
sound pair has no answer, or an outcome or a number differs by more than ALLOWED times what these velocities make.
"""

# ruff: noqa: T201 -- a script that prints
from __future__ import annotations

import sys
import tempfile
import warnings
from collections import Counter
from itertools import groupby
from pathlib import Path

import numpy as np
from wetdoublet.solvers import Scene, collide_pair
from wetdoublet.solvers.scene.contact import NEVER_MET
from wetdoublet.solvers.scene.groups import si_values

from ..helpers.exported_law import Law, written
from ..helpers.random_in_space import arrivals, request
from ..helpers.random_spinning import models as drawn
from ..helpers.random_spinning import numbers, tables
from ..helpers.two_bodies import bodies_of

RTOL, STEP, ALLOWED = 1e-9, 1e-9, 1e4
OF_A_SCENE = 30
NAMES = ("restitution", "time", "velocities", "spins")
Found = dict[str, np.ndarray]


def scenes(count: int, seed: int, of: int) -> list[tuple[str, Scene]]:
    """Scenes with the name of their model, one model after another; the lever arm of spheres is at mid-gap."""
    every = [model for model in drawn(4 * of, seed) if model.partner == "wall" or model.arm == "midgap"][:of]
    found = []
    for k, model in enumerate(every):
        draw, many = np.random.default_rng((seed, 5, k)), max(1, count // len(every) // OF_A_SCENE)
        found += [(f"{k} {model}", Scene.from_dict(tables(model, numbers(model, draw)))) for _ in range(many)]
    return found


def asked(scene: Scene, draw: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Random pairs at speeds from a tenth to ten times the scene's."""
    bodies, speed = bodies_of(scene), scene.need_impact()[0]
    rows = [request(bodies, arrivals(bodies, speed * 10 ** draw.uniform(-1, 1), 1, draw)) for _ in range(OF_A_SCENE)]
    normal, velocities, spins = (np.concatenate([row[k] for row in rows]) for k in range(3))
    return normal, velocities, spins


def faster(given: tuple[np.ndarray, np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The same with all velocities a little larger."""
    normal, velocities, spins = given
    return normal, velocities * (1 + STEP), spins


def computed(law: Law, scene: Scene, given: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    """The law's answers with the numbers of a scene."""
    material, own = law.material(), {"poisson_ratio": 0.0, **NEVER_MET, **si_values(scene, None, None)}
    for name in material.dtype.names or ():
        material[name] = own[name]
    return law.collide_pairs(law.pairs(*given), RTOL, material)


def apart(one: Found, other: Found, given: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    """Largest relative difference of each pair's numbers."""
    _, velocities, spins = given
    size = len(velocities)
    scales = {"velocities": np.abs(velocities), "spins": np.abs(spins)}
    found = np.zeros(size)
    for name in NAMES:
        first, second = (np.nan_to_num(each[name].reshape(size, -1)) for each in (one, other))
        scale = np.abs(second).max(axis=1)
        if name in scales:
            scale = np.maximum(scale, scales[name].reshape(size, -1).max(axis=1))
        found = np.fmax(found, np.abs(first - second).max(axis=1) / np.where(scale > 0, scale, 1.0))
    return found


def main(count: int = 3000, seed: int = 17, of: int = 10) -> int:
    warnings.simplefilter("ignore")
    wrong = 0
    for name, group in groupby(scenes(count, seed, of), key=lambda each: each[0]):
        own, worst, outcomes, differ, without = [scene for _, scene in group], (0.0, 0.0), Counter[int](), 0, 0
        with tempfile.TemporaryDirectory() as folder:
            law = Law(own[0], written(own[0], Path(folder)), "-O2", "-march=native")
            for k, scene in enumerate(own):
                given = asked(scene, np.random.default_rng((seed, k)))
                mine = computed(law, scene, given)
                found = {each: mine[each] for each in ("outcome", *NAMES)}
                expected, moved = (
                    collide_pair(scene, *each, rtol=RTOL, engine="taylor") for each in (given, faster(given))
                )
                ours, other = ({each: data[each].values for each in found} for data in (expected, moved))
                sharp = (ours["outcome"] == other["outcome"]) & (ours["outcome"] >= 0)
                outcomes.update(mine["outcome"].tolist())
                without += np.count_nonzero(sharp & (mine["outcome"] < 0))
                both = sharp & (mine["outcome"] >= 0)
                differ += np.count_nonzero(both & (found["outcome"] != ours["outcome"]))
                off, by_speed = apart(found, ours, given), apart(other, ours, given)
                off[~both | (found["outcome"] != ours["outcome"])] = 0.0
                at = int(np.argmax(off))
                worst = max(worst, (float(off[at]), float(by_speed[at])))
                wrong += np.count_nonzero(off > ALLOWED * np.maximum(by_speed, STEP))
        print(f"{name}\n  {dict(outcomes)}: {differ} outcomes differ, {without} without an answer,", end=" ")
        print(f"largest difference {worst[0]:.1e} (by speed {worst[1]:.1e})", flush=True)
        wrong += differ + without
    print(f"{wrong} to be looked at")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main(*(int(each) for each in sys.argv[1:4])))
