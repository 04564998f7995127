"""Fits of synthetic experiments: coverage of the intervals, verdicts, and time.

`python -m tests.benchmarks.fits 200 --seed 1 -o fits.jsonl` draws scenes near the presets, impacts of which some stick,
and measurements with the scatter and noise that the likelihood assumes, starts each fit from the preset's values, and
prints in how many intervals the truth lies. A verdict is right if the fit of the same impacts without scatter and noise
gives it. With `--liquids 3` each experiment is a joint fit: three scenes that differ in viscosity and share the other
entries, a table of 10 to 20 impacts of each, and the noise of the restitution, which is free, is not as the data say.
`--quick 1` finds no intervals, only whether the truth would lie in them. With `--read FILE` it only prints the summary
of what was written.
"""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import asdict

import numpy as np
from wetdoublet.generated.automaton import OUTCOMES
from wetdoublet.solvers import ComputationError, InputError, Scene
from wetdoublet.solvers.fitting.fit import RTOL, fit
from wetdoublet.solvers.fitting.free_entries import IDENTIFIED
from wetdoublet.solvers.fitting.joint import Joint, problem
from wetdoublet.solvers.fitting.measurements import UNKNOWN, Measurements
from wetdoublet.solvers.fitting.optimise import Objective, optimise
from wetdoublet.solvers.fitting.profiles import profile_point
from wetdoublet.solvers.fitting.scatter import Resolution

from tests.helpers.synthetic import drawn

from .near_presets import ANGLES, ENTRIES, NOISE, drawn_truth, repeat, window_of

ROWS = (20, 60)
OWN, SHARED_NOISE, TABLE, APART = "liquid.viscosity", "noise.restitution", (10, 20), np.log(2.0)


def joint(seed: int, liquids: int, quick: bool) -> dict[str, object]:
    """One experiment with several liquids, and its fit."""
    random = np.random.default_rng(seed)
    while True:
        preset, truth = drawn_truth(random, ENTRIES[0])
        truth = dict([*(each for each in truth.items() if each[0] != OWN)][:1])
        values = preset.entries[OWN] * np.exp(random.uniform(-APART, APART, liquids))
        try:
            scenes = [preset.with_si(truth | {OWN: value}) for value in values.tolist()]
            windows = [window_of(each) for each in scenes]
        except InputError:
            continue
        if all(windows):
            break
    noise, scatter, factor = (
        random.uniform(*NOISE),
        random.uniform(*NOISE),
        float(np.exp(random.uniform(-APART, APART))),
    )
    tables = []
    for k, (scene, window) in enumerate(zip(scenes, windows, strict=True)):
        rows = int(random.integers(TABLE[0], TABLE[1] + 1))
        speed = np.exp(random.uniform(*np.log(window), rows)) / scene.stokes_per_speed
        plan = Measurements(
            speed, random.uniform(*ANGLES, rows), scatter * speed, np.full(rows, np.radians(random.uniform(0.5, 2.0))),
            np.full(rows, UNKNOWN), {"restitution": (np.ones(rows), np.full(rows, noise))},
        )  # fmt: skip
        data = drawn(scene, plan, liquids * seed + k)
        tables.append(data.noisier({"restitution": 1 / factor}))
    own = {f"{OWN}@{k + 1}": value for k, value in enumerate(values.tolist())}
    free = [OWN, *truth] + [SHARED_NOISE] * any(each.separated.any() for each in tables)
    told: dict[str, object] = {"seed": seed, "preset": preset.name, "rows": [each.size for each in tables]}
    told["truth"] = own | truth | {SHARED_NOISE: factor}
    start, wall = time.process_time(), time.perf_counter()
    if quick:
        return told | _profiles([preset] * liquids, tables, free, told["truth"])
    found = fit([preset] * liquids, tables, free, own=OWN)
    told["seconds"], told["wall"] = time.process_time() - start, time.perf_counter() - wall
    told["remarks"] = found.remarks
    return told | {"estimates": {name: asdict(each) for name, each in found.estimates.items()}, "expected": ""}


def _profiles(
    scenes: list[Scene], tables: list[Measurements], free: list[str], truth: dict[str, float]
) -> dict[str, object]:
    """How far the profile of each entry is below the maximum at its true value, and at an interval's end."""
    parts, entries = problem(scenes, tables, free, None, OWN, RTOL)
    likelihood = Joint(parts, entries.names, RTOL)
    best = optimise(likelihood, entries)
    objective = Objective(likelihood, entries, Resolution())
    true = entries.inner(np.array([truth[name] for name in entries.names]))
    below = {}
    for k, name in enumerate(entries.names):
        points = [profile_point(objective, start, k, float(true[k])) for start in (best.inner, true)]
        below[name] = best.value - max(map(objective.value, points))
    return {"below": below, "drop": objective.drop}


def experiment(seed: int) -> dict[str, object]:
    """One synthetic experiment and its two fits."""
    random = np.random.default_rng(seed)
    while True:
        preset, truth = drawn_truth(random, ENTRIES[1])
        free = list(truth)
        try:
            scene = preset.with_si(truth)
            window = window_of(scene)
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
    told["quadrature"] = found.quadrature
    told["remarks"] = found.remarks
    told["estimates"] = {name: asdict(each) for name, each in found.estimates.items()}
    told["below"] = float(found.objective.value(found.best) - found.objective.value(_inner(found, truth)))
    try:
        expected = fit(preset, drawn(scene, plan, None), free)
        told["expected"] = {name: asdict(each) for name, each in expected.estimates.items()}
    except ComputationError as error:
        told["expected"] = str(error)
    return told


def _inner(found: object, truth: dict[str, float]) -> np.ndarray:
    return np.array([each.inner(truth[each.name]) for each in found.free.entries])


def summary(runs: list[dict]) -> str:
    """Coverage and verdicts, with binomial errors."""
    if quick := [run for run in runs if "below" in run]:
        held = np.array([one < run["drop"] for run in quick for one in run["below"].values()], float)
        error = np.sqrt(held.mean() * (1 - held.mean()) / held.size)
        share = f"{held.mean():.1%} +- {error:.1%} of {held.size}"
        return f"{len(quick)} experiments: the truth is as likely as values in an interval in {share}"
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


if __name__ == "__main__":
    repeat(
        __doc__, 20,
        lambda seed, own: experiment(seed) if own.liquids == 1 else joint(seed, int(own.liquids), own.quick > 0),
        summary, {"liquids": 1, "quick": 0},
    )  # fmt: skip
