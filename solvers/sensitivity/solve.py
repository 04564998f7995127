"""`solve()`: the values of an entry at which a result of the collision has a value, with derivatives and jumps."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

import numpy as np
from scipy.optimize import brentq

from ...generated.automaton import OUTCOMES, STICK
from ..boundaries.brackets import Brackets, enclose
from ..collision.collide import collide
from ..collision.text import name_of
from ..engines.settings import check_rtol
from ..errors import ComputationError, InputError, ModelWarning, WetDoubletError
from ..formatting.tables import numbers_aligned
from ..host.arguments import check_name
from ..many.collide_many import collide_many
from ..results import DEFINITIONS, DIFFERENTIATED, INTEGRATED, OF_IMPACT, REVERSALS
from ..scene.fields import ANY, Field
from ..scene.held import held_quantity
from ..scene.items import item
from ..scene.origin import Record, origin
from ..scene.scene import Scene
from ..scene.schema import MEETING, SPEEDS
from .parameters import check_wrt
from .sensitivities import sensitivities

TARGETS = tuple(
    name
    for name in (*INTEGRATED, *OF_IMPACT)
    if name not in ("reversal", "steps", "until", "energy.initial", "energy.residual", "angular_momentum_drift")
)
"""Results that may have a value: not codes, nor what is given, nor errors of the integration."""
_SAMPLES = 1025
_DECADE = 10.0  # a range whose ends have a larger ratio is searched in the logarithm
_FINER, _LOOKS = 17, 8  # samples between the neighbours of a minimum, and how often it is narrowed down
_SEEN, _CHANGED = 1e-6, 1e-11  # widths to which roots and changes are enclosed, as parts of the range
_SHARP = 1e-2  # tolerance of the search over the requested one: noise moves a root by less
_SHARPEST = 1e-13
_AGREES = 1e-6  # of the value, or of the largest at hand: how well a collision has to confirm a root
_FLAT = 1e2  # tolerances within which a result is its target
_SAME = 1e-9  # part of the range within which two roots are one: what errors of a collision move a root by
_KINDS, _SIDES = len(REVERSALS) + 1, 3  # sides of the value: below, above, undefined


def solve(
    scene: Scene | str | FilePath,
    *,
    free: str,
    within: tuple[float | str, float | str],
    stokes: float | str | None = None,
    speed: float | str | None = None,
    angle: float | str | None = None,
    relative_speed: float | str | None = None,
    hold: str | None = None,
    rtol: float = 1e-9,
    **target: float | str,
) -> Solutions:
    """All values of an entry, within a range, at which a result of the collision has the value that is asked for.

    The range is sampled. Between samples with the same outcome and criterion, extrema towards the value are narrowed
    down. Changes of outcome are enclosed to 1e-11 of the range, so that roots beside them are found. A value that is
    only jumped over there is no root; nor is one that the result has all along, where it does not depend on the entry.
    Each root is confirmed by a collision of its own.

    Arguments:
        scene: a Scene, a path to a scene file, or a preset's name.
        free: the entry, by dotted name; one of the impact's included.
        within: lowest and highest value; SI numbers, or strings with their units.
        stokes, speed, angle, relative_speed: the impact, as for `collide`.
        hold: what the impact keeps where the entry varies, as for `Scene.with_entries`.
        rtol: relative tolerance, 1e-13..1e-3; the search takes a hundredth.
        target: one result by name, as `restitution=0.5` or `**{"energy.capillary": 1e-12}`, SI or a string with its
            unit.

    Returns:
        Solutions: a list of the values, SI, ascending; with derivatives, and what was jumped over. Printed it says the
        range where there is none.

    Raises:
        InputError: an entry, result or value that is not acceptable; a restitution of 0, which all sticks have.
        ComputationError: no collision of the range could be computed, or one does not confirm a root.

    Example:
        >>> import wetdoublet as wd
        >>> found = wd.solve("granulation", restitution=1, free="impact.stokes", within=(0.01, 0.05), angle="75 deg")
        >>> [round(value, 4) for value in found]
        [0.0131]
    """
    name, value = _target(target)
    rtol, loaded = check_rtol(rtol), Scene.load(scene, free=free)
    given = {"stokes": stokes, "speed": speed, "relative_speed": relative_speed, "angle": angle}
    for key, number in given.items():
        clashes = free == f"impact.{key}" or (free in SPEEDS and key != "angle")
        if clashes and number is not None:
            raise InputError(key, number, f"{key} left out, where {free} is free", "is given together with free")
    loaded = loaded.with_impact(**given)
    (entry,) = check_wrt(loaded, (free,), "free")
    if not isinstance(within, (tuple, list)) or len(within) != 2:
        raise InputError("within", within, "the lowest and the highest value, (LO, HI)", "is not a pair")
    low, high = (loaded.si_number(entry, end, "within") for end in within)
    if not low < high:
        raise InputError("within", within, "LO below HI", "is not a range")
    if entry not in MEETING:
        loaded.need_impact()
    search = Search(loaded, entry, low, high, name, value, held_quantity(loaded, hold), max(rtol * _SHARP, _SHARPEST))
    with warnings.catch_warnings(record=True) as remarks:  # by all samples
        warnings.simplefilter("always", ModelWarning)
        result = search.solutions()
    for remark in {re.sub(r"-?[\d.]+(e[-+]\d+)?", "", str(told.message)): told for told in reversed(remarks)}.values():
        warnings.warn(remark.message, remark.category, stacklevel=2)
    return result


def _target(target: Mapping[str, Any]) -> tuple[str, float]:
    """The result and its value, SI; InputError unless there is one."""
    if len(target) != 1:
        raise InputError("target", ", ".join(target) or None, "one result with its value, as restitution=0.5")
    ((name, raw),) = target.items()
    unit = DEFINITIONS[check_name(name, TARGETS, "target")].unit
    ratio = unit == "1"
    value = Field(name, "a value", "0.5" if ratio else f'"1 {unit}"', ANY, unit=None if ratio else unit).number(raw)
    if name == "restitution" and value <= 0:
        raise InputError(name, raw, "a number above 0; where sticking ends is a `boundary`", "is that of all sticks")
    return name, value


class Solution(Record):
    """One value of the entry, SI."""

    value: float
    outcome: str = item("of the collision there")
    gradient: Mapping[str, float] = item(
        "derivatives of the value by parameter, and by the result's target; empty where there are none",
        default_factory=dict,
    )
    reason: str = item("why there are none", default="")


class Jump(Record):
    """Value of the entry where the result jumps over its target; outcomes, with criteria, and results beside it."""

    value: float
    before: str
    below: float
    after: str
    above: float

    def __str__(self) -> str:
        return f"{self.value:.10g}: {self.before} {self.below:.4g}, {self.after} {self.above:.4g}"


@dataclass(frozen=True)
class Search:
    """Where, with `free` from `low` to `high`, has the result `of` this `value`? SI; places are parts of the range.

    Attributes:
        hold: what the impact keeps.
        rtol: relative tolerance of the collisions.
    """

    scene: Scene
    free: str
    low: float
    high: float
    of: str
    value: float
    hold: str
    rtol: float

    def at(self, place: Any) -> Any:
        """Values of the entry, SI."""
        if self.low > 0 and self.high > _DECADE * self.low:
            return np.clip(self.low * (self.high / self.low) ** place, self.low, self.high)
        return self.low + (self.high - self.low) * place

    def _collided(self, place: Any) -> Any:
        values = np.atleast_1d(self.at(place))
        options: dict[str, Any] = {"rtol": self.rtol, "of": ("outcome", "reversal", self.of)}
        if self.free in MEETING:
            options[self.free.partition(".")[2]] = values
        else:
            options |= {"vary": {self.free: self.scene.as_given(self.free, values)}, "hold": self.hold}
        return collide_many(self.scene, **options)

    def _failed(self, place: np.ndarray) -> str:
        """How many samples have failed, at these places, and why the first did."""
        try:
            reason = str(self._collided(place[:1])["reason"].values[0])
        except InputError as error:  # a single one that cannot be
            reason = str(error)
        unit = self.scene.fields[self.free].unit or ""
        span = f"{self.at(place.min()):.4g} to {self.at(place.max()):.4g} {unit}".rstrip()
        return f"{place.size} samples from {span} are passed over; the first: {reason}"

    def sampled(self, place: Any) -> tuple[np.ndarray, np.ndarray]:
        """Values of the result, and labels: outcome, criterion and side of the value as a number; -1 where unknown."""
        data = self._collided(place)
        outcome, reversal = data["outcome"].values.astype(int), data["reversal"].values.astype(int)
        result = np.asarray(data[self.of].values, float)
        if self.of not in ("restitution", *OF_IMPACT):
            result = np.where(outcome == OUTCOMES.index(STICK), np.nan, result)
        side = np.where(np.isnan(result), 2, result > self.value)
        return result, np.where(outcome < 0, -1, (outcome * _KINDS + reversal + 1) * _SIDES + side)

    def _computed(self, place: np.ndarray) -> np.ndarray:
        """1 where there are collisions, 0 where not."""
        try:
            return (self.sampled(place)[1] >= 0).astype(int)
        except InputError:  # at none of these places
            return np.zeros(place.size, int)

    def solutions(self) -> Solutions:
        """All roots, the jumps over the value, and where it does not change."""
        place, result, label = self._samples()
        valid = label >= 0
        if not valid.any():
            raise ComputationError(f"no collision with {self.free} in the range can be computed: {self._failed(place)}")
        failed = place[~valid]
        edges = enclose(  # roots may lie between the last sample and where there are no collisions
            lambda _, at: self._computed(at),
            Brackets.between(np.zeros(place.size, int), place, valid.astype(int)),
            _SEEN, at_once=4 * _FINER,
        )  # fmt: skip
        ends = np.where(edges.before == 1, edges.low, edges.high)
        columns = np.hstack([[place[valid], result[valid], label[valid]], [ends, *self.sampled(ends)]])
        columns = columns[:, np.argsort(columns[0])]
        place, result, label = columns[0], columns[1], columns[2].astype(int)
        defined = result[~np.isnan(result) & ((label // _SIDES // _KINDS > 0) | (self.of in OF_IMPACT))]
        size = abs(self.value) or float(np.abs(defined).max(initial=0.0)) or 1.0
        flat = _runs(np.abs(result - self.value) <= _FLAT * self.rtol * size, label // _SIDES)
        for first, last in flat:
            label[first : last + 1] += 2 - label[first : last + 1] % _SIDES  # neither side
        closed = enclose(  # roots may lie between the last sample of a regime and its end
            lambda _, at: self.sampled(at)[1],
            Brackets.between(np.zeros(place.size, int), place, label),
            lambda brackets: np.where(brackets.before // _SIDES == brackets.after // _SIDES, _SEEN, _CHANGED),
            at_once=4 * _FINER, unknown=-1,
        )  # fmt: skip
        roots: list[float] = []
        jumps: list[Jump] = []
        alike = closed.before // _SIDES == closed.after // _SIDES
        passed = closed.before % _SIDES + closed.after % _SIDES == 1  # from one side of the value to the other
        for low, high, smooth in zip(closed.low[passed], closed.high[passed], alike[passed], strict=True):
            root = self._root(low, high) if smooth else low
            if not smooth or not abs(self._off(root)) <= _AGREES * size:
                jumps.append(self._jump(low, high))
            elif not roots or root - roots[-1] > _SAME:
                roots.append(root)
        remarks = [] if valid.all() else [self._failed(failed)]
        if not defined.size:
            stuck = bool((label // _SIDES // _KINDS == OUTCOMES.index(STICK)).all())
            remarks.append("all stick" if stuck else f"no collision of this scene has {DEFINITIONS[self.of].label}")
        if not roots and not alike.all():
            remarks.append(f"beside a change of outcome nothing is resolved within {_CHANGED:g} of the range")
        return Solutions(
            self, [self._confirmed(root, size) for root in roots], jumps,
            [(float(self.at(place[j])), float(self.at(place[k]))) for j, k in flat],
            (float(defined.min()), float(defined.max())) if defined.size else None, remarks,
        )  # fmt: skip

    def _samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Samples over the range, finer about extrema towards the value that do not reach it."""
        first = np.linspace(0, 1, _SAMPLES)
        columns = np.vstack([first, *self.sampled(first)])
        for _ in range(_LOOKS):
            place, label, off = columns[0], columns[2], np.abs(columns[1] - self.value)
            alike = (label[1:-1] == label[:-2]) & (label[1:-1] == label[2:]) & (label[1:-1] >= 0)
            low = (off[1:-1] <= off[:-2]) & (off[1:-1] <= off[2:]) & (off[:-2] + off[2:] > 2 * off[1:-1])
            minima = 1 + np.flatnonzero(alike & low)
            if not minima.size or minima.size > _SAMPLES // _FINER:  # what varies so much is rounding
                break
            finer = [np.linspace(place[k - 1], place[k + 1], _FINER + 2)[1:-1] for k in minima]
            new = np.setdiff1d(np.concatenate(finer), place)
            columns = np.hstack([columns, [new, *self.sampled(new)]])
            columns = columns[:, np.argsort(columns[0])]
        return columns[0], columns[1], columns[2].astype(int)

    def _off(self, place: float) -> float:
        return float(self.sampled(place)[0][0]) - self.value

    def _root(self, low: float, high: float) -> float:
        try:
            return float(brentq(self._off, low, high, xtol=1e-16, rtol=1e-15))
        except ValueError:  # both ends are the value, to rounding
            return low

    def _jump(self, low: float, high: float) -> Jump:
        result, label = self.sampled(np.array([low, high]))
        sides = []
        for code, value in zip(label.tolist(), result.tolist(), strict=True):
            outcome, criterion = divmod(code // _SIDES, _KINDS)
            sides += [OUTCOMES[outcome] + (f" by {REVERSALS[criterion - 1]}" if criterion else ""), value]
        return Jump(float(self.at((low + high) / 2)), *sides)

    def _confirmed(self, place: float, size: float) -> Solution:
        """A root that a collision of its own confirms, with derivatives.

        The collision may miss the value by as much as it changes nearby: beside a boundary every error is amplified.
        """
        root, beside = float(self.at(place)), self.sampled(np.clip(place + _SAME * np.array([-1, 1]), 0, 1))[0]
        allowed = _AGREES * size + float(np.nan_to_num(np.abs(beside - self.value)).max())
        if self.free in MEETING:
            scene = self.scene.with_impact(**{self.free.partition(".")[2]: root})
        else:
            scene = self.scene.with_si({self.free: root}, self.hold)
        collision, (of, _, term) = collide(scene, rtol=self.rtol), self.of.partition(".")
        result = getattr(collision.energy, term) if term else getattr(collision, of)
        if result is None or not abs(result - self.value) <= allowed:
            message = f"the collision with {self.free} = {root!r} has {self.of} {result}, not {self.value:g}"
            raise ComputationError(message, advice="it lies within the error of a boundary; try a smaller rtol")
        if self.of not in DIFFERENTIATED:
            return Solution(root, collision.outcome)
        try:
            slopes = sensitivities(scene, [self.of], hold=self.hold, rtol=self.rtol).gradient[self.of]
        except WetDoubletError as error:  # too near a boundary
            return Solution(root, collision.outcome, reason=str(error))
        by_free = slopes.get(self.free)
        if not by_free:
            return Solution(root, collision.outcome, reason=f"{self.of} does not change with {self.free} there")
        same = SPEEDS if self.free in SPEEDS else (self.free,)
        gradient = {name: -slope / by_free for name, slope in slopes.items() if name not in same and slope is not None}
        return Solution(root, collision.outcome, gradient | {self.of: 1 / by_free})


class Solutions(list[float]):
    """The values of the entry at which the result has its target, SI, ascending.

    Attributes:
        found: each with outcome and derivatives.
        jumps: where the target is passed and not taken.
        throughout: parts of the range in which the result has its target all along.
        attained: least and greatest result of the samples of the range; None if it is not defined anywhere.
        remarks: what was not seen, a sentence each.
    """

    def __init__(
        self, asked: Search, roots: Sequence[Solution], jumps: Sequence[Jump],
        throughout: Sequence[tuple[float, float]], attained: tuple[float, float] | None, remarks: Sequence[str],
    ) -> None:  # fmt: skip
        super().__init__(root.value for root in roots)
        self.asked, self.found, self.jumps, self.throughout = asked, tuple(roots), tuple(jumps), tuple(throughout)
        self.attained, self.remarks = attained, tuple(remarks)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet solve --json`."""
        asked = self.asked
        return {
            "solutions": list(self),
            "outcomes": [root.outcome for root in self.found],
            "gradients": [dict(root.gradient) for root in self.found],
            "jumps": [vars(jump) for jump in self.jumps],
            "throughout": self.throughout,
            "attained": self.attained,
            "free": asked.free,
            "within": [asked.low, asked.high],
            "of": {asked.of: asked.value},
            "units": {asked.free: asked.scene.fields[asked.free].unit or "1", asked.of: DEFINITIONS[asked.of].unit},
            **origin(asked.scene),
        }

    def __str__(self) -> str:
        asked, result = self.asked, DEFINITIONS[self.asked.of]
        unit, of_result = asked.scene.fields[asked.free].unit or "", result.unit.removeprefix("1")
        span = f"{asked.free} from {asked.low:.6g} to {asked.high:.6g} {unit}".rstrip()
        lines = [f"{name_of(asked.scene)}: {result.label} = {asked.value:.6g} {of_result}".rstrip() + f", {span}"]
        lines += [f"  {root.value:.10g} {unit}".rstrip() + f"  {root.outcome}" for root in self.found]
        lines += [f"  all along from {low:.6g} to {high:.6g} {unit}".rstrip() for low, high in self.throughout]
        if len(lines) == 1:
            others = self.attained and "; collisions there have {:.6g} to {:.6g}".format(*self.attained)
            lines.append(f"  none: no {span} has it{others or ''}")
        lines += [f"  jumped over at {jump}" for jump in self.jumps]
        lines += [f"  no derivatives at {root.value:.6g}: {root.reason}" for root in self.found if root.reason]
        lines += [f"  {text}" for text in self.remarks]
        names = dict.fromkeys(name for root in self.found for name, slope in root.gradient.items() if slope)
        rows = [[name, *(f"{root.gradient.get(name, float('nan')):.6g}" for root in self.found)] for name in names]
        return "\n".join([*lines, *(["", f"d({asked.free})/dp, SI", *numbers_aligned(rows)] if rows else [])])

    __repr__ = __str__  # what a notebook shows


def _runs(at_value: np.ndarray, regime: np.ndarray) -> list[tuple[int, int]]:
    """First and last indices of at least three samples one after another that have the value in one regime."""
    group = np.cumsum(np.append(True, (np.diff(regime) != 0) | (np.diff(at_value.astype(int)) != 0)))
    runs = (np.flatnonzero(group == number) for number in np.unique(group[at_value]))
    return [(int(run[0]), int(run[-1])) for run in runs if run.size > 2]
