"""Energy ledgers of collisions in space: terms over m v0^2 by either engine, a row each, and in J."""

from collections.abc import Mapping

import numpy as np

from ..collision.outcome import open_beyond
from ..model.model import Model
from ..results import TERMS as OF_KERNEL
from ..scene.scene import Scene

TERMS = tuple(name for name in OF_KERNEL if name not in ("strings", "own_events"))  # no kernel in space has them
_INITIAL, _FINAL, _SHEAR = (TERMS.index(name) for name in ("initial", "final", "tangential_lubrication"))
OPEN = "the energy ledger is open: try a smaller rtol, or another engine"
GREW = "energy has grown: errors have added up over a long trajectory; try a smaller rtol, or another engine"
TRANSVERSE = [_INITIAL, _FINAL, _SHEAR]
"""Places of the terms to which motion across the line of centres contributes."""


def of_kernel(books: np.ndarray) -> np.ndarray:
    """The terms of ledgers by the kernel, (collisions, terms)."""
    return np.stack([books[name] for name in map(OF_KERNEL.get, TERMS)], axis=-1)


def extras_of(model: Model) -> tuple[str, ...]:
    """Names of a model's quadratures for the ledger."""
    return tuple(name for name in model.names("energy_rates") if name in TERMS)


def of_casadi(
    model: Model, p: np.ndarray, y: np.ndarray, extras: Mapping[str, float], dry: float, rubbed: float = 0.0
) -> np.ndarray:
    """The terms of a trajectory by CasADi, from its last state and quadratures."""
    first, last = (model.values("energies", state, p)["kinetic"] for state in (model.start(p), y))
    known = dict(extras) | {"initial": first, "final": last, "dry_contact": dry}
    known["dry_friction"] = known.get("dry_friction", 0.0) + rubbed
    return np.array([known.get(name, 0.0) for name in TERMS])


def residual(terms: np.ndarray) -> np.ndarray:
    """What the terms (collisions, terms) leave of the initial energy: the error of the integration."""
    rest: np.ndarray = terms[:, _INITIAL] - np.sum(np.delete(terms, _INITIAL, axis=1), axis=1)
    return rest


def is_open(terms: np.ndarray, separated: np.ndarray, rtol: float) -> np.ndarray:
    """Mask of separated collisions whose residual says that the trajectory is wrong."""
    rest = np.abs(residual(terms))
    mask: np.ndarray = separated & (rest > open_beyond(rtol) * np.maximum(np.abs(terms).max(axis=1), rest))
    return mask


def named(scene: Scene, terms: np.ndarray) -> dict[str, np.ndarray]:
    """The terms by name, without those of forces that the scene does not have, and the residual."""
    result = {name: terms[:, k] for k, name in enumerate(TERMS)} | {"residual": residual(terms)}
    for name, cause in (("attraction", scene.attraction), ("dry_friction", scene.particles.friction)):
        if cause is None:
            del result[name]
    return result
