"""A batch of collisions by CasADi, one after another; one that fails is marked with its reason."""

import math
from typing import Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..collision.by_casadi import by_casadi
from ..engines.casadi.integrators import Tolerance
from ..engines.casadi.locate import EventSequence, locate
from ..engines.casadi.replay import Replay, as_located, replay
from ..engines.settings import Budget, casadi_steps
from ..errors import WetDoubletError
from ..model.dimensionless import nondimensionalise
from ..model.model import Model
from ..model.phases import Flow
from ..results import FAILED, INTEGRATED, LEDGER, NONE, REVERSALS
from .impacts import Impacts
from .results import Block, empty


def run(request: Impacts, machine_code: bool) -> Block:
    """Compute the collisions of a batch one after another."""
    block = empty(request.size, request.of)
    for k in range(request.size):
        try:
            values = _one(request, k, machine_code)
        except WetDoubletError as error:
            values = {"outcome": FAILED, "reason": str(error)}
        except Exception as error:  # noqa: BLE001 # a defect of ours spoils one collision, not the others
            reason = " ".join(f"internal error: {type(error).__name__}: {error}".split())
            values = {"outcome": FAILED, "reason": reason}
        for name, value in values.items():
            block[name][k] = value
    return block


def _one(request: Impacts, k: int, machine_code: bool) -> dict[str, Any]:
    """The results of one collision: by Rosenbrock those of its located events, unless more is to be kept."""
    scene, speed, angle = request.impact(k)
    n = nondimensionalise(scene, speed, angle)
    plugin = "cvodes" if request.engine == "cvodes" else "rosenbrock"
    ledger = any(name in LEDGER for name in request.of)
    located = plugin == "rosenbrock" and not ledger and "steps" not in request.of
    budget = Budget(casadi_steps(request.rtol, spent=0 if request.spent is None else int(request.spent[k])))

    def find(
        model: Model, groups: dict[str, float], rtol: float, extras: tuple[str, ...], budget: Budget
    ) -> EventSequence:
        turns = located and "rotation" in request.of and model.has("turning_rate") and not model.strings
        return locate(model, groups, rtol, ("rotation",) if turns else extras, located and machine_code, 0.0, budget)

    def kept(
        path: EventSequence, plugin: str, tolerance: Tolerance, flow: Flow, start: np.ndarray, budget: Budget
    ) -> Replay:
        if not located:
            return replay(path, plugin, tolerance, flow, start, budget)
        replayed = as_located(path, flow.choice)
        replayed.time = path.time
        return replayed

    one = by_casadi(scene, n, request.rtol, plugin, ledger, False, find, replay=kept, budget=budget)
    values: dict[str, Any] = {"outcome": OUTCOMES.index(one.outcome), "certified": one.certified}
    for name in ("restitution", *(name for name in request.of if name in INTEGRATED)):
        table, _, term = name.rpartition(".")
        value = getattr(getattr(one, table) if table else one, term)
        if name == "reversal":
            values[name] = NONE if value is None else REVERSALS.index(value)
        else:
            values[name] = math.nan if value is None else value
    return values
