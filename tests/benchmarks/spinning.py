"""Random collisions with spins beside the independent reference of the tests.

    python -m tests.benchmarks.spinning [COUNT] [SEED] [MODELS]

COUNT (1000) random collisions of MODELS (24) structures and laws, partners, walls, films, attractions and head-on ones
among them, by `collide_many` at rtol 1e-12 and by `tests/helpers/spinning.py`, in two processes. Prints the largest
differences and every disagreement with its scene; status 1 where there is one. What differs by more than 1e-8 is
compared with the reference's own change for a speed that differs by 1e-7: near a boundary no engine can do better.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import groupby

import numpy as np
from wetdoublet.solvers import Scene, collide_many

from ..helpers.flow import Unfinished
from ..helpers.phases import Chatter, End
from ..helpers.random_spinning import Model, impact_of, scenes, tables
from ..helpers.spinning import FILM, PARTNER, SPIN, TURNING, Impact, Planar, U, collided
from ..helpers.two_bodies import Bodies, bodies_of
from .verdicts import FAILED, OUTCOMES, SAME, Verdict, summary

RTOL, STEP = 1e-12, 1e-7
RATES = ("final_spin", "final_spin_partner", "final_rotation_rate")


def quantities(bodies: Bodies, impact: Impact, end: End) -> dict[str, float]:
    """Restitution, and spins and rates as surface speeds over all initial ones; NaN for a stick."""
    if end.outcome == "stick":
        return {"restitution": 0.0, **dict.fromkeys(RATES, math.nan)}
    rates = end.state[SPIN], end.state[PARTNER], 0.0 if bodies.wall else end.state[TURNING]
    return {"restitution": end.state[U] / impact.speed, **dict(zip(RATES, rates, strict=True))}


def scales(bodies: Bodies, impact: Impact) -> dict[str, float]:
    """By what differences are divided: 1, and the initial surface speeds over the radius or the distance."""
    spun = [abs(impact.spin) * bodies.radii[0]]
    spun += [] if bodies.wall else [abs(impact.partner_spin) * bodies.radii[1]]
    fast = impact.speed * (1 + math.tan(impact.angle)) + sum(spun)
    return {
        "restitution": 1.0,
        "final_spin": fast / bodies.radii[0],
        "final_spin_partner": fast / bodies.radii[1] if not bodies.wall else 1.0,
        "final_rotation_rate": fast / bodies.contact if not bodies.wall else 1.0,
    }


def differences(bodies: Bodies, impact: Impact, one: dict[str, float], other: dict[str, float]) -> dict[str, float]:
    """Scaled differences of what both have."""
    unit = scales(bodies, impact)
    both = {name for name in one if name in other and not (math.isnan(one[name]) and math.isnan(other[name]))}
    apart = {name: abs(one[name] - other[name]) / unit[name] for name in both}
    apart["restitution"] /= max(1e-3, abs(one["restitution"]))
    return apart


def judged(model: Model, entries: dict[str, float], found: dict[str, float]) -> Verdict:
    """The reference's answer beside the one found."""
    scene = Scene.from_dict(tables(model, entries))
    bodies, impact = bodies_of(scene), impact_of(scene)
    outcome = FAILED if found["outcome"] < 0 else OUTCOMES[int(found["outcome"])]
    described = tables(model, entries)
    try:
        end = collided(bodies, impact)
    except (Chatter, Unfinished) as error:
        return Verdict(described, impact, type(error).__name__, outcome, remark=str(error))
    if end.outcome != outcome:
        return Verdict(described, impact, end.outcome, outcome, remark=f"{end.events} {end.time}")
    expected = quantities(bodies, impact, end)
    apart = differences(bodies, impact, expected, {name: found[name] for name in expected if name in found})
    sharpest = SAME
    if max(apart.values()) > SAME:
        beside = replace(impact, speed=impact.speed * (1 + STEP))
        try:
            other = collided(bodies, beside)
            sharpest *= max(
                1.0, max(differences(bodies, impact, expected, quantities(bodies, beside, other)).values()) / STEP
            )
        except (Chatter, Unfinished):
            sharpest = math.inf
    kinetic = Planar(bodies, impact).kinetic
    size = kinetic(end.start)
    gap = kinetic(end.state) + sum(end.state[FILM:]) + end.dry - size
    remark = "" if abs(gap) < 1e-9 * size else f"reference's ledger is open by {gap / size:.1e}"
    return Verdict(described, impact, end.outcome, outcome, apart, sharpest, remark)


def computed(model: Model, entries: list[dict[str, float]]) -> list[dict[str, float]]:
    """What `collide_many` says of scenes of one model."""
    scene = Scene.from_dict(tables(model, entries[0]))
    names = [name for name in entries[0] if name not in ("impact.stokes", "impact.angle")]
    of = [
        name
        for name in RATES
        if name != "final_spin_partner" or model.partner == "pair" or "impact.partner_spin" in names
    ]
    found = collide_many(
        scene,
        stokes=[one["impact.stokes"] for one in entries],
        angle=[one["impact.angle"] for one in entries],
        vary={name: [one[name] for one in entries] for name in names},
        rtol=RTOL,
        of=of,
    )
    columns = {name: np.asarray(found[name]) for name in ("outcome", "restitution", *of)}
    return [{name: float(column[k]) for name, column in columns.items()} for k in range(len(entries))]


def compared(count: int, seed: int, of: int) -> Iterator[list[Verdict]]:
    """The comparisons of each model, in two processes (new ones: scipy's DOP853 loses memory by every call)."""
    for model, group in groupby(scenes(count, seed, of), key=lambda each: each[0]):
        entries = [one for _, one in group]
        found = computed(model, entries)
        with ProcessPoolExecutor(2) as pool:
            yield list(pool.map(judged, [model] * len(entries), entries, found, chunksize=4))


def main(count: int = 1000, seed: int = 16, of: int = 24) -> int:
    return summary(compared(count, seed, of), ("restitution", *RATES))


if __name__ == "__main__":
    sys.exit(main(*(int(each) for each in sys.argv[1:4])))
