"""Random collisions by an engine beside the event search of the tests.

    python -m tests.benchmarks.scanned [COUNT] [SEED] [MODELS]

COUNT (1000) random collisions of MODELS (24) structures and laws, half of them with friction, by `collide` with the
engine `rosenbrock` at rtol 1e-9 and by `tests/helpers/scanned.py`, which shares neither equations nor event location
with it. Prints the largest differences and every disagreement with its scene; status 1 where there is one. What differs
by more than 1e-7 is compared with the change of the scan's own answer for a speed that differs by 1e-7.
"""

# ruff: noqa: T201 -- a script that prints
import json
import math
import sys
import warnings
from collections import Counter
from dataclasses import dataclass

import numpy as np
from wetdoublet.solvers import Collision, Scene, collide
from wetdoublet.solvers.errors import ComputationError, ModelWarning

from ..helpers.random_spinning import scenes, tables, with_friction
from ..helpers.scanned import Outcome, UndecidedError, scanned

RTOL, SAME, STEP = 1e-9, 1e-7, 1e-7


@dataclass(frozen=True)
class Comparison:
    """Words of both, and the largest of the differences that are not explained by the collision's own sensitivity."""

    expected: str
    found: str
    apart: float = 0.0
    sharpest: float = SAME

    @property
    def compared(self) -> bool:
        return not {"undecided", "failed"} & {self.expected, self.found}

    @property
    def agrees(self) -> bool:
        return self.expected == self.found and self.apart <= self.sharpest


def apart(scene: Scene, one: Outcome, found: Collision | Outcome) -> float:
    """The largest relative difference of restitution, time and spins; infinite for another criterion of the rebound."""
    if one.outcome == "stick":
        return 0.0
    if one.reversal != found.reversal:
        return math.inf
    if isinstance(found, Outcome):
        time, spins = found.time, found.spins
    else:
        second = found.final_spin if found.final_spin_partner is None else found.final_spin_partner
        time, spins = found.contact_time or 0.0, (found.final_spin or 0.0, second or 0.0)
    fast = scene.speed / math.cos(scene.angle) + abs(one.across)
    radius = 2 * scene.particles.reduced_radius
    spinning = [fast / radius + abs(spin) for spin in one.spins]
    return max(
        abs(one.restitution - found.restitution) / max(1e-3, abs(one.restitution)),
        abs(one.time - time) / (max(one.time, time) or 1.0),
        *(abs(a - b) / unit for a, b, unit in zip(one.spins[: 1 if scene.wall else 2], spins, spinning)),
    )


def compared(scene: Scene, engine: str = "rosenbrock") -> Comparison:
    """An engine's collision beside the scan of it."""
    try:
        found = collide(scene, rtol=RTOL, engine=engine, ledger=False)
    except ComputationError:
        found = None
    word = "failed" if found is None else found.outcome
    try:
        one = scanned(scene, RTOL)
    except UndecidedError:
        return Comparison("undecided", word)
    if found is None or one.outcome != word:
        return Comparison(one.outcome, word)
    differs, sharpest = apart(scene, one, found), SAME
    if differs > SAME:
        try:
            other = scanned(scene, RTOL, speed=scene.speed * (1 + STEP))
            sharpest *= max(1.0, apart(scene, one, other) / STEP if other.outcome == word else math.inf)
        except UndecidedError:
            sharpest = math.inf
    return Comparison(one.outcome, word, differs, sharpest)


def main(count: int = 1000, seed: int = 25, of: int = 24) -> int:
    warnings.simplefilter("ignore", ModelWarning)
    draw = np.random.default_rng((seed, 4))
    every: list[Comparison] = []
    for model, entries in scenes(count, seed, of):
        described = tables(model, entries)
        if draw.random() < 0.5:
            described = with_friction(described, draw)
        one = compared(Scene.from_dict(described))
        every.append(one)
        if one.compared and not one.agrees:
            print(f"DISAGREES: {one}\n  {json.dumps(described)}", flush=True)
        elif one.expected != one.found:
            print(f"left: {one.expected}, found {one.found}\n  {json.dumps(described)}", flush=True)
    print(Counter((one.expected, one.found) for one in every))
    both = [one for one in every if one.compared]
    wrong = sum(not one.agrees for one in both)
    largest = max((one.apart for one in both if one.agrees), default=0.0)
    beyond = sum(one.apart > SAME for one in both)
    print(f"{len(both)} compared, {len(every) - len(both)} left out; largest {largest:.1e}, {beyond} beyond {SAME:g}")
    print(f"{wrong} disagreements")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main(*(int(each) for each in sys.argv[1:4])))
