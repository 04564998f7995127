"""Many collisions by the kernel with their derivatives: a direction for each group that the asked quantities move."""

from __future__ import annotations

import ctypes
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from ..compilers import compiler
from ..model import choose
from ..numbers import si_values
from ..scene import Scene
from .engine import BUDGET, RIGID, Impacts, order_for
from .headers import headers, tangents
from .library import ANSWER, Variant, kernel

RESULTS = 8  # as runtime/along.h has them
COLUMNS = {"time": 5, "smallest_gap": 6, "turned": 7}  # after the outputs
CHATTERS = 5  # the boundary of a flight that rested on the solids
DISTANCES = {  # boundaries whose measure is the distance that `sensitivities` names
    6: ("tie of roughness and elastic length", "particles.roughness"),
    7: ("glass criterion met at first touch", "liquid.glass_transition_pressure"),
    8: ("half turn at separation", "rotation"),
}
MOST_STEPS = 300  # as runtime/tape.h has it
STRICTER = 4.0  # steps that no direction holds are held to a tolerance stricter by this
_CHUNK = 1024  # collisions whose derivatives are in work at a time
_LOOSEST = 1e-6


@dataclass(frozen=True)
class Carried:
    """Answers, and derivatives of their dimensionless results by quantities in SI.

    Arguments:
        answers: of ANSWER, a collision each.
        slopes: (collisions, quantities, RESULTS); zero where nothing separated.
        near: (collisions, 3); of what separated, the least measure of its nearness to a boundary, which (along.h), and
            the least of those measures that are not in DISTANCES.
        quantities: names in the vocabulary, in the order of `slopes`.
        by_energy: sticks are proved by their energy, a level below a barrier.
    """

    answers: np.ndarray
    slopes: np.ndarray
    near: np.ndarray
    quantities: tuple[str, ...]
    by_energy: bool


def carried(
    impacts: Impacts,
    oblique: bool,
    rtol: float,
    rotation: bool,
    moved: Sequence[str] | None = None,
    order: int | None = None,
    budget: int = BUDGET,
    backward: bool = False,
) -> Carried | None:
    """Derivatives of impacts that are all oblique, or all head-on; None if there is no kernel here.

    Arguments:
        moved: quantities that are differentiated by; None: all.
        order: of the series; None: the cheapest for the tolerance.
        backward: of the restitution alone, taken back along the flight: for the price of one direction. Flights of more
            than some hundred steps are handed over.
    """
    library = _library(impacts.scene, oblique, order or order_for(min(rtol, _LOOSEST)), rotation, backward)
    if library is None:
        return None
    if backward:
        budget, rtol = min(budget, MOST_STEPS), min(rtol, _LOOSEST) / STRICTER
    names = _names(library, "quantity_names")
    given: dict[str, np.ndarray | float] = {"youngs_modulus": RIGID, "poisson_ratio": 0.0}
    given |= si_values(impacts.scene, None, None)
    given |= dict(impacts.others) | {"speed": impacts.speed, "angle": impacts.angle}
    columns = [np.ascontiguousarray(given[name], dtype=float).reshape(-1) for name in names]
    varies = [bool(np.ndim(given[name])) for name in names]
    groups = _names(library, "group_names")
    asked = _asked(library, names, moved)
    count = impacts.angle.size
    results = 1 if backward else RESULTS
    answers, slopes = np.zeros(count, ANSWER), np.zeros((count, len(names), results))
    near = np.full((count, 3), np.inf)
    for first in range(0, count, _CHUNK):
        size = min(_CHUNK, count - first)
        parts = [column[first : first + size] if own else column for column, own in zip(columns, varies, strict=True)]
        pointers = (ctypes.c_void_p * len(parts))(*(part.ctypes.data for part in parts))
        by_group = np.zeros((size, len(groups), results))
        into, out, least = (all_[first : first + size] for all_ in (answers, slopes, near))
        done = library.collide_along(
            size, pointers, bytes(varies), min(rtol, _LOOSEST), budget, into.ctypes.data, asked,
            by_group.ctypes.data, out.ctypes.data, least.ctypes.data,
        )  # fmt: skip
        assert done == ANSWER.itemsize
    return Carried(answers, slopes, near, names, bool(ctypes.c_int.in_dll(library, "proved_by_energy").value))


def _library(scene: Scene, oblique: bool, order: int, rotation: bool, backward: bool) -> ctypes.CDLL | None:
    variant = variant_of(scene, oblique, order, rotation, backward)
    return kernel(variant) if differentiates(scene, (oblique,)) else None


def variant_of(scene: Scene, oblique: bool, order: int, rotation: bool, backward: bool = False) -> Variant:
    """What the kernel that differentiates a scene's collisions is compiled for."""
    own = scene.bridge is not None and scene.bridge.rupture == "own"
    return Variant(choose(scene, oblique), order, rotation, own, gradients=True, backward=backward)


def differentiates(scene: Scene, oblique: Collection[bool] = (True, False)) -> bool:
    """Whether the kernel differentiates a scene's collisions: its tangent can be emitted, and there is a compiler.

    Arguments:
        oblique: of oblique ones, of those head-on: what is not asked about is not derived.
    """
    choices = [choose(scene, own) for own in oblique]
    return compiler() is not None and all(headers(choice) and tangents(choice) for choice in choices)


def _names(library: ctypes.CDLL, symbol: str) -> tuple[str, ...]:
    return tuple(ctypes.string_at(ctypes.addressof(ctypes.c_char.in_dll(library, symbol))).decode().split())


def _asked(library: ctypes.CDLL, quantities: tuple[str, ...], moved: Sequence[str] | None) -> int:
    """The groups that these quantities move, as bits."""
    bits = (ctypes.c_uint * len(quantities)).in_dll(library, "moved_groups")
    found = 0
    for name, own in zip(quantities, bits, strict=True):
        if moved is None or name in moved:
            found |= own
    return found
