"""Collision averages of a matrix of radii: time, estimated errors, and errors against a finer quadrature of a sample.

`python -m tests.benchmarks.averages [--size 64] [--wrt NAME,...] [--sample 24]`
"""

# ruff: noqa: T201 -- a script that prints
from __future__ import annotations

import argparse
import os
import sys
import time

import numpy as np
from wetdoublet.solvers import Scene, collision_averages
from wetdoublet.solvers.averages.dataset import QUANTITIES
from wetdoublet.solvers.averages.over_speeds import means
from wetdoublet.solvers.averages.sizes import FIXED, experiment_of, scene_of_sizes
from wetdoublet.solvers.averages.speeds import Speeds

SCENE, SPEEDS, RADII = "granulation", "maxwell:0.5 m/s", (30e-6, 300e-6)
FINER = 30.0  # times the tolerance of the quadrature, and of the collisions
ALL = QUANTITIES[:5]  # those to which the tolerance applies


def main() -> None:
    """Compute the matrix, then a sample of its pairs with smaller tolerances."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--size", type=int, default=64)
    parser.add_argument("--wrt", default="")
    parser.add_argument("--sample", type=int, default=24)
    given = parser.parse_args()
    radii = np.geomspace(*RADII, given.size)
    wrt = [name for name in given.wrt.split(",") if name]
    collision_averages(SCENE, speeds="1 m/s", radii=radii[:2], wrt=wrt, tolerance=1e-2)  # compiles the kernels
    wall, cpu = time.perf_counter(), _cpu()
    found = collision_averages(SCENE, speeds=SPEEDS, radii=radii, wrt=wrt, progress=_tell)
    wall, cpu = time.perf_counter() - wall, _cpu() - cpu
    pairs = given.size * (given.size + 1) // 2  # entries of one sphere alone need the others too
    load = os.getloadavg()[0]
    print(f"\n{given.size} x {given.size} radii: {wall:.0f} s, {cpu:.0f} s of CPU, load {load:.1f}")
    print(f"{1e3 * cpu / pairs:.0f} ms of CPU for each of {pairs} pairs")
    print(f"failed: {int((found.reason != '').sum())}; largest error estimates:")
    for name in QUANTITIES:
        print(f"  {name:34} {float(found[f'{name}_error'].max()):.1e}")
    _compare(found, radii, given.sample)


def _cpu() -> float:
    """CPU time of this process and its workers that have ended, s."""
    return sum(os.times()[:4])


def _compare(found, radii: np.ndarray, sample: int) -> None:
    """Print the largest differences from a finer quadrature of random pairs."""
    chosen = np.random.default_rng(1).integers(0, radii.size, (sample, 2))
    scene = Scene.load(SCENE)
    scenes = [scene_of_sizes(scene, float(radii[i]), float(radii[j]), FIXED) for i, j in chosen]
    experiment = experiment_of(scenes, (), 1e-9 / FINER)
    finer = means(experiment, sample, Speeds.of(SPEEDS), 1e-6 / FINER).mean
    print(f"largest differences of {sample} pairs from tolerances {FINER:g} times smaller:")
    for k, name in enumerate(ALL):
        values = found[name].values[chosen[:, 0], chosen[:, 1]]
        print(f"  {name:34} {np.abs(values - finer[:, k]).max():.1e}")


def _tell(done: int, total: int) -> None:
    sys.stderr.write(f"\r{done} of {total} pairs")


if __name__ == "__main__":
    main()
