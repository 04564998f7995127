"""Pairs of sizes made from one scene: each a scene of its own, collided together in one call of the kernel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...generated.automaton import BOUNCE, LAST_ANSWER, OUTCOMES
from ..collision.collide import collide
from ..engines.taylor.call import Impacts, run_kernel
from ..errors import ComputationError
from ..host.cores import usable_cores
from ..scene.scene import Scene
from ..scene.schema import MEETING
from ..settings import FEW, KERNEL_STEPS

FIXED, PROPORTIONAL = FILMS = ("fixed", "proportional")
STICK = 0  # label of every stick
UNDECIDED = -1
BOUNCES = OUTCOMES.index(BOUNCE)
STEEPEST = math.acos(4e-5)  # rad; more oblique impacts are beyond what the kernel takes
_BUDGET = 20_000  # steps of a collision that only locates a change
_EVENTS, _CRITERIA = 1000, 10  # the label's parts
_OF_SPHERES = tuple(
    f"{table}.{key}"
    for table in ("particles", "partner")
    for key in ("reduced_radius", "radius", "diameter", "reduced_mass", "mass", "density")
)


@dataclass(frozen=True)
class Struck:
    """Collisions of a request: a label of what happened, e_n and e_t (0 for sticks), and which were undecided.

    The label is 0 for a stick and -1 for an undecided collision; others have the same one if the outcome is the same,
    and of bounces the first rebound criterion, the number of events, and whether it is met at initial contact.
    """

    label: np.ndarray
    restitution: np.ndarray
    tangential: np.ndarray


def outcome_of(label: np.ndarray) -> np.ndarray:
    """The outcome's number from a label that is not undecided."""
    found: np.ndarray = label // (_EVENTS * _CRITERIA * 2)
    return found


@dataclass(frozen=True)
class Pairs:
    """Pairs of particles, and the quantities in which they differ (SI, one per pair).

    Example:
        >>> from wetdoublet.solvers import Scene
        >>> Pairs.of([Scene.load("granulation")]).size
        1
    """

    scenes: tuple[Scene, ...]
    columns: dict[str, np.ndarray]

    @classmethod
    def of(cls, scenes: Sequence[Scene]) -> Pairs:
        """The pairs of these scenes, which have the same entries with other values."""
        values = {name: np.array([one.material[name] for one in scenes]) for name in scenes[0].material}
        return cls(tuple(scenes), {name: column for name, column in values.items() if np.any(column != column[0])})

    @property
    def size(self) -> int:
        return len(self.scenes)

    def part(self, which: slice) -> Pairs:
        """Some of the pairs; what does not differ between them stays a column, so that the kernel is the same."""
        return Pairs(self.scenes[which], {name: column[which] for name, column in self.columns.items()})

    def collide(
        self, pair: np.ndarray, speed: np.ndarray, angle: np.ndarray, rtol: float, locating: bool = False
    ) -> Struck:
        """Collisions of pairs (by index) at relative speeds (m/s) and angles (rad).

        Arguments:
            locating: leave collisions undecided that take long.

        Beyond STEEPEST the normal speed before is so small that the one after no longer depends on it: it is that of a
        collision at STEEPEST.

        Raises:
            ComputationError: there is no compiled kernel.
        """
        others = {name: column[pair] for name, column in self.columns.items()}
        within = np.minimum(angle, STEEPEST)
        impacts = Impacts(self.scenes[0], speed * np.cos(within), within, others)
        threads = usable_cores() if angle.size > FEW else 1
        found = run_kernel(impacts, rtol, threads=threads, budget=_BUDGET if locating else KERNEL_STEPS, jumps=1)
        if found is None:
            raise ComputationError(
                "averages need the compiled kernel, which this scene or machine does not have",
                advice="install a C compiler, or see `wetdoublet compile`",
            )
        outcome = found["outcome"].astype(np.int64)
        events = np.where(outcome == BOUNCES, np.minimum(found["events"], _EVENTS - 1), 0)
        label = ((outcome * _CRITERIA + found["reversal"] + 1) * _EVENTS + events) * 2
        label = np.where(outcome > 0, label + (found["smallest_gap"] >= 1), STICK)
        decided = found["status"] <= LAST_ANSWER
        struck = Struck(
            np.where(decided, label, UNDECIDED),
            np.where(outcome > 0, found["shown"][:, 0] * (np.cos(within) / np.cos(angle)), 0.0),
            np.where(outcome > 0, found["shown"][:, 1], 0.0),
        )
        for k in np.flatnonzero(~decided).tolist() if not locating else ():
            self._alone(struck, k, int(pair[k]), float(impacts.speed[k]), float(within[k]), rtol)
        return struck

    def _alone(self, struck: Struck, k: int, pair: int, speed: float, angle: float, rtol: float) -> None:
        """Complete a collision that the kernel has not decided by another engine; NaN where none does."""
        struck.restitution[k] = struck.tangential[k] = np.nan
        try:
            one = collide(self.scenes[pair], speed=speed, angle=angle, rtol=rtol, engine="rosenbrock", ledger=False)
        except ComputationError:
            return
        struck.label[k] = OUTCOMES.index(one.outcome) * _CRITERIA * _EVENTS * 2
        struck.restitution[k], struck.tangential[k] = one.restitution, one.tangential_restitution or 0.0


def scene_of_sizes(scene: Scene, radius: float, partner_radius: float | None, films: str) -> Scene:
    """The scene of spheres of these radii (m), of the same materials; None beside a wall.

    Densities are those of the scene's spheres. With `films` proportional the film and the roughness grow with the sum
    of the radii, each coating with its sphere's, and a volume in m^3 with the cube of the sum.

    Raises:
        InputError: entries that do not fit together at this size.
    """
    entries = {name: value for name, value in scene.entries.items() if name not in (*_OF_SPHERES, *MEETING)}
    own = 2 * scene.particles.reduced_radius
    other = own if scene.partner is None or scene.partner.radius is None else scene.partner.radius
    sphere = 4 / 3 * math.pi
    entries |= {"particles.radius": radius, "particles.density": 2 * scene.particles.reduced_mass / (sphere * own**3)}
    growth = radius / own
    if partner_radius is not None:
        mass = 2 * scene.particles.reduced_mass
        mass = mass if scene.partner is None or scene.partner.mass is None else scene.partner.mass
        entries |= {"partner.radius": partner_radius, "partner.density": mass / (sphere * other**3)}
        growth = (radius + partner_radius) / (own + other)
    if films == PROPORTIONAL:
        coating = entries.get("liquid.coating_thickness")
        if isinstance(coating, float):
            if partner_radius is not None:
                its = entries.get("partner.coating_thickness", coating)
                entries["partner.coating_thickness"] = float(its) * partner_radius / other
            entries["liquid.coating_thickness"] = coating * radius / own
        for name in ("liquid.film_thickness", "particles.roughness"):
            if name in entries:
                entries[name] = float(entries[name]) * growth
        if scene.ways.volume == "absolute":
            entries["bridge.volume"] = float(entries["bridge.volume"]) * growth**3
    given = {name: scene.as_given(name, value) for name, value in entries.items()}
    return Scene(scene.name, tuple(given.items()), package=scene.package)
