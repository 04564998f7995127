"""Chatter that has exhausted the kernel's steps: the limit that it approaches."""

import numpy as np

from ....generated.automaton import Status
from ...certificates import OrbitalMomentumCertificate, limit_of_circling, proof_for
from ...model.dimensionless import nondimensionalise
from ...model.key import ModelKey
from ...model.model import load
from ...scene.scene import Scene


def limits(
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
