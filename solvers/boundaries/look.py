"""Samples for boundaries: outcomes and margins of collisions, by the kernel or one by one by Rosenbrock."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from ...generated.automaton import KINDS, OUTCOMES, Purpose
from ..engines.casadi.locate import CHATTERS, EventLocator
from ..engines.choice import collision_engine
from ..errors import ComputationError, InputError
from ..model.dimensionless import nondimensionalise
from ..model.model import load, select_model
from ..scene.contact import GAPS, NEVER_MET
from ..scene.groups import formulas, si_values
from ..scene.scene import Scene
from ..settings import KERNEL_STEPS
from . import by_kernel
from .samples import SAMPLE

BY_KERNEL, BY_ROSENBROCK = 100, 10  # initial samples of a line per decade of the Stokes number
_MARGIN = 500  # steps of a trajectory for a margin; one that creeps longer has none
DEEP = 1e-3  # relative to the contact gap; an approach to this depth has reached solid contact


@dataclass
class Look:
    """Sampler of a scene's collisions. Counts the integrated ones, and stores the reasons of failures.

    Arguments:
        rtol: relative tolerance of the integrations.
        kernel: use the Taylor kernel; default: if it supports the scene.
    """

    scene: Scene
    rtol: float
    kernel: bool | None = None
    collisions: int = field(default=0, init=False)
    reasons: dict[tuple[float, float], str] = field(default_factory=dict, init=False)
    creeping: Counter[float] = field(default_factory=Counter, init=False)  # not completed by the kernel, by angle

    def __post_init__(self) -> None:
        """Determine once whether the kernel supports the scene."""
        self.kernel = collision_engine(self.scene) == "taylor" if self.kernel is None else self.kernel

    @property
    def per_decade(self) -> int:
        """Initial samples of a line per decade of the Stokes number."""
        return BY_KERNEL if self.kernel else BY_ROSENBROCK

    def __call__(self, angle: np.ndarray, stokes: np.ndarray) -> np.ndarray:
        """An array of SAMPLE at angles (rad) and Stokes numbers; outcome -1 where a collision fails."""
        found = self._by_kernel(angle, stokes) if self.kernel else None
        if found is None:
            self.kernel = False
            found = self.by_rosenbrock(angle, stokes)
        return found

    def by_rosenbrock(self, angle: np.ndarray, stokes: np.ndarray) -> np.ndarray:
        """The same by Rosenbrock, one by one (slow); `reasons` has the reasons of failures."""
        found = blank(stokes)
        for k in range(stokes.size):
            self._by_rosenbrock(found[k : k + 1], float(angle[k]))
        return found

    def outcomes(self, angle: np.ndarray, stokes: np.ndarray, kernel_only: bool = False) -> np.ndarray:
        """Outcomes (`outcome`, -1 for none, with its reason) and first rebound criteria met (`reversal`) alone.

        A collision may take all steps of the budget. Chatter that exhausts the kernel's steps is not continued; other
        collisions that the kernel does not complete go to Rosenbrock.

        Arguments:
            kernel_only: leave collisions undecided that the kernel does not complete with the steps of a sample.
        """
        told = (
            self._told(angle, stokes, by_kernel.LOOK_BUDGET if kernel_only else KERNEL_STEPS) if self.kernel else None
        )
        if told is None:
            return self.by_rosenbrock(angle, stokes)
        if kernel_only:
            return told
        for k in np.flatnonzero(told["chatters"] & (told["outcome"] < 0)).tolist():
            self._give_up(float(angle[k]), float(stokes[k]), told[k])
        for k in np.flatnonzero((told["outcome"] < 0) & ~told["chatters"]).tolist():
            found = self.by_rosenbrock(angle[k : k + 1], stokes[k : k + 1])[0]
            told["outcome"][k], told["reversal"][k] = found["outcome"], found["reversal"]
        return told

    def _give_up(self, angle: float, stokes: float, told: np.void) -> None:
        n = nondimensionalise(self.scene, self.scene.speed_of(stokes), angle)
        self.reasons[angle, stokes] = (
            f"{CHATTERS}: {KERNEL_STEPS} steps do not decide the outcome, {told['events']} events by "
            f"t = {told['time'] * n.time:.6g} s, "
            f"now at a gap of {told['final_gap'] * n.length:.6g} m; try another --rtol, or a collision further off"
        )

    def reason(self, angle: float, low: float, high: float) -> str:
        """The reason why a collision at an angle and between two Stokes numbers failed."""
        said = (text for (at, stokes), text in self.reasons.items() if at == angle and low <= stokes <= high)
        return next(said, "no collision could be computed")

    def _told(self, angle: np.ndarray, stokes: np.ndarray, budget: int) -> np.ndarray | None:
        told = by_kernel.looked(self.scene, stokes / self.scene.stokes_per_speed, angle, self.rtol, budget=budget)
        if told is not None:
            self.collisions += int(np.count_nonzero(~told["at_touch"]))
            self.creeping.update(angle[told["creeps"]].tolist())
        return told

    def _whole(self, angle: np.ndarray, stokes: np.ndarray) -> np.ndarray | None:
        speed = stokes / self.scene.stokes_per_speed
        told = self._told(angle, stokes, by_kernel.LOOK_BUDGET)
        if told is None:
            return None
        found = blank(stokes)
        for name in ("outcome", "reversal", "events", "restitution", "time"):
            found[name] = told[name]
        contact = contact_gap_at(self.scene, speed)
        found["criterion"] = np.where(told["outcome"] == 1, _margin(told, contact), np.nan)
        found["reach"] = np.where(told["at_touch"], np.nan, 0.0)
        return found

    def _by_kernel(self, angle: np.ndarray, stokes: np.ndarray) -> np.ndarray | None:
        """Samples by the kernel; sticks are continued until they fall back, bounces repeated without solids."""
        found = self._whole(angle, stokes)
        if found is None:
            return None
        if self.scene.package is not None and self.scene.package.events:
            found["criterion"] = found["reach"] = np.nan  # neither is smooth where a declared event may come first
            return found
        speed = stokes / self.scene.stokes_per_speed
        sticks = np.flatnonzero((found["outcome"] == 0) & ~np.isnan(found["reach"]))
        found["reach"] = np.nan
        found["time"][found["outcome"] == 0] = np.nan
        if sticks.size:
            told = by_kernel.looked(self.scene, speed[sticks], angle[sticks], self.rtol, Purpose.ESCAPE, budget=_MARGIN)
            if told is not None:
                found["reach"][sticks] = np.where(told["outcome"] == 0, told["final_gap"], np.nan)
        bounces = np.flatnonzero(found["outcome"] == 2)
        if bounces.size:
            contact = contact_gap_at(self.scene, speed[bounces])
            told = by_kernel.looked(
                self.scene,
                speed[bounces],
                angle[bounces],
                self.rtol,
                Purpose.APPROACH,
                self.no_solids(contact),
                _MARGIN,
            )
            if told is not None:
                found["criterion"][bounces] = np.where(told["outcome"] >= 0, _margin(told, contact), np.nan)
        return found

    def no_solids(self, contact: np.ndarray) -> dict[str, np.ndarray]:
        """Quantities with which an approach continues far below its contact gaps (x0)."""
        deep = DEEP * contact * self.scene.liquid.film_thickness
        return {name: np.full(contact.size, value) for name, value in NEVER_MET.items()} | {"roughness": deep}

    def _by_rosenbrock(self, found: np.ndarray, angle: float) -> None:
        """Compute one sample."""
        stokes = float(found["stokes"][0])
        try:
            n = nondimensionalise(self.scene, self.scene.speed_of(stokes), angle)
            model = load(select_model(self.scene, n.oblique))
            path = EventLocator(model, n.groups, self.rtol, machine_code=True).run()
        except (ComputationError, InputError) as error:
            self.reasons[angle, stokes] = str(n.in_si(error)) if isinstance(error, ComputationError) else str(error)
            return
        self.collisions += path.time > 0
        found["outcome"] = OUTCOMES.index(path.outcome)
        found["reversal"] = -1 if path.reversal is None else KINDS.index(path.reversal)
        found["events"] = len(path.kinds)
        if path.separated:
            found["restitution"] = path.model.values("outputs", path.y, path.p)["restitution"]
            found["time"] = path.time


def blank(stokes: np.ndarray) -> np.ndarray:
    """Empty samples at Stokes numbers."""
    found = np.zeros(stokes.size, SAMPLE)
    found["stokes"] = stokes
    found["outcome"] = found["reversal"] = -1
    found["time"] = found["criterion"] = found["reach"] = np.nan
    return found


def contact_gap_at(scene: Scene, speed: np.ndarray) -> np.ndarray:
    """Gap over film thickness at which the solids meet, at normal speeds (m/s)."""
    values = {**si_values(scene, None, None), "speed": speed}
    gap = np.zeros(speed.size)
    for name in GAPS.values():
        formula, arguments = formulas(scene)[name]
        if all(argument in values for argument in arguments):
            gap = np.maximum(gap, formula(*(values[argument] for argument in arguments)))
    return gap


def _margin(told: np.ndarray, contact: np.ndarray) -> np.ndarray:
    """Margin of the rebound criteria over the approach, as a logarithm; NaN without an approach."""
    approached = (told["outcome"] >= 0) & ~told["at_touch"]
    solids = np.full(contact.size, -np.inf)
    there = approached & (contact > 0)
    solids[there] = np.log(contact[there] / told["smallest_gap"][there])
    return np.where(approached, np.maximum(told["glass"], solids), np.nan)
