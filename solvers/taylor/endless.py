"""Chatter that has spent the kernel's steps: whether the state that it has come to is held for good."""

from __future__ import annotations

import numpy as np

from ..model import Choice, load
from ..numbers import numbers
from ..proofs import OrbitalProof, proof_for
from ..scene import Scene

CHATTER = 4  # status of a collision that has spent its steps in many phases (runtime/queue.h)
_DECIDED, _STICK = 0, 0


def decide(
    answers: np.ndarray, scene: Scene, speed: np.ndarray, angle: np.ndarray, choice: Choice, rtol: float
) -> None:
    """Make sticks of the collisions among `answers` whose last state is held by the momentum of the orbit.

    A doublet that circles in and out of its film loses less with every turn: thousands of turns decide nothing that
    the last state does not. `shown` has that state from the opening velocity on.
    """
    for k in np.flatnonzero(answers["status"] == CHATTER).tolist():
        model, told = load(choice), answers[k]
        p = model.group_values(numbers(scene, float(speed[k]), float(angle[k])).groups)
        proof = proof_for(model, p, rtol)
        if not isinstance(proof, OrbitalProof) or model.strings:  # strings may feed the slip
            continue
        y = np.array([told["final_gap"], *told["shown"][: len(model.state) - 1]])
        if proof.holds(y) or proof.settles(y):
            told["status"], told["outcome"], told["certified"] = _DECIDED, _STICK, proof.proves
            told["shown"] = 0.0
