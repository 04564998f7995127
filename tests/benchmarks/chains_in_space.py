"""Chains of collisions in space: what comes out goes in again, with a random new normal.

    python -m tests.benchmarks.chains_in_space [CHAINS] [LENGTH] [SEED]

CHAINS (20) chains of each kind (spheres equal and unequal, a wall; with a bridge, attraction, a film alone), of
LENGTH (100) collisions each, all chains of a kind at once by `collide_pair`. Before each collision both are turned
against each other, with an approach speed from 0.003 to 10 times that which a film stops; their spins, and what they
move across the new normal, are what the last one left, sticks' too, slowed down alike where the fastest is beyond
5 approach speeds. A line per kind: outcomes, refusals, the largest energy
created. Status 1 where one is refused or energy is created beyond the tolerance.
"""

# ruff: noqa: T201 -- a script that prints
from __future__ import annotations

import sys
import time
from collections import Counter
from itertools import product

import numpy as np
from wetdoublet.solvers import Scene, collide_pair

from ..helpers.two_bodies import Bodies, bodies_of

RTOL = 1e-8
CREATED = 30 * RTOL  # of the energy at initial contact
KINDS = {
    "bridge": ("granulation", {}),
    "attraction": ("granulation-dry-bridge", {"attraction.hamaker": 1e-15}),
    "bridge and attraction": ("granulation", {"attraction.hamaker": 1e-15}),
    "film": ("granulation-dry-bridge", {}),
}
PARTNERS: dict[str, dict[str, float | str | bool]] = {
    "equal": {},
    "unequal": {"partner.radius": "0.2 mm", "partner.mass": "3e-5 g"},
    "wall": {"partner.wall": True},
}
FASTEST = 5.0  # approach speeds


def directions(draw: np.random.Generator, count: int) -> np.ndarray:
    """Random unit vectors."""
    found = draw.normal(size=(count, 3))
    return np.asarray(found / np.linalg.norm(found, axis=1, keepdims=True))


def energies(bodies: Bodies, velocities: np.ndarray, spins: np.ndarray) -> np.ndarray:
    """Kinetic energies; beside a wall of the sphere."""
    moving = 1 if bodies.wall else 2
    found = sum(
        bodies.masses[k] * np.sum(velocities[:, k] ** 2, axis=1) + bodies.inertias[k] * np.sum(spins[:, k] ** 2, axis=1)
        for k in range(moving)
    )
    return np.asarray(found) / 2


def chains(scene: Scene, count: int, length: int, seed: int) -> tuple[Counter[str], float, list[str]]:
    """Outcomes of chains, the largest energy created over the energy before, and why collisions were refused."""
    draw, bodies = np.random.default_rng(seed), bodies_of(scene)
    stopped = 6 * np.pi * bodies.viscosity * bodies.a**2 / bodies.m
    moving = 1 if bodies.wall else 2
    radii = np.array(bodies.radii[:moving])[:, None]
    velocities = draw.normal(size=(count, moving, 3)) * stopped
    spins = draw.normal(size=(count, moving, 3)) * stopped / bodies.radii[0]
    outcomes: Counter[str] = Counter()
    created, refused = 0.0, []
    for _ in range(length):
        normal = directions(draw, count)
        speed = stopped * 10.0 ** draw.uniform(-2.5, 1.0, count)
        relative = (velocities[:, 1] if moving == 2 else 0.0) - velocities[:, 0]
        fastest = np.max(np.linalg.norm(np.concatenate([relative[:, None], spins * radii], axis=1), axis=2), axis=1)
        slower = np.minimum(1.0, FASTEST * speed / fastest)[:, None]
        velocities, spins, relative = velocities * slower[:, None], spins * slower[:, None], relative * slower
        change = (-speed - np.sum(normal * relative, axis=1))[:, None] * normal
        if moving == 2:
            velocities[:, 1] += change
        else:
            velocities[:, 0] -= change
        found = collide_pair(scene, normal, velocities, spins, rtol=RTOL, engine="taylor")
        outcome = found.outcome.values
        outcomes += Counter({-1: "refused", 0: "stick", 1: "stick-rotate-separate", 2: "bounce"}[k] for k in outcome)
        refused += [str(why) for why in found.reason.values if why]
        ended = outcome >= 0
        before, moved = energies(bodies, velocities, spins), found.velocities.values[:, :moving]
        turned = found.spins.values[:, :moving]
        after = energies(bodies, moved, turned)
        created = max(created, float(np.max((after / before - 1)[ended], initial=-1.0)))
        again = ended[:, None, None]
        velocities, spins = np.where(again, moved, velocities), np.where(again, turned, spins)
    return outcomes, created, refused


def main(count: int = 20, length: int = 100, seed: int = 16) -> int:
    wrong = False
    for kind, partner in product(KINDS, PARTNERS):
        preset, entries = KINDS[kind]
        scene, begun = Scene.load(preset).with_entries({**entries, **PARTNERS[partner]}), time.process_time()
        outcomes, created, refused = chains(scene, count, length, seed)
        took = time.process_time() - begun
        print(f"{kind}, {partner}: {dict(outcomes)}, energy created at most {created:.1e}, {took:.0f} s", flush=True)
        for why, times in Counter(refused).most_common(5):
            print(f"    {times}: {why}")
        wrong |= bool(refused) or created > CREATED
    return int(wrong)


if __name__ == "__main__":
    sys.exit(main(*(int(each) for each in sys.argv[1:4])))
