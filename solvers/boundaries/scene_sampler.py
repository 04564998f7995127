"""Samples for boundaries: outcomes and margins of collisions, by the kernel or one by one by Rosenbrock."""

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from ...generated.automaton import BOUNCE, KINDS, OUTCOMES, ROTATE, STICK, Purpose
from ..engines.casadi.locate import CHATTERS, EventLocator
from ..engines.choice import collision_engine
from ..engines.settings import KERNEL_STEPS
from ..errors import ComputationError, InputError
from ..model.dimensionless import nondimensionalise
from ..model.model import load, select_model
from ..scene.contact import GAPS, NEVER_MET
from ..scene.groups import formulas, si_values
from ..scene.scene import Scene
from .by_kernel import SAMPLE_BUDGET, sample_by_kernel
from .samples import SAMPLE

BY_KERNEL, BY_ROSENBROCK = 100, 10  # initial samples of a line per decade of the Stokes number
_SHARE, _EVERY = 32, 16  # parts (1/n) of the steps for all first samples, and of their chatter that gets all steps
_ROW = 33  # as many in a row fail a line, whatever collisions with a larger budget decide among them
_MARGIN = 500  # most steps of a trajectory for a margin; one that creeps longer has none
DEEP = 1e-3  # relative to the contact gap; an approach to this depth has reached solid contact
_STICK, _ROTATE, _BOUNCE = map(OUTCOMES.index, (STICK, ROTATE, BOUNCE))


@dataclass
class SceneSampler:
    """Sampler of a scene's collisions. Counts the integrated ones, and stores the reasons of failures.

    Arguments:
        rtol: relative tolerance of the integrations.
        kernel: use the Taylor kernel; None: if it supports the scene.
        creeping: number of creeping collisions that the kernel left unfinished, by angle.
        untried: angles and Stokes numbers of chatter that is left undecided after a part of the steps.
    """

    scene: Scene
    rtol: float
    kernel: bool | None = None
    collisions: int = field(default=0, init=False)
    reasons: dict[tuple[float, float], str] = field(default_factory=dict, init=False)
    creeping: Counter[float] = field(default_factory=Counter, init=False)
    untried: set[tuple[float, float]] = field(default_factory=set, init=False)

    def __post_init__(self) -> None:
        """Determine once whether the kernel supports the scene."""
        self.kernel = collision_engine(self.scene) == "taylor" if self.kernel is None else self.kernel

    @property
    def per_decade(self) -> int:
        """Initial samples of a line per decade of the Stokes number."""
        return BY_KERNEL if self.kernel else BY_ROSENBROCK

    def __call__(self, angle: np.ndarray, stokes: np.ndarray, first: bool = False) -> np.ndarray:
        """An array of SAMPLE at angles (rad) and Stokes numbers; outcome -1 where a collision fails.

        Arguments:
            first: these are the initial samples of lines, each ascending; spare steps where they show that it fails.
        """
        samples = self._by_kernel(angle, stokes, first) if self.kernel else None
        if samples is None:
            self.kernel = False
            samples = self.by_rosenbrock(angle, stokes)
        return samples

    def by_rosenbrock(self, angle: np.ndarray, stokes: np.ndarray) -> np.ndarray:
        """Samples as by `__call__`, by Rosenbrock one by one (slow); the reasons of failures are added to `reasons`."""
        samples = blank(stokes)
        for k, at in enumerate(zip(angle.tolist(), stokes.tolist(), strict=True)):
            try:
                n = nondimensionalise(self.scene, self.scene.speed_of(at[1]), at[0])
                model = load(select_model(self.scene, n.oblique))
                path = EventLocator(model, n.groups, self.rtol, machine_code=True).run()
            except (ComputationError, InputError) as error:
                self.reasons[at] = str(n.in_si(error) if isinstance(error, ComputationError) else error)
                continue
            self.collisions += path.time > 0
            reversal = -1 if path.reversal is None else KINDS.index(path.reversal)
            for name, value in (("outcome", OUTCOMES.index(path.outcome)), ("reversal", reversal),
                                ("events", len(path.kinds))):  # fmt: skip
                samples[name][k] = value
            if path.separated:
                samples["restitution"][k] = path.model.values("outputs", path.y, path.p)["restitution"]
                samples["time"][k] = path.time
        return samples

    def outcomes(self, angle: np.ndarray, stokes: np.ndarray, kernel_only: bool = False) -> np.ndarray:
        """Outcomes (`outcome`, -1 where none is computed) and first rebound criteria met (`reversal`) only.

        A collision may take all steps of the budget. Chatter that exhausts the kernel's steps is not continued; other
        collisions that the kernel does not complete go to Rosenbrock.

        Arguments:
            kernel_only: leave collisions undecided that the kernel does not complete with the steps of a sample.
        """
        budget = SAMPLE_BUDGET if kernel_only else KERNEL_STEPS
        records = self._records(angle, stokes, budget) if self.kernel else None
        if records is None:
            return self.by_rosenbrock(angle, stokes)
        for k in [] if kernel_only else np.flatnonzero(records["outcome"] < 0).tolist():
            if records["chatters"][k]:
                n = nondimensionalise(self.scene, self.scene.speed_of(float(stokes[k])), float(angle[k]))
                self.reasons[float(angle[k]), float(stokes[k])] = (
                    f"{CHATTERS}: {KERNEL_STEPS} steps do not decide the outcome, {records['events'][k]} events by "
                    f"t = {records['time'][k] * n.time:.6g} s, now at a gap of "
                    f"{records['final_gap'][k] * n.length:.6g} m; try another --rtol, or a collision further off"
                )
            else:
                sample = self.by_rosenbrock(angle[k : k + 1], stokes[k : k + 1])[0]
                records["outcome"][k], records["reversal"][k] = sample["outcome"], sample["reversal"]
        return records

    def reason(self, angle: float, low: float, high: float) -> str:
        """The reason why a collision at an angle and between two Stokes numbers failed."""
        reasons = (text for (at, stokes), text in self.reasons.items() if at == angle and low <= stokes <= high)
        return next(reasons, "no collision could be computed")

    def _records(self, angle: np.ndarray, stokes: np.ndarray, budget: int, first: bool = False) -> np.ndarray | None:
        steps, speed = budget // _SHARE if first else budget, stokes / self.scene.stokes_per_speed
        records = sample_by_kernel(self.scene, speed, angle, self.rtol, budget=steps)
        if records is not None:
            if first:
                self._finish(records, angle, stokes, budget)
            self.collisions += int(np.count_nonzero(~records["at_touch"]))
            self.creeping.update(angle[records["creeps"]].tolist())
        return records

    def _finish(self, records: np.ndarray, angle: np.ndarray, stokes: np.ndarray, budget: int) -> None:
        """Run collisions of lines again that a part of the steps left undecided, with all steps.

        Of each run of them along a line these are both ends and one in _EVERY. Between the first and the last that
        still chatter only _ROW in the middle are added, unless one there does not.
        """
        left = records["creeps"] | records["chatters"]
        which, wanted = np.flatnonzero(left), np.zeros(left.size, dtype=bool)
        parts = np.split(which, 1 + np.flatnonzero((np.diff(which) > 1) | (np.diff(stokes[which]) < 0)))
        for part in parts:
            wanted[part[::_EVERY]] = wanted[part[-1:]] = True
        while wanted.any():
            speed = stokes[wanted] / self.scene.stokes_per_speed
            again = sample_by_kernel(self.scene, speed, angle[wanted], self.rtol, budget=budget)
            assert again is not None  # the kernel is available
            records[wanted] = again
            left &= ~wanted
            wanted, chatters = left.copy(), ~left & records["chatters"] & (records["outcome"] < 0)
            for part in parts:
                still = part[chatters[part]]
                if still.size and (left | chatters)[still[0] : still[-1]].all():
                    inside = part[(still[0] < part) & (part < still[-1])]
                    wanted[inside[abs(inside - (still[0] + still[-1]) // 2) > _ROW // 2]] = False
        records["creeps"] &= ~left
        self.untried.update(zip(angle[left].tolist(), stokes[left].tolist(), strict=True))

    def _by_kernel(self, angle: np.ndarray, stokes: np.ndarray, first: bool) -> np.ndarray | None:
        """Samples by the kernel; sticks are continued until they fall back, None if the kernel does not run."""
        records = self._records(angle, stokes, SAMPLE_BUDGET, first)
        if records is None:
            return None
        samples, speed, outcome = blank(stokes), stokes / self.scene.stokes_per_speed, records["outcome"]
        for name in ("outcome", "reversal", "events", "restitution", "time"):
            samples[name] = records[name]
        if self.scene.package is not None and self.scene.package.events:
            return samples  # no margin is smooth where a declared event may come first
        contact = contact_gap_at(self.scene, speed)
        samples["criterion"] = np.where(outcome == _ROTATE, _margin(records, contact), np.nan)
        samples["time"][outcome == _STICK] = np.nan
        sticks = np.flatnonzero((outcome == _STICK) & ~records["at_touch"])
        if sticks.size:
            ends = sample_by_kernel(self.scene, speed[sticks], angle[sticks], self.rtol, Purpose.ESCAPE, budget=_MARGIN)
            if ends is not None:
                samples["reach"][sticks] = np.where(ends["outcome"] == _STICK, ends["final_gap"], np.nan)
        which = np.flatnonzero(outcome == _BOUNCE)
        if which.size:  # repeated with solids that are met far below the contact gap
            bare_quantities = {name: np.full(which.size, value) for name, value in NEVER_MET.items()}
            bare_quantities["roughness"] = DEEP * contact[which] * self.scene.liquid.film_thickness
            bare = sample_by_kernel(
                self.scene, speed[which], angle[which], self.rtol, Purpose.APPROACH, bare_quantities, _MARGIN
            )
            if bare is not None:
                samples["criterion"][which] = np.where(bare["outcome"] >= 0, _margin(bare, contact[which]), np.nan)
        return samples


def blank(stokes: np.ndarray) -> np.ndarray:
    """Samples at Stokes numbers, without outcomes and margins yet."""
    samples = np.zeros(stokes.size, SAMPLE)
    samples["stokes"] = stokes
    samples["outcome"] = samples["reversal"] = -1
    samples["time"] = samples["criterion"] = samples["reach"] = np.nan
    return samples


def contact_gap_at(scene: Scene, speed: np.ndarray) -> np.ndarray:
    """Gap of solid contact over x0, by normal speed (m/s): the larger of elastic and roughness gap; 0 without both."""
    values = {**si_values(scene, None, None), "speed": speed}
    gap = np.zeros(speed.size)
    for group in GAPS.values():
        formula, arguments = formulas(scene)[group]
        # a criterion whose quantities the scene does not give is never met
        if all(argument in values for argument in arguments):
            gap = np.maximum(gap, formula(*(values[argument] for argument in arguments)))
    return gap


def _margin(records: np.ndarray, contact: np.ndarray) -> np.ndarray:
    """Logarithm by which the approach passes the nearest rebound criterion, positive if met; NaN if there is none."""
    approached = (records["outcome"] >= 0) & ~records["at_touch"]
    log_contact = np.full(contact.size, -np.inf)
    has_contact = approached & (contact > 0)
    log_contact[has_contact] = np.log(contact[has_contact] / records["smallest_gap"][has_contact])
    return np.where(approached, np.maximum(records["glass"], log_contact), np.nan)
