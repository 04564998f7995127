"""Intervals of fits to synthetic impacts: their ends beside those of a ten times finer integral, and how many hold.

    python -m tests.benchmarks.intervals ends [--sets N] [--first SEED]
    python -m tests.benchmarks.intervals coverage [--sets N] [--first SEED]

A data set is a liquid with a viscosity of its own between the half and twice a preset's, and impacts in a window of
speeds about its changes of outcome. Of `ends` half the sets are impacts that all have a change of outcome within two
standard deviations of their scatter, the others have none there; what an end has lost is computed again on the
likelihood with ten times as many lines. `coverage` counts the intervals of identified entries that hold the truth, and
fits one and two entries in turn.
"""

import argparse
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from wetdoublet.solvers import Scene, fit
from wetdoublet.solvers.fitting.fit import RTOL
from wetdoublet.solvers.fitting.free_entries import IDENTIFIED, FreeEntries
from wetdoublet.solvers.fitting.joint import Joint, Part, problem
from wetdoublet.solvers.fitting.measurements import Measurements, rows_of
from wetdoublet.solvers.fitting.optimise import Objective, rough_maximum
from wetdoublet.solvers.fitting.scatter import Resolution

from ..helpers.synthetic import drawn

say = partial(print, flush=True)
FINE = Resolution(31, 12, 192, 31, True, 1e-6)
WINDOWS = {  # Stokes numbers that straddle the changes of outcome, and a second entry
    "granulation": (0.03, 0.6, "liquid.film_thickness"),
    "pendulum": (0.5, 4.0, "liquid.film_thickness"),
    "granulation-dry-bridge": (0.02, 0.4, "particles.dry_restitution"),
    "lactose-pvp": (3.0, 60.0, "particles.roughness"),
    "pellet-coating": (0.7, 12.0, "liquid.coating_thickness"),
}
_CLOSE = 5e-4  # of the log-likelihood, to which the reference's maxima are found


@dataclass(frozen=True)
class Case:
    """A synthetic data set: the scene of the truth, another as first guess, entries and impacts."""

    name: str
    truth: Scene
    guess: Scene
    free: tuple[str, ...]
    data: Measurements


def case(seed: int, rows: tuple[int, int], changing: bool | None, entries: int) -> Case:
    """The data set of a seed; `changing` says whether outcomes change within the spread of each row, None: some do."""
    random = np.random.default_rng(seed)
    name = list(WINDOWS)[seed % len(WINDOWS)]
    low, high, second = WINDOWS[name]
    preset = Scene.load(name)
    viscosity = preset.entries["liquid.viscosity"]
    truth = preset.with_entries({"liquid.viscosity": viscosity * 2 ** random.uniform(-1, 1)})
    guess = preset.with_entries({"liquid.viscosity": viscosity})
    many = 2000
    speed = np.exp(random.uniform(np.log(low), np.log(high), many)) / preset.stokes_per_speed
    angle = np.radians(random.uniform(5, 65, many))
    wide, tilt, noise = random.uniform(0.01, 0.05), np.radians(random.uniform(0.5, 2.0)), random.uniform(0.01, 0.04)
    plan = Measurements(speed, angle, wide * speed, np.full(many, tilt), np.zeros(many, np.int8), {})
    experiment, every = rows_of(truth, (), plan, RTOL).unchecked(np.zeros(0)), np.arange(many)
    around = [
        experiment.outcomes(every, speed * (1 + 2 * wide * np.cos(turn)), angle + 2 * tilt * np.sin(turn))
        for turn in np.linspace(0, 2 * np.pi, 12, endpoint=False)
    ]
    changes = (np.array(around) != around[0]).any(axis=0)
    which = every if changing is None else np.flatnonzero(changes == changing)
    which = which[: int(random.integers(*rows))]
    result = {"restitution": (np.zeros(many), np.full(many, noise))}
    plan = Measurements(speed, angle, plan.speed_sd, plan.angle_sd, plan.outcome, result).subset(which)
    free = ("liquid.viscosity", second)[:entries]
    return Case(name, truth, guess, free, drawn(truth, plan, seed))


def maximum(objective: Objective, start: np.ndarray) -> float:
    """The log-likelihood at the maximum nearest to a start, by least squares again and again."""
    for _ in range(8):
        before, start = objective.value(start), rough_maximum(objective, start, variables=1e-6)
        if objective.value(start) - before < _CLOSE:
            break
    return float(objective.value(start))


def beyond(objective: Objective, top: float, best: np.ndarray, k: int, end: np.ndarray) -> float:
    """How far entry k's end lies beyond the true one, over half the width: the root of twice the drop is linear in it.

    The others are at their maximum there, by Newton's method.
    """
    others, at = np.flatnonzero(np.arange(best.size) != k), end.copy()
    for _ in range(12 if others.size else 0):
        slope = objective.gradient(at)[others]
        step = np.linalg.solve((objective.information(at) + objective.free.vague)[np.ix_(others, others)], slope)
        if slope @ step / 2 < _CLOSE:
            break
        height, moved = objective.value(at), at.copy()
        for part in (1.0, 0.5, 0.25, 0.125):
            moved[others] = at[others] + part * step
            if objective.value(moved) > height:
                at[others] = moved[others]
                break
        else:
            break
    return float(np.sqrt(max(top - objective.value(at), 0.0) / objective.drop)) - 1


def ends(seeds: range) -> Iterator[tuple[bool, str, str, float, float]]:
    """Of each end: whether outcomes change in the rows, preset, entry, error over half width, the fit's seconds."""
    for seed in seeds:
        changing, entries = seed // len(WINDOWS) % 2 == 0, 1 + seed // (2 * len(WINDOWS)) % 2
        drawing = case(seed, (12, 40), changing, entries)
        begun = time.process_time()
        found = fit(drawing.guess, drawing.data, drawing.free)
        spent = time.process_time() - begun
        parts, free = problem(drawing.guess, drawing.data, drawing.free, None, (), RTOL)
        near = free.inner(np.array([estimate.value for estimate in found.estimates.values()]))
        top = maximum(finely(parts, free, near), near)
        for k, name in enumerate(free.names):
            if found.estimates[name].verdict != IDENTIFIED:
                continue
            for end in found.ends[k]:
                error = beyond(finely(parts, free, end), top, near, k, end)
                yield changing, drawing.name, name, error, spent


def finely(parts: tuple[Part, ...], free: FreeEntries, at: np.ndarray) -> Objective:
    """The likelihood by FINE, with the lines of all rows turned for a point."""
    likelihood = Joint(parts, free.names, RTOL)
    likelihood.aim(free.values(at))
    return Objective(likelihood, free, FINE)


def coverage(seeds: range) -> Iterator[tuple[int, str, str, bool]]:
    """Of each interval of an identified entry: number of entries, preset, entry, whether the truth is in it."""
    for seed in seeds:
        entries = 1 + seed // len(WINDOWS) % 2
        drawing = case(seed, (12, 30), None, entries)
        found = fit(drawing.guess, drawing.data, drawing.free)
        for name, estimate in found.estimates.items():
            if estimate.verdict == IDENTIFIED:
                true = float(drawing.truth.entries[name])
                yield entries, drawing.name, name, estimate.low <= true <= estimate.high


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("ends", "coverage"))
    parser.add_argument("--sets", type=int, default=40)
    parser.add_argument("--first", type=int, default=0)
    given = parser.parse_args()
    seeds = range(given.first, given.first + given.sets)
    begun = time.process_time()
    if given.what == "ends":
        errors: dict[bool, list[float]] = {True: [], False: []}
        for changing, preset, name, error, spent in ends(seeds):
            errors[changing].append(abs(error))
            say(f"{preset:24} {name:28} {'changes' if changing else 'none':8} {100 * error:8.3f} %  {spent:6.2f} s")
        for changing, sizes in ((key, values) for key, values in errors.items() if values):
            say(
                f"changes of outcome {changing}: {len(sizes)} ends, largest {100 * max(sizes):.2f} %, "
                f"median {100 * np.median(sizes):.2f} %, {np.sum(np.array(sizes) > 0.01)} above 1 %"
            )
    else:
        held: dict[int, list[bool]] = {1: [], 2: []}
        for entries, preset, name, holds in coverage(seeds):
            held[entries].append(holds)
            say(f"{preset:24} {name:28} {'' if holds else 'missed'}")
        for entries, flags in held.items():
            say(f"{entries} free: {np.mean(flags):.3f} of {len(flags)} intervals hold the truth")
        say(f"all: {np.mean([*held[1], *held[2]]):.3f} of {len(held[1]) + len(held[2])}")
    say(f"{time.process_time() - begun:.0f} processor seconds")


if __name__ == "__main__":
    main()
