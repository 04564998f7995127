"""Collisions for boundaries by the kernel: outcomes, margins and events of many; None without a kernel."""

from collections.abc import Mapping

import numpy as np

from ...generated.automaton import BOUNCE, LAST_ANSWER, OUTCOMES, ROTATE, STICK, Purpose, Status
from ..certificates import OrbitalMomentumCertificate, limit_of_circling, proof_for
from ..collision.by_kernel import words_of
from ..engines.taylor.call import Impacts
from ..engines.taylor.record import run_recorded
from ..model.dimensionless import nondimensionalise
from ..model.key import ModelKey
from ..model.model import load, select_model
from ..scene.groups import sideways
from ..scene.scene import Scene

SAMPLE_BUDGET = 20_000  # steps of a sampled collision; limits how close to a separatrix collisions are sampled
_EARLIER = 5  # the last state of chatter is compared with the state after this fraction (1/n) of its steps


Events = list[tuple[str, float]]
"""Events of a collision, their words and times (x0/v0)."""
SAMPLED = np.dtype(
    [
        ("outcome", "i1"),  # 0 stick, 1 stick-rotate-separate, 2 bounce, -1 not completed by the kernel
        ("creeps", "?"),  # step budget exhausted after few events
        ("chatters", "?"),  # step budget exhausted after many events
        ("reversal", "i1"),  # the first criterion met, in the order glass, elastic, rough; -1 for none
        ("at_touch", "?"),  # decided at initial contact
        ("events", "i4"),  # number of events
        ("restitution", "f8"),
        ("time", "f8"),  # end time, x0/v0
        ("smallest_gap", "f8"),  # x0
        ("final_gap", "f8"),  # x0
        ("glass", "f8"),  # largest margin of the glass criterion while closing; -inf where none is known
    ]
)
"""Record of a sampled collision."""


def sample_by_kernel(
    scene: Scene,
    speed: np.ndarray,
    angle: np.ndarray,
    rtol: float,
    purpose: Purpose = Purpose.WHOLE,
    solids: Mapping[str, np.ndarray] | None = None,
    budget: int = SAMPLE_BUDGET,
) -> np.ndarray | None:
    """An array of SAMPLED for collisions at normal speeds (m/s) and angles (rad), in one call of each kernel.

    Arguments:
        solids: SI quantities of the rebound criteria that replace the scene's.
    """
    result = np.zeros(speed.size, SAMPLED)
    for oblique in (True, False):
        which = np.flatnonzero(sideways(scene, angle, {}) == oblique)
        if not which.size:
            continue
        others = {name: values[which] for name, values in (solids or {}).items()}
        impacts = Impacts(scene, speed[which], angle[which], others)
        recorded = run_recorded(
            impacts, oblique, rtol, trajectory=True, budget=budget, purpose=purpose, keep=False, fold=False,
            peaks=True, events=False,
        )  # fmt: skip
        if recorded is None or recorded.peaks is None:
            return None
        answers = recorded.answers
        part = np.zeros(which.size, SAMPLED)
        part["outcome"] = np.where(answers["status"] <= LAST_ANSWER, answers["outcome"], -1)
        part["creeps"], part["chatters"] = (
            answers["status"] == status for status in (Status.NO_BUDGET, Status.CHATTER)
        )
        part["at_touch"] = answers["time"] == 0
        part["restitution"] = answers["shown"][:, 0]
        part["glass"] = recorded.peaks
        for name in ("reversal", "events", "time", "smallest_gap", "final_gap"):
            part[name] = answers[name]
        if purpose == Purpose.WHOLE and not others and budget >= SAMPLE_BUDGET:  # earlier they are far from a limit
            _take_limits(part, impacts, answers, oblique, rtol, budget)
        result[which] = part
    return result


def events(
    scene: Scene, speed: np.ndarray, angle: float, rtol: float, budget: int = SAMPLE_BUDGET
) -> list[Events] | None:
    """The events of collisions at normal speeds (m/s) and an angle (rad); None if one is not completed."""
    impacts = Impacts(scene, speed, np.full(speed.size, angle), {})
    recorded = run_recorded(impacts, scene.turns(angle), rtol, trajectory=True, budget=budget, keep=False, fold=False)
    if recorded is None or (recorded.answers["status"] > LAST_ANSWER).any():
        return None
    words = words_of(scene)
    rows = [log[:count] for log, count in zip(recorded.events, recorded.answers["events"], strict=True)]
    return [[(words[int(row["kind"])], float(row["time"])) for row in collision_rows] for collision_rows in rows]


def _take_limits(
    part: np.ndarray, impacts: Impacts, answers: np.ndarray, oblique: bool, rtol: float, budget: int
) -> None:
    """Fill in the limit outcomes of doublets that entered and left their film until the step budget was exhausted."""
    endless, choice = np.flatnonzero(part["chatters"]), select_model(impacts.scene, oblique, fold=False)
    if not endless.size or choice.law("strings"):  # strings may transfer energy to the slip
        return
    stopped = impacts.part(endless)
    before = run_recorded(stopped, oblique, rtol, trajectory=True, budget=budget // _EARLIER, keep=False, events=False)
    assert before is not None  # the kernel is available
    held = _limits(before.answers, answers[endless], impacts.scene, stopped.speed, stopped.angle, choice, rtol)
    for k, stays in zip(endless.tolist(), held, strict=True):
        if stays is not None:
            reached = BOUNCE if part["reversal"][k] >= 0 else ROTATE
            part["outcome"][k] = OUTCOMES.index(STICK if stays else reached)
            part["restitution"][k] = part["time"][k] = np.nan


def _limits(
    earlier: np.ndarray,
    answers: np.ndarray,
    scene: Scene,
    speed: np.ndarray,
    angle: np.ndarray,
    choice: ModelKey,
    rtol: float,
) -> list[bool | None]:
    """For circling doublets, True if a certificate holds in the limit of many turns; None where that is not clear.

    Arguments:
        earlier, answers: of the same impacts, without strings, after fewer steps and after more.
    """
    verdicts: list[bool | None] = []
    for k in range(answers.size):
        both = earlier[k], answers[k]
        circles = all(answer["status"] in (Status.NO_BUDGET, Status.CHATTER) for answer in both)
        proof = _proof(scene, speed[k], angle[k], choice, rtol) if circles else None
        verdicts.append(
            None if proof is None else limit_of_circling(proof, *(_state(proof, answer) for answer in both))
        )
    return verdicts


def _proof(
    scene: Scene, speed: float, angle: float, choice: ModelKey, rtol: float
) -> OrbitalMomentumCertificate | None:
    model = load(choice)
    proof = proof_for(model, model.group_values(nondimensionalise(scene, float(speed), float(angle)).groups), rtol)
    return proof if isinstance(proof, OrbitalMomentumCertificate) else None


def _state(proof: OrbitalMomentumCertificate, answer: np.void) -> np.ndarray:
    return np.array([answer["final_gap"], *answer["shown"][: len(proof.model.state) - 1]])
