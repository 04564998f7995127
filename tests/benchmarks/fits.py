"""Fits of synthetic experiments: coverage of the intervals, verdicts, and time.

`python -m tests.benchmarks.fits 200 --seed 1 -o fits.jsonl` draws scenes near the presets, impacts of which some stick,
and measurements with the scatter and noise that the likelihood assumes, starts each fit from the preset's values, and
prints in how many intervals the truth lies. A verdict is right if the fit of the same impacts without scatter and noise
gives it. With `--read FILE` it only prints the summary of what was written.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
from wetdoublet.generated.automaton import OUTCOMES
from wetdoublet.solvers import ComputationError, InputError, Scene, collide_many
from wetdoublet.solvers.fitting.fit import fit
from wetdoublet.solvers.fitting.measurements import UNKNOWN, Measurements
from wetdoublet.solvers.fitting.synthetic import drawn
from wetdoublet.solvers.fitting.verdicts import IDENTIFIED

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
ROWS, ENTRIES, NOISE = (20, 60), (2, 4), (0.01, 0.05)
ANGLES = np.radians([5.0, 80.0])


def experiment(seed: int) -> dict[str, object]:
    """One synthetic experiment and its two fits."""
    random = np.random.default_rng(seed)
    while True:
        preset = Scene.load(str(random.choice(PRESETS)))
        free = _entries(preset, random)
        truth = {name: preset.entries[name] * float(np.exp(random.uniform(-SPREAD, SPREAD))) for name in free}
        if "particles.dry_restitution" in truth:
            truth["particles.dry_restitution"] = float(random.uniform(0.5, 0.98))
        try:
            scene = preset.with_si(truth)
            window = _window(scene)
        except InputError:
            continue
        if window is not None:
            break
    rows = int(random.integers(ROWS[0], ROWS[1] + 1))
    speed = np.exp(random.uniform(*np.log(window), rows)) / scene.stokes_per_speed
    angle = random.uniform(*ANGLES, rows)
    noise, scatter = random.uniform(*NOISE), random.uniform(*NOISE)
    plan = Measurements(
        speed, angle, scatter * speed, np.full(rows, np.radians(random.uniform(0.5, 2.0))), np.full(rows, UNKNOWN),
        {"restitution": (np.ones(rows), np.full(rows, noise))},
    )  # fmt: skip
    told: dict[str, object] = {"seed": seed, "preset": preset.name, "rows": rows, "truth": truth, "noise": noise}
    data = drawn(scene, plan, seed)
    told["outcomes"] = np.bincount(data.outcome, minlength=len(OUTCOMES)).tolist()
    start, wall = time.process_time(), time.perf_counter()
    found = fit(preset, data, free)
    told["seconds"], told["wall"] = time.process_time() - start, time.perf_counter() - wall
    told["evaluations"], told["quadrature"] = found.objective.evaluations, found.quadrature
    told["remarks"] = found.remarks
    told["estimates"] = {name: each.to_dict() for name, each in found.estimates.items()}
    told["below"] = float(found.objective.value(found.best) - found.objective.value(_inner(found, truth)))
    try:
        expected = fit(preset, drawn(scene, plan, None), free)
        told["expected"] = {name: each.to_dict() for name, each in expected.estimates.items()}
    except ComputationError as error:
        told["expected"] = str(error)
    return told


def _inner(found: object, truth: dict[str, float]) -> np.ndarray:
    return np.array([each.inner(truth[each.name]) for each in found.free.entries])


def _entries(scene: Scene, random: np.random.Generator) -> list[str]:
    known = [name for name in FREE if name in scene.entries]
    size = int(random.integers(ENTRIES[0], min(ENTRIES[1], len(known)) + 1))
    return [known[k] for k in sorted(random.choice(len(known), size, replace=False))]


def _window(scene: Scene) -> tuple[float, float] | None:
    """Stokes numbers about the changes of outcome; None where there are none."""
    stokes, angle = np.geomspace(1e-3, 300, 60), np.radians([10.0, 30.0, 50.0, 70.0])
    grid = [each.ravel() for each in np.meshgrid(stokes, angle, indexing="ij")]
    outcome = collide_many(scene, stokes=grid[0], angle=grid[1]).outcome.values.reshape(60, 4)
    changes = np.flatnonzero((outcome[1:] != outcome[:-1]).any(axis=1))
    if not changes.size or not (outcome == 0).any():
        return None
    return float(stokes[max(changes[0] - 3, 0)]), float(stokes[min(changes[-1] + 6, 59)])


def summary(runs: list[dict]) -> str:
    """Coverage and verdicts, with binomial errors."""
    done = [run for run in runs if "estimates" in run]
    covered, right = {True: [], False: []}, []
    verdicts: Counter[str] = Counter()
    for run in done:
        for name, each in run["estimates"].items():
            low = -np.inf if each["low"] is None else each["low"]
            high = np.inf if each["high"] is None else each["high"]
            covered[each["verdict"] == IDENTIFIED].append(low <= run["truth"][name] <= high)
            verdicts[each["verdict"]] += 1
            if isinstance(run["expected"], dict):
                right.append(each["verdict"] == run["expected"][name]["verdict"])
    lines = [f"{len(done)} experiments, {len(runs) - len(done)} without a fit"]
    for identified, label in ((True, "identified"), (False, "other")):
        held = np.array(covered[identified], dtype=float)
        if held.size:
            error = np.sqrt(held.mean() * (1 - held.mean()) / held.size)
            lines.append(f"{label}: the interval holds the truth in {held.mean():.1%} +- {error:.1%} of {held.size}")
    if right:
        share = float(np.mean(right))
        lines.append(f"verdicts right: {share:.1%} +- {np.sqrt(share * (1 - share) / len(right)):.1%} of {len(right)}")
    lines.append(", ".join(f"{word}: {count}" for word, count in verdicts.items()))
    for label in ("seconds", "wall"):
        times = [run[label] for run in done]
        lines.append(f"{label}: median {np.median(times):.2f}, 90 % {np.quantile(times, 0.9):.2f}")
    for preset in dict.fromkeys(run["preset"] for run in done):
        own = [run for run in done if run["preset"] == preset]
        lines.append(f"  {preset}: {len(own)}, median {np.median([run['seconds'] for run in own]):.2f} s")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", type=int, nargs="?", default=20)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("-o", dest="output", type=Path)
    parser.add_argument("--read", type=Path)
    asked = parser.parse_args()
    warnings.simplefilter("ignore")
    if asked.read is not None:
        sys.stdout.write(summary([json.loads(line) for line in asked.read.read_text().splitlines()]) + "\n")
        return
    runs = []
    for k in range(asked.count):
        seed = 100_000 * asked.seed + k
        try:
            run = experiment(seed)
        except (ComputationError, InputError) as error:
            run = {"seed": seed, "error": str(error)}
        runs.append(run)
        if asked.output is not None:
            with asked.output.open("a") as file:
                file.write(json.dumps(run) + "\n")
    sys.stdout.write(summary(runs) + "\n")


if __name__ == "__main__":
    main()
