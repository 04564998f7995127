"""Designed impacts beside a grid of as many: the width of the interval on a named entry.

`python -m tests.benchmarks.designs 200 --seed 1 -o designs.jsonl` draws scenes near the presets with 2 or 3 free
entries, one of which is named, and a window of Stokes numbers and angles about the changes of outcome. N impacts (9, 16
or 25) are designed for the named entry, and as many put on a sqrt(N) by sqrt(N) grid over the window, Stokes numbers in
their logarithm. Both are measured with the same scatter and noise and fitted alike from the same first guess; the ratio
of the two 95 % intervals (of the entry's logarithm) is what counts. An open interval is as long as the range of the
fit.

`--off 0.1` designs and starts for values that are wrong by 10 % (one standard deviation), which the fit is told as a
prior in both cases; the design is averaged over 8 draws from it. With `--read FILE` it only prints the summary.
"""

from __future__ import annotations

import time

import numpy as np
from wetdoublet.solvers import InputError, Scene, design, fit
from wetdoublet.solvers.fitting.measurements import Measurements

from tests.helpers.synthetic import drawn

from .near_presets import ANGLES, NOISE, drawn_truth, repeat, window_of

NUMBERS = (9, 16, 25)
DRAWS = 8
_NOISE_SEED = 10**9  # what is measured does not depend on how the scene was drawn


def experiment(seed: int, off: float) -> dict[str, object]:
    """One scene, designed and on a grid."""
    random = np.random.default_rng(seed)
    while True:
        preset, truth = drawn_truth(random, 3)
        free = list(truth)
        shift = {name: float(np.exp(off * random.standard_normal())) for name in free}
        try:
            scene = preset.with_si(truth)
            guess = scene.with_si({name: min(value * shift[name], 1.0) if "restitution" in name else value * shift[name]
                                   for name, value in truth.items()})  # fmt: skip
            window = window_of(scene)
        except InputError:
            continue
        if window is not None:
            break
    target, number = str(random.choice(free)), int(random.choice(NUMBERS))
    noise, scatter, angle = random.uniform(*NOISE), random.uniform(*NOISE), np.radians(random.uniform(0.5, 2.0))
    prior = None
    if off:
        prior = {name: f"{guess.entries[name]!r} {guess.fields[name].unit or ''} +- {100 * off} %" for name in free}
    told: dict[str, object] = {"seed": seed, "preset": preset.name, "free": free, "target": target, "n": number}
    start = time.process_time()
    try:
        planned = design(
            guess, free, {"stokes": window, "angle": tuple(ANGLES)}, number, target=target, prior=prior,
            draws=DRAWS if off else 0, speed_sd=scatter, angle_sd=angle, restitution_sd=noise,
        )  # fmt: skip
    except InputError as error:
        return told | {"refused": str(error)}
    told["seconds"] = time.process_time() - start
    told["foretold"], told["efficiency"] = planned.against_grid[target], planned.efficiency
    grid = planned.window.grid(*planned.grid)
    for label, plan in (("designed", planned.plan()), ("grid", planned.window.plan(grid))):
        told[label] = _width(guess, scene, plan, free, target, prior, seed, noise)
    return told


def _width(
    guess: Scene, scene: Scene, plan: Measurements, free: list[str], target: str, prior: dict[str, str] | None,
    seed: int, noise: float,
) -> dict[str, float | str]:  # fmt: skip
    rows = plan.size
    plan = Measurements(
        plan.speed, plan.angle, plan.speed_sd, plan.angle_sd, plan.outcome,
        {"restitution": (np.ones(rows), np.full(rows, noise))},
    )  # fmt: skip
    found = fit(guess, drawn(scene, plan, _NOISE_SEED + seed), free, prior=prior)
    entry = found.free.entries[free.index(target)]
    one = found.estimates[target]
    low, high = (entry.low if one.low is None else one.low), (entry.high if one.high is None else one.high)
    truth = dict(scene.entries)[target]
    return {
        "width": entry.inner(high) - entry.inner(low), "verdict": one.verdict, "holds": bool(low <= truth <= high),
        "open": one.low is None or one.high is None,
    }  # fmt: skip


def summary(runs: list[dict]) -> str:
    """Median ratio, and its quartiles."""
    done = [run for run in runs if "grid" in run]
    refused = sum("refused" in run for run in runs)
    failed = len(runs) - len(done) - refused
    lines = [f"{len(done)} experiments; {refused} with an entry that the window does not tell; {failed} failed"]
    ratio = np.array([run["designed"]["width"] / run["grid"]["width"] for run in done])
    quartiles = ", ".join(f"{each:.3f}" for each in np.quantile(ratio, (0.25, 0.5, 0.75)))
    lines.append(f"interval, designed over grid: quartiles {quartiles}")
    error = 1.25 * np.std(np.log(np.clip(ratio, 1e-3, 1e3))) / np.sqrt(len(done))
    foretold = np.median([run["foretold"] for run in done])
    lines.append(f"  standard error of the median's logarithm about {error:.2f}; foretold {foretold:.3f}")
    closed = [k for k, run in enumerate(done) if not run["designed"]["open"] and not run["grid"]["open"]]
    lines.append(
        f"  both closed: {len(closed)}, median {np.median(ratio[closed]):.3f}" if closed else "  never both closed"
    )
    for label in ("designed", "grid"):
        shut = np.mean([run[label]["open"] for run in done])
        held = np.mean([run[label]["holds"] for run in done])
        lines.append(f"{label}: open in {shut:.0%}, holds the truth in {held:.1%}")
    for number in NUMBERS:
        own = [value for value, run in zip(ratio, done) if run["n"] == number]
        if own:
            lines.append(f"  N = {number}: {len(own)}, median {np.median(own):.3f}")
    lines.append(f"a design takes {np.median([run['seconds'] for run in done]):.1f} s of CPU (median)")
    return "\n".join(lines)


if __name__ == "__main__":
    repeat(__doc__, 10, lambda seed, asked: experiment(seed, asked.off), summary, {"off": 0.0})
