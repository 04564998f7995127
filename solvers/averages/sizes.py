"""Pairs of sizes made from one scene, and their collisions in one call of the kernel."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...generated.automaton import BOUNCE, LAST_ANSWER, OUTCOMES
from ..boundaries.experiment import STEEPEST, UNDECIDED, Experiment, Rows
from ..collision.space.pairs import Bodies
from ..engines.settings import FEW, KERNEL_STEPS
from ..host.workers import usable_cores
from ..many.by_kernel import rates_of
from ..scene.scene import Scene
from ..scene.schema import MEETING

FIXED, PROPORTIONAL = FILMS = ("fixed", "proportional")
BOUNCES = OUTCOMES.index(BOUNCE)
_BUDGET = 20_000  # steps of a collision that only locates a change
_EVENTS, _CRITERIA = 1000, 10  # the label's parts
_OF_SPHERES = tuple(
    f"{table}.{key}"
    for table in ("particles", "partner")
    for key in ("reduced_radius", "radius", "diameter", "reduced_mass", "mass", "density")
)


def experiment_of(scenes: Sequence[Scene], rtol: float) -> Experiment:
    """An experiment with a row for each scene, which have the same entries."""
    first = scenes[0]
    numbers = [name for name, value in first.si if not isinstance(value, str) and name not in MEETING]
    values = {name: np.array([float(scene.entries[name]) for scene in scenes]) for name in numbers}
    columns = {name: row for name, row in values.items() if np.any(row != row[0])}
    return Rows(first, (), columns, len(scenes) if columns else 1, rtol).unchecked(np.zeros(0))


def labels(experiment: Experiment, pair: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """What happens in collisions of pairs (by index) at relative speeds (m/s) and angles (rad), as a number.

    0 is a stick and UNDECIDED a collision that takes long. Others have the same number if the outcome is the same, and
    of bounces the first rebound criterion, the number of events, and whether it is met at initial contact.
    """
    answers = _answers(experiment, pair, speed, angle, _BUDGET)[-1]
    outcome = answers["outcome"].astype(np.int64)
    events = np.where(outcome == BOUNCES, np.minimum(answers["events"], _EVENTS - 1), 0)
    label = ((outcome * _CRITERIA + answers["reversal"] + 1) * _EVENTS + events) * 2 + (answers["smallest_gap"] >= 1)
    return np.where(answers["status"] <= LAST_ANSWER, np.where(outcome > 0, label, 0), UNDECIDED)


def outcome_of(label: np.ndarray) -> np.ndarray:
    """The outcome's number from a label; UNDECIDED stays."""
    return np.where(label == UNDECIDED, UNDECIDED, label // (_EVENTS * _CRITERIA * 2))


def _answers(
    experiment: Experiment, pair: np.ndarray, speed: np.ndarray, angle: np.ndarray, budget: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normal speeds and angles of collisions, and what the kernel answers; ComputationError without a kernel.

    Beyond STEEPEST the normal speed before is so small that the one after no longer depends on it: it is that of a
    collision at STEEPEST.
    """
    within = np.minimum(angle, STEEPEST)
    normal, threads = speed * np.cos(within), usable_cores() if angle.size > FEW else 1
    return normal, within, experiment.answers(pair, normal, within, threads=threads, budget=budget, jumps=1)


def collide(
    experiment: Experiment, pair: np.ndarray, speed: np.ndarray, angle: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Outcomes and results of collisions of pairs (by index) at relative speeds (m/s) and angles (rad).

    Returns:
        The outcomes, UNDECIDED where the kernel does not decide, and (5, collisions), there NaN: e_n and e_t, 0 for
        sticks; (e_n cos(angle))^2; what the energy of rotation gains, over that of the relative motion, and what
        kinetic energy is lost, over the mean of the relative motion's over all angles. A stick rotates as one body.
    """
    normal, within, answers = _answers(experiment, pair, speed, angle, KERNEL_STEPS)
    decided = answers["status"] <= LAST_ANSWER
    outcome = np.where(decided, answers["outcome"], UNDECIDED)
    results = np.where(answers["outcome"] > 0, answers["shown"][:, :2].T, 0.0)
    results[:, ~decided] = np.nan
    results[0] *= np.cos(within) / np.cos(angle)
    rates = rates_of(answers, experiment.impacts(pair, normal, within))
    spins = np.stack([rates["final_spin"], rates["final_spin_partner"]])
    normal_energy = (results[0] * np.cos(angle)) ** 2
    turning, stretch = _turning(experiment, pair, normal, within, outcome, spins)
    sliding = (stretch * np.sin(angle)) ** 2
    lost = (np.cos(angle) ** 2 + sliding * (1 - results[1] ** 2) - normal_energy - turning) / ((1 + stretch**2) / 2)
    return outcome, np.stack([*results, normal_energy, turning, lost])


def _turning(
    experiment: Experiment, pair: np.ndarray, speed: np.ndarray, angle: np.ndarray, outcome: np.ndarray,
    spins: np.ndarray,
) -> tuple[np.ndarray, Any]:  # fmt: skip
    """Gain of the energy of rotation over the energy of the relative motion; of a stick that of the rigid doublet.

    Arguments:
        spins: (2, collisions), after separation, rad/s; of the partner NaN where it is that of the sphere.

    Returns:
        The gain, and the sideways velocity of the centres over that of touching surfaces, 1 + x0/(R_1 + R_2).
    """
    given = {name: values[pair] if values.size > 1 else values[0] for name, values in experiment.columns.items()}
    mass = given["reduced_mass"]
    energy = mass * (speed / np.cos(angle)) ** 2
    before = np.stack([given["impact_spin"] + 0 * angle, given.get("impact_partner_spin", 0.0) + 0 * angle])
    if experiment.scene.wall:  # a stick neither slides nor rolls on
        gained = np.where(outcome > 0, spins[0], 0.0) ** 2 - before[0] ** 2
        return np.asarray(0.4 * mass * given["reduced_radius"] ** 2 * gained / energy), 1.0
    bodies = Bodies.made_of(given)
    inertia, touching = np.stack(bodies.inertia).reshape(2, -1), sum(bodies.radius)
    orbital = mass * (touching + given["film_thickness"]) ** 2
    momentum = orbital * speed * np.tan(angle) / touching + (inertia * before).sum(axis=0)
    after = np.where(np.isnan(spins[1]), spins[0], spins[1])
    apart = (inertia * np.stack([spins[0], after]) ** 2).sum(axis=0)
    together = momentum**2 / (orbital + inertia.sum(axis=0))
    gained = np.where(outcome > 0, apart, together) - (inertia * before**2).sum(axis=0)
    gained = np.where(outcome == UNDECIDED, np.nan, gained / energy)
    return gained, 1 + given["film_thickness"] / touching


def scene_of_sizes(scene: Scene, radius: float, partner_radius: float | None, films: str) -> Scene:
    """The scene of spheres of these radii (m), of the same materials; None beside a wall.

    Densities are those of the scene's spheres. With `films` proportional the film and the roughness grow with the sum
    of the radii, each coating with its sphere's, and a volume in m^3 with the cube of the sum.

    Raises:
        InputError: entries that do not fit together at this size.
    """
    entries = {name: value for name, value in scene.entries.items() if name not in (*_OF_SPHERES, *MEETING)}
    reference = 2 * scene.particles.reduced_radius
    other = reference if scene.partner is None or scene.partner.radius is None else scene.partner.radius
    sphere = 4 / 3 * math.pi
    entries |= {
        "particles.radius": radius,
        "particles.density": 2 * scene.particles.reduced_mass / (sphere * reference**3),
    }
    growth = radius / reference
    if partner_radius is not None:
        mass = 2 * scene.particles.reduced_mass
        mass = mass if scene.partner is None or scene.partner.mass is None else scene.partner.mass
        entries |= {"partner.radius": partner_radius, "partner.density": mass / (sphere * other**3)}
        growth = (radius + partner_radius) / (reference + other)
    if films == PROPORTIONAL:
        coating = entries.get("liquid.coating_thickness")
        if isinstance(coating, float):
            if partner_radius is not None:
                its = entries.get("partner.coating_thickness", coating)
                entries["partner.coating_thickness"] = float(its) * partner_radius / other
            entries["liquid.coating_thickness"] = coating * radius / reference
        for name in ("liquid.film_thickness", "particles.roughness"):
            if name in entries:
                entries[name] = float(entries[name]) * growth
        if scene.ways.volume == "absolute":
            entries["bridge.volume"] = float(entries["bridge.volume"]) * growth**3
    return Scene(
        scene.name, tuple((name, scene.as_given(name, value)) for name, value in entries.items()), package=scene.package
    )


def target(scene: Scene) -> float:
    """The cross-section of collisions of a pair, m^2; beside a wall the part of the speed that is its flux, 1/4."""
    if scene.wall:
        return 0.25
    return math.pi * (sum(Bodies.of(scene).radius) + scene.liquid.film_thickness) ** 2
