"""A batch of collisions by CasADi, one after another; one that fails is marked with its reason."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ...generated.automaton import OUTCOMES
from ..collision.assemble import partner_spin
from ..engines.casadi.locate import EventSequence, locate
from ..errors import ComputationError, WetDoubletError
from ..model.dimensionless import DimensionlessGroups, nondimensionalise
from ..model.model import load, select_model, slip_restitution
from ..scene.scene import Scene
from ..settings import casadi_steps
from .batch import Batch
from .dataset import empty
from .results import FAILED, INTEGRATED, LEDGER, NONE, RATES, REVERSALS, Block


def run(request: Batch, machine_code: bool) -> Block:
    """Compute the collisions of a batch one after another."""
    block = empty(request.size, request.of)
    for k in range(request.size):
        for name, value in _one(request, k, machine_code).items():
            block[name][k] = value
    return block


def _one(request: Batch, k: int, machine_code: bool) -> dict[str, Any]:
    try:
        scene, speed, angle = request.impact(k)
        if request.engine == "cvodes" or any(name in LEDGER or name == "steps" for name in request.of):
            plugin = "cvodes" if request.engine == "cvodes" else "rosenbrock"
            return _chained(request, scene, speed, angle, plugin)
        n = nondimensionalise(scene, speed, angle)
        model = load(select_model(scene, n.oblique, fold=True))
        turns = model.has("turning_rate") and not model.strings
        quadrature = ("rotation",) if "rotation" in request.of and turns else ()
        try:
            path = locate(model, n.groups, request.rtol, quadrature, machine_code, 0.0, _steps(request))
        except ComputationError as error:
            raise n.in_si(error) from None
        return _kept(scene, request.of, path, n)
    except WetDoubletError as error:
        return {"outcome": FAILED, "reason": str(error)}
    except Exception as error:  # noqa: BLE001 # a defect of ours spoils one collision, not the others
        return {"outcome": FAILED, "reason": " ".join(f"internal error: {type(error).__name__}: {error}".split())}


def _steps(request: Batch) -> int:
    """Most steps of a collision; after the kernel, what that leaves of the budget."""
    return casadi_steps(request.rtol, after_kernel=request.engine == "taylor")


def _kept(scene: Scene, of: Sequence[str], path: EventSequence, n: DimensionlessGroups) -> dict[str, Any]:
    found: dict[str, Any] = {"outcome": OUTCOMES.index(path.outcome), "certified": path.certified, "restitution": 0.0}
    if "reversal" in of:
        found["reversal"] = _code(path.reversal)
    if not path.separated:
        return found | ({"until": path.time * n.time} if "until" in of else {})
    outputs = path.model.values("outputs", path.y, path.p)
    found["restitution"] = outputs["restitution"]
    values = {
        "tangential_restitution": outputs["tangential_restitution"] if n.angle > 0 else math.nan,
        "slip_restitution": slip_restitution(path.model, path.y, path.p),
        "contact_time": path.time * n.time,
        "smallest_gap": path.smallest_gap * n.length,
        "rotation": 0.0,
    }
    names = (*path.model.state, *path.extras)
    if "rotation" in names:
        values["rotation"] = float(path.y[names.index("rotation")])
    if any(name in RATES for name in of):
        rates = {name: outputs[name] * n.rate if n.oblique else 0.0 for name in ("final_spin", "final_rotation_rate")}
        partner = partner_spin(scene, rates["final_spin"], outputs, n)
        values |= rates | {"final_spin_partner": math.nan if partner is None else partner}
    return found | {name: value for name, value in values.items() if name in of}


def _code(reversal: str | None) -> int:
    return NONE if reversal is None else REVERSALS.index(reversal)


def _chained(request: Batch, scene: Scene, speed: float, angle: float, plugin: str) -> dict[str, Any]:
    """One collision as `collide` computes it."""
    from ..collision.by_casadi import by_casadi

    n = nondimensionalise(scene, speed, angle)
    ledger = any(name in LEDGER for name in request.of)
    one = by_casadi(scene, n, request.rtol, plugin, ledger, False, steps=_steps(request))
    found: dict[str, Any] = {"outcome": OUTCOMES.index(one.outcome), "certified": one.certified}
    for name in ("restitution", *(name for name in request.of if name in INTEGRATED)):
        table, _, term = name.rpartition(".")
        value = getattr(getattr(one, table) if table else one, term)
        found[name] = _code(value) if name == "reversal" else math.nan if value is None else value
    return found
