"""Samples for boundaries: outcomes, margins and events of collisions by the kernel, many in one call."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ...generated.automaton import BOUNCE, LAST_ANSWER, OUTCOMES, ROTATE, STICK, Purpose, Status
from ..collision.by_kernel import recorded, words_of
from ..engines.settings import KERNEL_STEPS
from ..engines.taylor.call import KernelImpacts
from ..engines.taylor.layout import ANSWER
from ..engines.taylor.record import run_recorded
from ..errors import ComputationError, InputError
from ..model.dimensionless import nondimensionalise
from ..model.model import load, select_model
from ..scene.groups import GAPS, NEVER_MET, formulas, si_values
from ..scene.scene import Scene
from .barrier import Potential
from .samples import SAMPLE, SAMPLE_BUDGET

PER_DECADE = 100  # initial samples of a line per decade of the Stokes number
_SHARE, _EVERY = 32, 16  # parts (1/n) of the steps for all first samples, and of their chatter that gets all steps
_ROW = 33  # as many in a row fail a line, whatever collisions with a larger budget decide among them
_EARLIER = 5  # the last state of chatter is compared with the state after this fraction (1/n) of its steps
_MARGIN = 500  # most steps of a trajectory for a margin; one that creeps longer has none
_DEEP = 1e-3  # relative to the contact gap; an approach to this depth has reached solid contact
_STICK, _ROTATE, _BOUNCE = map(OUTCOMES.index, (STICK, ROTATE, BOUNCE))

Events = list[tuple[str, float]]
"""Events of a collision, their words and times (x0/v0)."""


@dataclass
class SceneSampler:
    """Sampler of a scene's collisions.

    Arguments:
        rtol: relative tolerance of the integrations.

    Attributes:
        collisions: number of integrated collisions.
        undecided: angles and Stokes numbers of collisions that all steps left undecided.
        untried: the same of chatter that was left undecided after a part of the steps.
    """

    scene: Scene
    rtol: float
    collisions: int = field(default=0, init=False)
    undecided: set[tuple[float, float]] = field(default_factory=set, init=False)
    untried: set[tuple[float, float]] = field(default_factory=set, init=False)

    def __call__(self, angle: np.ndarray, stokes: np.ndarray, first: bool = False) -> np.ndarray:
        """An array of SAMPLE at angles (rad) and Stokes numbers; outcome -1 where a collision is not decided.

        Sticks are continued until they fall back, and the approaches of bounces below solid contact, for their margins.

        Arguments:
            first: these are the initial samples of lines, each ascending; spare steps where they show that it fails.
        """
        answers, peaks = self._collided(angle, stokes, budget=SAMPLE_BUDGET // _SHARE if first else SAMPLE_BUDGET)
        if first:
            self._finish(answers, peaks, angle, stokes)
        self.collisions += int(np.count_nonzero(answers["time"] != 0))
        samples, outcome = blank(stokes), answers["outcome"]
        for name in ("outcome", "reversal", "events", "time"):
            samples[name] = answers[name]
        samples["restitution"] = answers["shown"][:, 0]
        if self.scene.package is not None and self.scene.package.bends:
            return samples  # no margin is known beside declared events and terms
        contact = contact_gap_at(self.scene, stokes / self.scene.stokes_per_speed)
        samples["criterion"] = np.where(outcome == _ROTATE, _margin(answers, peaks, contact), np.nan)
        samples["time"][outcome == _STICK] = np.nan
        which = np.flatnonzero((outcome == _STICK) & (answers["time"] != 0))
        if which.size:
            ends, _ = self._collided(angle[which], stokes[which], Purpose.ESCAPE, _MARGIN)
            samples["reach"][which] = np.where(ends["outcome"] == _STICK, ends["final_gap"], np.nan)
        which = np.flatnonzero(outcome == _BOUNCE)
        if which.size:  # repeated with solids that are met far below the contact gap
            solids = {name: np.full(which.size, value) for name, value in NEVER_MET.items()}
            solids["roughness"] = _DEEP * contact[which] * self.scene.liquid.film_thickness
            bare = self._collided(angle[which], stokes[which], Purpose.APPROACH, _MARGIN, solids)
            samples["criterion"][which] = _margin(*bare, contact[which])
        return samples

    def outcomes(self, angle: np.ndarray, stokes: np.ndarray, budget: int = KERNEL_STEPS) -> np.ndarray:
        """Outcomes (indices in OUTCOMES) of collisions, -1 where the steps of the budget do not decide one."""
        answers, _ = self._collided(angle, stokes, budget=budget)
        self.collisions += int(np.count_nonzero(answers["time"] != 0))
        if budget == KERNEL_STEPS:
            unknown = answers["outcome"] < 0
            self.undecided.update(zip(angle[unknown].tolist(), stokes[unknown].tolist(), strict=True))
        return np.asarray(answers["outcome"])

    def events(self, angle: float, *stokes: float) -> list[Events] | None:
        """The events of collisions at an angle (rad); None if one is not decided with the steps of a sample."""
        self.collisions += len(stokes)
        speed = np.array([self.scene.speed_of(number) for number in stokes])
        impacts = KernelImpacts(self.scene, speed, np.full(speed.size, angle))
        ran = run_recorded(impacts, self.scene.turns(angle), self.rtol, trajectory=True, budget=SAMPLE_BUDGET,
                           keep=False, fold=False)  # fmt: skip
        if (ran.answers["status"] > LAST_ANSWER).any():
            return None
        words = words_of(self.scene)
        rows = [log[:count] for log, count in zip(ran.events, ran.answers["events"], strict=True)]
        return [[(words[int(row["kind"])], float(row["time"])) for row in of_collision] for of_collision in rows]

    def reason(self, angle: float, low: float, high: float) -> str:
        """The reason why a collision at an angle and between two Stokes numbers is not decided."""
        for stokes in (stokes for at, stokes in self.undecided if at == angle and low <= stokes <= high):
            try:
                recorded(nondimensionalise(self.scene, self.scene.speed_of(stokes), angle), self.rtol)
            except (ComputationError, InputError) as error:
                return str(error)
        return "no collision could be computed"

    def _collided(
        self,
        angle: np.ndarray,
        stokes: np.ndarray,
        purpose: Purpose = Purpose.WHOLE,
        budget: int = SAMPLE_BUDGET,
        solids: Mapping[str, np.ndarray] | None = None,
    ) -> tuple[np.ndarray, np.ndarray]:
        """The kernel's answers, with outcome -1 where one is not decided, and largest margins of the glass criterion.

        Arguments:
            solids: SI quantities of the rebound criteria that replace the scene's.
        """
        every = KernelImpacts(self.scene, stokes / self.scene.stokes_per_speed, angle, solids or {})
        answers, peaks = np.zeros(every.size, ANSWER), np.zeros(every.size)
        for oblique, which in every.by_kind():
            impacts = every.subset(which)
            ran = run_recorded(
                impacts, oblique, self.rtol, trajectory=True, budget=budget, purpose=purpose, keep=False, fold=False,
                peaks=True, events=False,
            )  # fmt: skip
            assert ran.peaks is not None
            ran.answers["outcome"][ran.answers["status"] > LAST_ANSWER] = -1
            if purpose == Purpose.WHOLE and budget >= SAMPLE_BUDGET:  # earlier they are far from a limit
                self._take_limits(ran.answers, impacts, oblique, budget)
            answers[which], peaks[which] = ran.answers, ran.peaks
        return answers, peaks

    def _take_limits(self, answers: np.ndarray, impacts: KernelImpacts, oblique: bool, budget: int) -> None:
        """Fill in the limit outcomes of equal spheres that circle until the budget of steps is exhausted."""
        scene, endless = self.scene, np.flatnonzero(answers["status"] == Status.CHATTER)
        key = select_model(scene, oblique, fold=False)
        model = load(key)
        # strings may transfer energy to the slip, and forces of one's own may do anything
        if not (endless.size and oblique and model.works and model.edged and key.package is None) or model.strings:
            return
        if scene.pair or scene.wall:
            return
        stopped = impacts.subset(endless)
        before = run_recorded(stopped, oblique, self.rtol, trajectory=True, budget=budget // _EARLIER, keep=False,
                              fold=False, events=False).answers  # fmt: skip
        for j, (k, early) in enumerate(zip(endless, before, strict=True)):
            if early["status"] not in (Status.NO_BUDGET, Status.CHATTER):
                continue
            p = model.group_values(stopped.problem(j).groups)
            states = [
                np.array([answer["final_gap"], *answer["shown"][: len(model.state) - 1]])
                for answer in (early, answers[k])
            ]
            stays = Potential(model, p, self.rtol).limit_of_circling(*states)
            if stays is not None:
                reached = _BOUNCE if answers["reversal"][k] >= 0 else _ROTATE
                answers["outcome"][k] = _STICK if stays else reached
                answers["shown"][k, 0] = answers["time"][k] = np.nan

    def _finish(self, answers: np.ndarray, peaks: np.ndarray, angle: np.ndarray, stokes: np.ndarray) -> None:
        """Run collisions of lines again that a part of the steps left undecided, with the steps of a sample.

        Of each run of them along a line these are both ends and one in _EVERY. Between the first and the last that
        still chatter only _ROW in the middle are added, unless one there does not.
        """
        undecided = np.isin(answers["status"], (Status.NO_BUDGET, Status.CHATTER))
        which, wanted = np.flatnonzero(undecided), np.zeros(undecided.size, dtype=bool)
        parts = np.split(which, 1 + np.flatnonzero((np.diff(which) > 1) | (np.diff(stokes[which]) < 0)))
        for rows in parts:
            wanted[rows[::_EVERY]] = wanted[rows[-1:]] = True
        while wanted.any():
            answers[wanted], peaks[wanted] = self._collided(angle[wanted], stokes[wanted])
            undecided &= ~wanted
            chatters = ~undecided & (answers["status"] == Status.CHATTER) & (answers["outcome"] < 0)
            wanted = undecided.copy()
            for rows in parts:
                still = rows[chatters[rows]]
                if still.size and (undecided | chatters)[still[0] : still[-1]].all():
                    inside = rows[(still[0] < rows) & (rows < still[-1])]
                    wanted[inside[abs(inside - (still[0] + still[-1]) // 2) > _ROW // 2]] = False
        self.untried.update(zip(angle[undecided].tolist(), stokes[undecided].tolist(), strict=True))


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


def _margin(answers: np.ndarray, peaks: np.ndarray, contact: np.ndarray) -> np.ndarray:
    """Logarithm by which the approach passes the nearest rebound criterion, positive if met; NaN if there is none."""
    approached = (answers["outcome"] >= 0) & (answers["time"] != 0)
    log_contact = np.full(contact.size, -np.inf)
    has_contact = approached & (contact > 0)
    log_contact[has_contact] = np.log(contact[has_contact] / answers["smallest_gap"][has_contact])
    return np.where(approached, np.maximum(peaks, log_contact), np.nan)
