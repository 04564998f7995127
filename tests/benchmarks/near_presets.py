"""Synthetic experiments near the presets, and their repetition with what was found written line by line."""

from __future__ import annotations

import argparse
import json
import sys
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
from wetdoublet.solvers import ComputationError, InputError, Scene, collide_many

PRESETS = ("granulation", "pendulum", "granulation-dry-bridge", "lactose-pvp", "pellet-coating", "glass-beads-water")
FREE = (
    "particles.roughness",
    "liquid.viscosity",
    "liquid.film_thickness",
    "liquid.coating_thickness",
    "liquid.glass_transition_pressure",
    "bridge.surface_tension",
    "particles.dry_restitution",
)
SPREAD = np.log(2.0)  # factor of the true values to either side of the preset's
ENTRIES, NOISE = (2, 4), (0.01, 0.05)
ANGLES = np.radians([5.0, 80.0])


def drawn_truth(random: np.random.Generator, most: int) -> tuple[Scene, dict[str, float]]:
    """A preset and true values of some of its entries.

    Arguments:
        most: the largest number of entries.
    """
    preset = Scene.load(str(random.choice(PRESETS)))
    free = _entries(preset, random)[:most]
    truth = {name: preset.entries[name] * float(np.exp(random.uniform(-SPREAD, SPREAD))) for name in free}
    if "particles.dry_restitution" in truth:
        truth["particles.dry_restitution"] = float(random.uniform(0.5, 0.98))
    return preset, truth


def _entries(scene: Scene, random: np.random.Generator) -> list[str]:
    known = [name for name in FREE if name in scene.entries]
    size = int(random.integers(ENTRIES[0], min(ENTRIES[1], len(known)) + 1))
    return [known[k] for k in sorted(random.choice(len(known), size, replace=False))]


def window_of(scene: Scene) -> tuple[float, float] | None:
    """Stokes numbers about the changes of outcome; None where there are none."""
    stokes, angle = np.geomspace(1e-3, 300, 60), np.radians([10.0, 30.0, 50.0, 70.0])
    grid = [each.ravel() for each in np.meshgrid(stokes, angle, indexing="ij")]
    outcome = collide_many(scene, stokes=grid[0], angle=grid[1]).outcome.values.reshape(60, 4)
    changes = np.flatnonzero((outcome[1:] != outcome[:-1]).any(axis=1))
    if not changes.size or not (outcome == 0).any():
        return None
    return float(stokes[max(changes[0] - 3, 0)]), float(stokes[min(changes[-1] + 6, 59)])


def repeat(
    description: str | None,
    count: int,
    experiment: Callable[[int, argparse.Namespace], dict[str, object]],
    summary: Callable[[list[dict]], str],
    options: dict[str, float] | None = None,
) -> None:
    """Run an experiment for each seed as the command line asks, and print the summary.

    Arguments:
        count: experiments if no number is given.
        experiment: of a seed and the parsed options.
        options: further options, numbers, with their defaults.
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("count", type=int, nargs="?", default=count)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("-o", dest="output", type=Path)
    parser.add_argument("--read", type=Path)
    for name, default in (options or {}).items():
        parser.add_argument(f"--{name}", type=float, default=default)
    asked = parser.parse_args()
    warnings.simplefilter("ignore")
    if asked.read is not None:
        sys.stdout.write(summary([json.loads(line) for line in asked.read.read_text().splitlines()]) + "\n")
        return
    runs = []
    for k in range(asked.count):
        seed = 100_000 * asked.seed + k
        try:
            run = experiment(seed, asked)
        except (ComputationError, InputError) as error:
            run = {"seed": seed, "error": str(error)}
        runs.append(run)
        if asked.output is not None:
            with asked.output.open("a") as file:
                file.write(json.dumps(run) + "\n")
    sys.stdout.write(summary(runs) + "\n")
