"""Certified sticks of spinning collisions, followed without certificates: none may separate.

    python -m tests.benchmarks.spinning_sticks [STICKS] [SEED] [BY_CASADI]

For every kind (equal spheres, unequal ones, walls; bridge, attraction, both or a film alone; both lever arms and shear
laws) STICKS (2,000) random sticks that the kernel certifies, from random collisions about the preset: any angles, zero
too, spins of any sign, some without angular momentum. A kernel from which certificates are taken follows them. Then
BY_CASADI (STICKS) sticks for CasADi's certificates, each asked alone at every event of trajectories that are followed
without. A line per kind and certificate; status 1 where what is called a stick separates.
"""

# ruff: noqa: T201 -- a script that prints
import contextlib
import ctypes
import sys
from collections.abc import Iterator
from copy import copy
from itertools import product
from typing import Any

import numpy as np
from wetdoublet.generated.automaton import LAST_ANSWER, Status
from wetdoublet.solvers import Scene
from wetdoublet.solvers.certificates import NoCertificate, OrbitalMomentumCertificate, at_maximum
from wetdoublet.solvers.engines.settings import RTOL, Budget
from wetdoublet.solvers.engines.taylor.call import Impacts, bind_kernel, run_kernel, variant_for_many
from wetdoublet.solvers.engines.taylor.headers import headers
from wetdoublet.solvers.engines.taylor.layout import ANSWER
from wetdoublet.solvers.engines.taylor.source import FLAGS, source
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.host.compiler import library
from wetdoublet.solvers.host.user_cache import loaded
from wetdoublet.solvers.many.batch import Batch, batch
from wetdoublet.solvers.many.by_kernel import impacts_of
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.model.phases import Phase
from wetdoublet.solvers.verify.audit import LONG, WithoutCertificate

from .atlas_random import SCALED

FOLLOWED = 3000  # steps of a certified stick
TAKEN = {  # lines of the kernel that consult certificates, and what they become
    "#if LEAPS\n        unsigned leaps": "        proved = 0;\n#if LEAPS\n        unsigned leaps",
    "sticks |= proved_underway(&l, &f, q->rtol);": "sticks = splat_mask(0);",
}
HAMAKER = 1e-18
BRIDGED, ALONE = "granulation", "granulation-dry-bridge"
KINDS: dict[str, tuple[str, dict[str, float | str]]] = {
    "bridge": (BRIDGED, {}),
    "constant bridge, shear to the film's edge": (BRIDGED, {"bridge.law": "constant", "model.tangential": "film"}),
    "attraction": (ALONE, {"attraction.hamaker": HAMAKER}),
    "bridge and attraction": (BRIDGED, {"attraction.hamaker": HAMAKER}),
    "film": (ALONE, {}),
    "film, shear to its edge": (ALONE, {"model.tangential": "film"}),
}
PARTNERS = ("", "pair", "wall")
STOKES, STEEPEST, ALONG = (1e-3, 3.0), 85.0, 0.2  # and the share of theta0 = 0
SURFACE = (1e-2, 1e2)  # surface speed of a spin over v0
BALANCED = 0.3  # share without angular momentum; of a film alone, all, since others separate
BUDGET = 20_000  # steps of a trajectory by CasADi
ROUND, MOST = 4096, 50  # collisions at a time, and most times
SPINS = ("impact_spin", "impact_partner_spin")


Round = tuple[Batch, Impacts]


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


def rounds(kind: str, partner: str, seed: int) -> Iterator[Round]:
    """Random spinning collisions of a kind: without their spins as a batch, and with them as impacts."""
    draw = np.random.default_rng((seed, *map(ord, kind + partner)))
    preset, entries = KINDS[kind]
    while True:
        scene = Scene.load(preset).with_entries(entries)
        if partner == "wall":
            scene = scene.with_entries({"partner.wall": True})
        elif partner == "pair":
            size = float(np.exp(draw.uniform(-1.5, 1.5)))
            scene = scene.with_entries({"partner.radius": 2 * scene.reduced_radius * size, "partner.density": 2500.0})
        yield _round(draw, scene, alone=kind.startswith("film"))


def _round(draw: np.random.Generator, scene: Scene, alone: bool) -> Round:
    columns = {
        entry: float(value) * 5.0 ** draw.uniform(-1.0, 1.0, ROUND)
        for entry in SCALED
        if isinstance(value := scene.entries.get(entry), float) and entry != "bridge.volume"
    }
    columns["particles.dry_restitution"] = draw.uniform(0.2, 1.0, ROUND)
    columns["impact.stokes"] = np.exp(draw.uniform(*np.log(STOKES), ROUND))
    columns["impact.angle"] = np.radians(draw.uniform(0.0, STEEPEST, ROUND)) * (draw.uniform(size=ROUND) > ALONG)
    request = batch(scene, columns, RTOL, "taylor", ())
    found, sound = impacts_of(request)
    size, balanced = found.angle.size, draw.uniform(size=found.angle.size) < BALANCED
    balanced |= alone
    a = found.others["reduced_radius"]
    ratio, share = (
        (1.0, 1.0) if scene.wall else (found.others.get(name, 1.0) for name in ("radius_ratio", "mass_ratio"))
    )
    first, second = (a, a) if scene.wall else (a * (1 + ratio) / ratio, a * (1 + ratio))

    def spins(radius: np.ndarray) -> np.ndarray:
        rate: np.ndarray = np.exp(draw.uniform(*np.log(SURFACE), size)) * found.speed / radius
        return rate * draw.choice([-1.0, 1.0], size)

    more = {"impact_spin": spins(first)}
    if not scene.wall:
        distance = first + second + found.others["film_thickness"]
        orbit = distance**2 * found.speed * np.tan(found.angle) / (first + second)  # over the reduced mass
        one, other = 0.4 * (1 + share) / share * first**2, 0.4 * (1 + share) * second**2
        if scene.pair:
            more["impact_partner_spin"] = np.where(
                balanced, -(orbit + one * more["impact_spin"]) / other, spins(second)
            )
        else:
            more["impact_spin"] = np.where(balanced & (orbit > 0), -orbit / (one + other), more["impact_spin"])
    kept = request.part(np.flatnonzero(sound))
    return kept, Impacts(found.scene, found.speed, found.angle, {**found.others, **more})


def by_kernel(kind: str, partner: str, sticks: int, seed: int) -> tuple[int, int, int, int]:
    """Collisions, certified sticks, those decided at initial contact, and how many of them separate."""
    done = certified = touch = escaped = 0
    for count, (_, these) in enumerate(rounds(kind, partner, seed)):
        made = run_kernel(these, RTOL)
        assert made is not None, "there is no kernel here"
        decided = (made["status"] <= LAST_ANSWER) & (made["outcome"] == 0)
        proved = np.flatnonzero(decided & these.oblique)[: sticks - certified]
        done += these.angle.size
        certified += proved.size
        touch += int((made["status"][proved] == Status.PROVED_AT_TOUCH).sum())
        escaped += separated(these.part(proved))
        if certified >= sticks or count >= MOST or (count > 2 and not certified):
            break
    return done, certified, touch, escaped


def scene_of(request: Batch, these: Impacts, k: int) -> Scene:
    """A collision of a round as a scene with its impact."""
    names = SPINS if request.scene.pair else SPINS[:1]
    spins = {f"impact.{name.removeprefix('impact_')}": float(these.others[name][k]) for name in names}
    return request.scene_of(k).with_entries(spins).with_impact(speed=float(these.speed[k]), angle=float(these.angle[k]))


def by_casadi(kind: str, partner: str, sticks: int, seed: int) -> dict[str, list[int]]:
    """How many trajectories each certificate calls sticks somewhere on their way, and how many of these separate.

    Every certificate is asked alone, at every event of a trajectory that is followed without certificates.
    """
    found: dict[str, list[int]] = {}
    asked = 0
    for count, (request, these) in enumerate(rounds(kind, partner, seed)):
        for k in range(these.angle.size):
            scene = scene_of(request, these, k)
            n = nondimensionalise(scene, *scene.need_impact())
            model = load(select_model(scene, n.oblique))
            one = WithoutCertificate(model, n.groups, RTOL, budget=Budget(BUDGET))
            proofs, states = list(_alone(one.proof)), [(one.y, one.phase)]
            with contextlib.suppress(ComputationError):  # it chatters, or creeps, without end
                one.on(LONG)
            phases = [step.phase for step in one.path.steps[1:]]
            states += list(zip(one.path.ends, phases, strict=False))
            states += [] if one.path.separated else [(one.y, one.phase)]
            proved = {type(proof).__name__ for proof in proofs if _holds(proof, states)}
            asked += bool(proved)
            for name in proved:
                tally = found.setdefault(name, [0, 0])
                tally[0] += 1
                tally[1] += one.path.separated
            if asked >= sticks or count * ROUND + k > MOST * sticks:
                return found
    return found


def _alone(proof: Any) -> Iterator[Any]:
    """Each certificate of a model without the others."""
    while proof.beside is not None:
        if isinstance(proof, OrbitalMomentumCertificate) and not proof.theorem:
            break  # the others are not asked
        one = copy(proof)
        one.beside = NoCertificate()
        yield one
        proof = proof.beside
    yield proof


def _holds(proof: Any, states: list[tuple[np.ndarray, Phase]]) -> bool:
    """True if a certificate decides a stick at one of these states."""
    maxima: list[np.ndarray] = []
    for y, phase in states:
        if at_maximum(y, phase):
            maxima.append(y)
        if proof.decided(y, phase, maxima) or (isinstance(proof, OrbitalMomentumCertificate) and proof.holds(y)):
            return True
    return False


def main() -> int:
    """Every kind."""
    given = dict(enumerate(map(int, sys.argv[1:])))
    sticks, seed = given.get(0, 2_000), given.get(1, 1)
    few, wrong = given.get(2, sticks), 0
    for kind, partner in product(KINDS, PARTNERS):
        name = f"{kind}{partner and ', '}{partner}"
        done, certified, touch, escaped = by_kernel(kind, partner, sticks, seed)
        print(f"{name}: {done} collisions, {certified} certified ({touch} at contact), {escaped} separate", flush=True)
        wrong += escaped
        for proof, (count, apart) in sorted(by_casadi(kind, partner, few, seed).items() if few else ()):
            print(f"    {proof}: {count} called sticks, {apart} separate", flush=True)
            wrong += apart
    return min(1, wrong)


if __name__ == "__main__":
    sys.exit(main())
