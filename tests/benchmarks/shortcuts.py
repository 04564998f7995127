"""What the kernel leaves out, beside whole trajectories: jumps on the slow manifold, and proofs of a stick.

    python -m tests.benchmarks.shortcuts [COUNT] [SEED]

COUNT (100,000) random collisions of every preset, Stokes numbers 1e-3 to 10 and angles from 0 to 89 deg, then as many
in which every number of the scene is scaled by up to a factor of 5 as well. Each is computed with jumps, without, and
without at rtol 1e-12; sticks that are certified are followed without certificates, by a kernel from which they are
taken. A line per set; status 1 where an outcome differs, an error is more than that of the whole trajectory beyond the
tolerance, or a certified stick separates.
"""

# ruff: noqa: T201 -- a script that prints
from __future__ import annotations

import ctypes
import sys
from collections.abc import Iterator

import numpy as np
from wetdoublet.generated.automaton import LAST_ANSWER, Status
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.taylor.build import FLAGS, source
from wetdoublet.solvers.engines.taylor.call import Impacts, bind_kernel, run_kernel, variant_for_many
from wetdoublet.solvers.engines.taylor.headers import headers
from wetdoublet.solvers.engines.taylor.layout import ANSWER
from wetdoublet.solvers.host.compiler import library
from wetdoublet.solvers.host.user_cache import loaded
from wetdoublet.solvers.many.batch import batch
from wetdoublet.solvers.many.by_kernel import impacts_of
from wetdoublet.solvers.scene.scenefile import PRESETS
from wetdoublet.solvers.settings import RTOL

from .atlas_random import SCALED

TIGHT = 1e-12
STOKES, STEEPEST, HEAD_ON = (1e-3, 10.0), 89.0, 0.01  # and the share that is head-on
BEYOND = 10.0  # tolerances by which errors may differ, where the whole trajectory's is small
FOLLOWED = 3000  # steps of a certified stick
TAKEN = {  # lines of the kernel that consult certificates, and what they become
    "#if LEAPS\n        unsigned leaps": "        proved = 0;\n#if LEAPS\n        unsigned leaps",
    "sticks |= proved_underway(&l, &f, q->rtol);": "sticks = splat_mask(0);",
}


def sets(count: int, seed: int) -> Iterator[tuple[str, Impacts]]:
    """Impacts of every preset, and of scenes about it."""
    draw = np.random.default_rng(seed)
    for preset in PRESETS:
        scene = Scene.load(preset)
        for name in (preset, f"about {preset}"):
            angle = np.radians(draw.uniform(0.0, STEEPEST, count)) * (draw.uniform(size=count) > HEAD_ON)
            columns = {"impact.stokes": np.exp(draw.uniform(*np.log(STOKES), count)), "impact.angle": angle}
            if name != preset:
                entries = {
                    entry: scene.entries[entry] for entry in SCALED if isinstance(scene.entries.get(entry), float)
                }
                columns |= {
                    entry: float(value) * 5.0 ** draw.uniform(-1.0, 1.0, count) for entry, value in entries.items()
                }
                columns["particles.dry_restitution"] = draw.uniform(0.2, 1.0, count)
            yield name, impacts_of(batch(scene, columns, RTOL, "taylor", ()))[0]


def computed(impacts: Impacts, rtol: float, jumps: int) -> np.ndarray:
    """The kernel's answers."""
    found = run_kernel(impacts, rtol, jumps=jumps)
    assert found is not None, "there is no kernel here"
    return found


def separated(impacts: Impacts) -> int:
    """How many of these sticks, in which something moves sideways, separate without certificates."""
    if not impacts.angle.size:
        return 0
    variant = variant_for_many(impacts.scene, True, RTOL, False, fold=not impacts.others)
    text = source(variant, headers(variant.choice) or ())
    for old, new in TAKEN.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    kernel = loaded(library(text, FLAGS), ctypes.CDLL)
    kernel.collide.restype, kernel.collide.argtypes = ctypes.c_char_p, [ctypes.c_void_p]
    found = np.zeros(impacts.angle.size, ANSWER)
    bind_kernel(kernel, RTOL, FOLLOWED)(impacts, found)
    return int(((found["status"] == Status.DECIDED) & (found["outcome"] > 0)).sum())


def compared(name: str, impacts: Impacts) -> int:
    """Print what jumps and certificates change; returns how much of it is wrong."""
    jumped, whole = (computed(impacts, RTOL, jumps) for jumps in (2, 0))
    exact = computed(impacts, TIGHT, 0)
    answered = (whole["status"] <= LAST_ANSWER) & (exact["status"] <= LAST_ANSWER)
    wrong = int((answered & ((jumped["status"] > LAST_ANSWER) | (jumped["outcome"] != whole["outcome"]))).sum())
    loose = int((answered & (whole["outcome"] != exact["outcome"])).sum())
    left = answered & (jumped["outcome"] > 0) & (whole["outcome"] > 0) & (exact["outcome"] > 0)
    values = [each["shown"][left, 0] for each in (jumped, whole, exact)]
    errors = [np.abs(value - values[2]) / np.maximum(1.0, np.abs(values[2])) for value in values[:2]]
    larger = int((errors[0] > BEYOND * np.maximum(errors[1], RTOL)).sum())
    certified = (jumped["certified"] != 0) & (impacts.angle > 0)
    escaped = separated(impacts.part(np.flatnonzero(certified)))
    moved = whole["status"] != Status.PROVED_AT_TOUCH
    steps = [np.percentile(each["steps"][moved], (50, 99)) if moved.any() else (0, 0) for each in (jumped, whole)]
    largest = [each.max(initial=0.0) for each in errors]
    print(
        f"{name}: {impacts.angle.size} collisions, {int((jumped['steps'] < whole['steps']).sum())} jump; "
        f"wrong {wrong} (and at {RTOL:g} beside {TIGHT:g}: {loose}); "
        f"largest error {largest[0]:.1e}, whole {largest[1]:.1e}, {larger} beyond it; "
        f"steps p50, p99 {steps[0][0]:.0f}, {steps[0][1]:.0f}, whole {steps[1][0]:.0f}, {steps[1][1]:.0f}; "
        f"{escaped} of {int(certified.sum())} certified sticks separate; "
        f"{int((~answered).sum())} handed over",
        flush=True,
    )
    return wrong + larger + escaped


def main() -> int:
    """Every set."""
    given = dict(enumerate(map(int, sys.argv[1:])))
    return min(1, sum([compared(*each) for each in sets(given.get(0, 100_000), given.get(1, 1))]))


if __name__ == "__main__":
    sys.exit(main())
