"""Collisions of a batch computed one after another; one that fails is marked with its reason."""

import math
from typing import Any

from ...generated.automaton import OUTCOMES
from ..collision.collide import integrated
from ..errors import WetDoubletError
from ..model.dimensionless import nondimensionalise
from ..results import FAILED, INTEGRATED, LEDGER, NONE, REVERSALS
from .impacts import Impacts
from .results import Block, empty


def run(request: Impacts) -> Block:
    """Compute the collisions of a batch one after another."""
    block = empty(request.size, request.of)
    for k in range(request.size):
        try:
            values = _results(request, k)
        except WetDoubletError as error:
            values = {"outcome": FAILED, "reason": str(error)}
        except Exception as error:  # noqa: BLE001 # a defect of ours spoils one collision, not the others
            reason = " ".join(f"internal error: {type(error).__name__}: {error}".split())
            values = {"outcome": FAILED, "reason": reason}
        for name, value in values.items():
            block[name][k] = value
    return block


def _results(request: Impacts, k: int) -> dict[str, Any]:
    ledger = any(name in LEDGER for name in request.of)
    result = integrated(nondimensionalise(*request.impact(k)), request.rtol, request.engine, ledger, False)
    values: dict[str, Any] = {"outcome": OUTCOMES.index(result.outcome), "certified": result.certified}
    for name in ("restitution", *(name for name in request.of if name in INTEGRATED)):
        table, _, term = name.rpartition(".")
        value = getattr(getattr(result, table) if table else result, term)
        if name == "reversal":
            values[name] = NONE if value is None else REVERSALS.index(value)
        else:
            values[name] = math.nan if value is None else value
    return values
