"""Collisions of a table: a plane of angle and Stokes number whose labels are signatures, and the results at points.

Results are smooth functions of the impact only where the sequence of events does not change. A signature is the outcome
with that sequence; the boundaries of a table are those between signatures.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...generated.automaton import KINDS, LAST_ANSWER, OUTCOMES
from ..boundaries.plane import Plane
from ..engines.taylor.call import Impacts
from ..engines.taylor.record import Recorded, run_recorded
from ..errors import ComputationError
from ..many.batch import Batch
from ..many.by_kernel import block_of, impacts_of
from ..scene.scene import Scene

UNKNOWN = -1
STICK = 0  # code of the signature of all sticks
_EVENTS = 12  # events of a signature; later ones are not distinguished
_BUDGET = 20_000  # steps of a collision; one that takes more is within rounding of a separatrix
_MOST_STEPS = 500_000_000  # to find the boundaries of a plane; a preset takes some 1e8
_CHUNK = 8192
_DIGIT = len(KINDS) + 1
_EDGES = ("film edge", "tangential edge")  # a run of crossings of one edge counts as one: a grazed edge is smooth
_KINKS = ("glass", "elastic", "rough", *_EDGES, "slides", "rolls")  # events at which the equations change abruptly
_KEPT = np.isin(KINDS, _KINKS)
_ONCE = np.isin(KINDS, _EDGES)
_SAME = 1e-12
_FIRMER = 1 + 1e-6  # factor of the friction with which a rebound that slides, and only such, changes


@dataclass
class Signatures:
    """Signatures by code: the outcome and the events, shared by all planes of a table."""

    keys: dict[int, int] = field(default_factory=lambda: {0: STICK})
    outcomes: list[int] = field(default_factory=lambda: [0])
    events: list[tuple[str, ...]] = field(default_factory=lambda: [()])
    steps: int = 0  # of all collisions whose signatures these are

    def codes(self, keys: np.ndarray) -> np.ndarray:
        """Codes of packed keys; new ones are entered."""
        unique, inverse = np.unique(keys, return_inverse=True)
        codes = np.full(unique.size, UNKNOWN)
        for k, key in enumerate(unique.tolist()):
            if key >= 0:
                if key not in self.keys:
                    self.keys[key] = len(self.outcomes)
                    self.outcomes.append(key % 3)
                    self.events.append(_unpacked(key // 3))
                codes[k] = self.keys[key]
        return codes[inverse.reshape(-1)]

    def of(self, codes: np.ndarray) -> np.ndarray:
        """Outcomes of codes, by number; -1 where the code is UNKNOWN."""
        return np.asarray(np.array([*self.outcomes, -1])[codes])

    def said(self, code: int) -> str:
        """A signature in words."""
        if code < 0:
            return "a collision that the kernel does not complete"
        events = ", ".join(self.events[code])
        return OUTCOMES[self.outcomes[code]] + (f" ({events})" if events else "")


def _unpacked(key: int) -> tuple[str, ...]:
    words = ["at initial contact"] if key % 2 else []
    words += ["sliding"] if key // 2 % 2 else []
    key //= 4
    while key:
        key, digit = divmod(key, _DIGIT)
        words.append(KINDS[digit - 1])
    return tuple(words)


@dataclass
class Collisions(Plane):
    """The plane of angle and ln St of one scene, with signatures as labels.

    Arguments:
        of: results to return.
        signatures: those known so far.
    """

    of: tuple[str, ...] = ("restitution",)
    signatures: Signatures = field(default_factory=Signatures)
    steps: int = field(default=0, init=False)

    def seen(self, points: np.ndarray, most: int = 0) -> tuple[np.ndarray, np.ndarray]:
        """Signatures at points of the unit square, twice."""
        angle, stokes, before = self.x(points), self.stokes_at(points), self.signatures.steps
        labels = self.at(angle, stokes, ())[0]
        self.steps += self.signatures.steps - before
        if self.steps > _MOST_STEPS:
            place = f"{np.degrees(np.median(angle)):.6g} deg, St {np.median(stokes):.6g}"
            raise ComputationError(
                f"boundaries near {place} take more than {_MOST_STEPS:.0e} steps: doublets take many turns there",
                advice="leave that place out of the ranges",
            )
        return labels, labels

    def at(
        self, angle: np.ndarray, stokes: np.ndarray, of: Sequence[str] | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Signatures (n) and results (n x m, NaN where undefined) at angles (rad) and Stokes numbers."""
        self.collisions += angle.size
        return collisions(self.scene, angle, stokes, self.rtol, self.of if of is None else of, self.signatures)


def collisions(
    scene: Scene,
    angle: np.ndarray,
    stokes: np.ndarray,
    rtol: float,
    of: Sequence[str],
    known: Signatures,
    vary: Mapping[str, np.ndarray] | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Signatures and results of collisions by the kernel; arguments and results as of `Collisions.at`.

    Arguments:
        vary: another entry of each collision, SI.
    """
    labels, values = np.full(angle.size, UNKNOWN), np.full((angle.size, len(of)), np.nan)
    for first in range(0, angle.size, _CHUNK):
        part = slice(first, first + _CHUNK)
        varied = {name: column[part] for name, column in (vary or {}).items()}
        request = Batch(
            scene, stokes[part], None, np.asarray(angle[part], dtype=float), varied, rtol, "taylor", tuple(of)
        )
        impacts, sound = impacts_of(request)
        there = np.arange(angle.size)[part][sound]
        turns = impacts.oblique
        for oblique in (True, False):
            which = np.flatnonzero(turns == oblique)
            if which.size:
                selected = impacts if which.size == turns.size else impacts.part(which)
                labels[there[which]], values[there[which]] = _run(request, selected, oblique, known)
    return labels, values


def _run(request: Batch, impacts: Impacts, oblique: bool, known: Signatures) -> tuple[np.ndarray, np.ndarray]:
    """Signatures and results of impacts that are all oblique or all head-on."""
    fold = not impacts.others
    recorded = run_recorded(impacts, oblique, request.rtol, budget=_BUDGET, room=(_EVENTS, 1), fold=fold)
    assert recorded is not None  # `table` has asked whether there is a kernel
    answers = recorded.answers
    known.steps += int(answers["steps"].sum())
    keys = _packed(recorded.events["kind"].astype(np.int64), answers["events"])
    flags = 2 * _slides(impacts, oblique, request.rtol, answers) + _at_once(recorded)
    keys = np.where(answers["outcome"] == 0, 0, 12 * keys + 3 * flags + answers["outcome"])
    labels = known.codes(np.where(answers["status"] <= LAST_ANSWER, keys, -1))
    if not request.of:
        return labels, np.zeros((labels.size, 0))
    columns = block_of(request, answers, impacts, None)
    values = np.column_stack([columns[name] for name in request.of])
    values[labels < 0] = np.nan
    return labels, values


def _packed(kinds: np.ndarray, number: np.ndarray) -> np.ndarray:
    """The events of each collision at which its equations change abruptly, as one number.

    Near a separatrix a doublet turns and falls back any number of times, which changes nothing.
    """
    keys, place, last = np.zeros(len(kinds), np.int64), np.zeros(len(kinds), np.int64), np.full(len(kinds), -1)
    for k in range(min(kinds.shape[1], int(number.max(initial=0)))):
        kind = kinds[:, k]
        counts = (k < number) & _KEPT[kind] & (place < _EVENTS) & ~(_ONCE[kind] & (kind == last))
        keys[counts] += (kind[counts] + 1) * _DIGIT ** place[counts]
        place += counts
        last = np.where(counts, kind, last)
    return keys


def _at_once(recorded: Recorded) -> np.ndarray:
    """Mask of collisions that meet a rebound criterion at initial contact."""
    first = recorded.events[:, 0]
    return np.asarray((recorded.answers["reversal"] >= 0) & (first["time"] == 0) & (recorded.answers["events"] > 0))


def _slides(impacts: Impacts, oblique: bool, rtol: float, answers: np.ndarray) -> np.ndarray:
    """Mask of collisions with a sliding rebound: with a little more friction they change, others do not."""
    coefficient = impacts.scene.particles.friction
    if coefficient is None or not oblique:
        return np.zeros(answers.size, bool)
    friction = np.broadcast_to(impacts.others.get("friction", coefficient), answers.size)
    firmer = Impacts(impacts.scene, impacts.speed, impacts.angle, {**impacts.others, "friction": friction * _FIRMER})
    again = run_recorded(firmer, oblique, rtol, budget=_BUDGET, events=False, fold=not impacts.others)
    assert again is not None
    changed: np.ndarray = np.abs(again.answers["shown"][:, :3] - answers["shown"][:, :3]).max(axis=1) > _SAME
    return changed & (answers["outcome"] > 0) & (answers["reversal"] >= 0)
