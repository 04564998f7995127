"""Test vectors of an exported law: impacts and pairs in space, and what this project's engines compute for them."""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....generated.automaton import LAST_ANSWER
from ...collision.space.collide_pair import collide_pair
from ...collision.space.pairs import Bodies
from ...engines.settings import KERNEL_STEPS
from ...engines.taylor.build import kernel
from ...engines.taylor.call import KernelImpacts, task
from ...engines.taylor.layout import ANSWER
from ...errors import ComputationError
from ...many.by_kernel import block_of
from ...many.impacts import Block
from ...scene.scene import Scene
from .kernels import HEAD_ON, IMPACT, Kernel

RTOL = 1e-9
TOLERANCE = 1000 * RTOL
"""Relative difference that a check allows: both errors, of the worst-conditioned vectors that are kept."""
_TIGHTER = 0.01
_CANDIDATES, _WANTED = 512, 64
_DRAWN, _KEPT = 96, 12
_SEED = 17
_DIMENSIONS = (0.7548776662466927, 0.5698402909980532, 0.4301597090019468, 0.3247179572447461)
_RESULTS = (
    "restitution", "tangential_restitution", "slip_restitution", "contact_time", "rotation", "smallest_gap",
    "final_gap", "final_spin", "final_spin_partner", "final_rotation_rate",
)  # fmt: skip


@dataclass(frozen=True)
class Vector:
    """An impact (in the order of `IMPACT`); outcome, `certified` and rebound criterion; the results of `_RESULTS`."""

    impact: tuple[float, ...]
    codes: tuple[int, ...]
    numbers: tuple[float, ...]


def vectors(scene: Scene, kernels: Sequence[Kernel]) -> list[tuple[tuple[float, ...], tuple[float, ...]]]:
    """Fifty impacts, or fewer, with all outcomes among eight times as many candidates (twice without a C compiler).

    Those next to a boundary are left out: their results depend on the tolerance.
    """
    result: list[Vector] = []
    for impacts in _impacts(scene):
        oblique = bool(impacts["angle"][0] > 0)
        one_kernel = next(law for law in kernels if (law.prefix != HEAD_ON) == oblique)
        result += _computed(one_kernel, impacts)
    by_outcome = {outcome: [vector for vector in result if vector.codes[0] == outcome] for outcome in range(3)}
    present = [group for group in by_outcome.values() if group]
    if not present:
        raise ComputationError("no impact could be computed for the test vectors, or all are beside a boundary")
    share = -(-_WANTED // len(present))
    chosen = [vector for group in present for vector in group[:share]]
    chosen += [vector for vector in result if vector not in chosen][: max(0, _WANTED - len(chosen))]
    return [(vector.impact, (0, *vector.codes, *vector.numbers)) for vector in chosen]


def _impacts(scene: Scene) -> list[dict[str, np.ndarray]]:
    """Candidates along a low-discrepancy sequence: half of them spinning, some along the line of centres."""
    points = (np.arange(1, _CANDIDATES + 1)[:, None] * np.array(_DIMENSIONS)) % 1.0
    speed = 10 ** (4 * points[:, 0] - 2.5) / scene.stokes_per_speed
    angle = 1.5 * points[:, 1]
    size = 2 * float(scene.material["reduced_radius"])
    spins = np.where(np.arange(_CANDIDATES)[:, None] % 2, 2 * points[:, 2:] - 1, 0.0) * (speed / size)[:, None]
    if scene.pendulum is not None:
        spins[:] = 0.0
    if scene.wall:
        spins[:, 1] = 0.0
    ahead = np.arange(_CANDIDATES) % 16 == 0
    both = {
        "speed": speed,
        "angle": angle,
        "impact_spin": spins[:, 0].copy(),
        "impact_partner_spin": spins[:, 1].copy(),
    }
    still = {"speed": speed, "angle": 0 * angle, "impact_spin": 0 * angle, "impact_partner_spin": 0 * angle}
    return [{k: v[~ahead] for k, v in both.items()}, {k: v[ahead] for k, v in still.items()}]


def _computed(of_law: Kernel, impacts: dict[str, np.ndarray]) -> list[Vector]:
    """The vectors of candidates whose results are the same at a tighter tolerance."""
    library, answers = kernel(of_law.variant), list[Block]()
    spins = {name: values for name, values in impacts.items() if name.endswith("spin")}
    if of_law.scene.wall:
        del spins["impact_partner_spin"]
    candidates = KernelImpacts(of_law.scene, impacts["speed"], impacts["angle"], spins)
    for rtol in (RTOL, _TIGHTER * RTOL):
        block = _by_kernel(library, candidates, rtol)
        partner, spin = block["final_spin_partner"], block["final_spin"]
        block["final_spin_partner"] = np.where(np.isnan(partner), spin, partner)
        if of_law.prefix == HEAD_ON:
            block["final_rotation_rate"] = np.where(block["outcome"] > 0, 0.0, np.nan)
        answers.append(block)
    plain, tight = (np.column_stack([block[name] for name in _RESULTS]) for block in answers)
    codes = [np.column_stack([block[name] for name in ("outcome", "certified", "rebound")]) for block in answers]
    sound = (codes[0] == codes[1]).all(axis=1) & np.logical_and(*(block["answered"] for block in answers))
    sound &= (np.isnan(plain) | (np.abs(plain - tight) <= 0.1 * TOLERANCE * np.abs(tight))).all(axis=1)
    inputs = np.column_stack([impacts[name] for name in IMPACT])
    return [Vector(*(tuple(values[k].tolist()) for values in (inputs, codes[1], tight))) for k in np.flatnonzero(sound)]


def _by_kernel(library: ctypes.CDLL, impacts: KernelImpacts, rtol: float) -> Block:
    answers, scene = np.zeros(impacts.speed.size, ANSWER), impacts.scene
    task(library, impacts, rtol, KERNEL_STEPS, answers).run()
    block = block_of(_RESULTS, answers, impacts)
    separated = answers["outcome"] > 0
    block["final_gap"] = np.where(separated, answers["final_gap"] * scene.liquid.film_thickness, np.nan)
    return block | {"rebound": answers["reversal"], "answered": answers["status"] <= LAST_ANSWER}


def pair_vectors(scene: Scene, members: Sequence[str], results: Sequence[str]) -> list[tuple[list[Any], list[Any]]]:
    """Pairs of all outcomes that occur, away from boundaries, and what they come to: one in four is in a plane.

    Arguments:
        members, results: names of members of `law_pair` and `law_pair_after`, in their order.
    """
    scene_pairs = _pairs(scene)
    normal, velocities, spins = (
        scene_pairs["normal"],
        scene_pairs["velocities"],
        scene_pairs["spins"][:, : 1 if scene.wall else 2],
    )
    pairs, other = (collide_pair(scene, normal, velocities, spins, rtol=accuracy) for accuracy in (RTOL, RTOL / 3))
    rows = {name: pairs[name].values for name in pairs.data_vars}
    sound = (rows["outcome"] == other.outcome.values) & (rows["outcome"] >= 0)
    for name in ("time", "restitution", "velocities", "spins"):
        loose, two = (np.nan_to_num(dataset[name].values.reshape(_DRAWN, -1)) for dataset in (pairs, other))
        sound &= np.abs(loose - two).max(axis=1) <= 0.1 * TOLERANCE * np.abs(loose).max(axis=1)
    chosen = [k for outcome in range(3) for k in np.flatnonzero(sound & (rows["outcome"] == outcome))[:_KEPT]]
    if not chosen:
        raise ComputationError("no pair in space could be computed for the test vectors")
    numbers = {**rows, "status": np.zeros(_DRAWN, int)}
    return [([scene_pairs[name][k] for name in members], [numbers[name][k] for name in results]) for k in chosen]


def _pairs(scene: Scene) -> dict[str, np.ndarray]:
    draw = np.random.default_rng(_SEED)
    normal = _directions(draw, (_DRAWN,))
    speed = 10 ** draw.uniform(-1.5, 1.5, _DRAWN)[:, None] / scene.stokes_per_speed
    radius = float(scene.material["reduced_radius"]) if scene.wall else min(Bodies.of(scene).radius)
    drift = speed * draw.normal(size=(_DRAWN, 3))
    across = np.cross(normal, _directions(draw, (_DRAWN,)))
    relative = speed * (draw.uniform(0, 3, (_DRAWN, 1)) * across - normal)
    spins = speed[:, None] / radius * draw.uniform(0, 1, (_DRAWN, 2, 1)) * _directions(draw, (_DRAWN, 2))
    planar = np.arange(_DRAWN) % 4 == 0
    axis = np.cross(normal, across)[:, None]
    spins[planar] = np.sum(spins * axis, axis=-1, keepdims=True)[planar] * axis[planar]
    if scene.wall:
        spins[:, 1] = 0.0
    return {"normal": normal, "velocities": np.stack([drift, drift + relative], axis=1), "spins": spins}


def _directions(draw: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    drawn = draw.normal(size=(*shape, 3))
    return np.asarray(drawn / np.linalg.norm(drawn, axis=-1, keepdims=True))
