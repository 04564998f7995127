"""Free entries of a fit: the scale on which each is varied, its bounds, and what was known of it before.

An entry that is positive by its meaning varies in its logarithm; fractions and angles vary as they are.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..host.arguments import check_names
from ..scene.scene import Scene
from ..scene.schema import ANY, FRACTION, NOT_NEGATIVE, PART, POISSON, POSITIVE, SPINS, WETTING_ANGLE
from ..sensitivity.parameters import known_of_particles
from .law import Law
from .measurements import Measurements

_RANGE = 1e3  # factor to either side of the scene's value within which a positive entry is looked for
_SPAN = {FRACTION: (0.0, 1.0), PART: (1e-6, 1.0), POISSON: (-0.999, 0.5), WETTING_ANGLE: (0.0, math.pi / 2)}
_BISECTIONS = 40
_SEPARATOR = re.compile(r"\s*(?:\+-|\+/-|±)\s*")


@dataclass(frozen=True)
class Prior:
    """What is known of an entry beforehand: Gaussian in the entry, or in its logarithm where `relative`."""

    centre: float
    sd: float
    relative: bool

    def misfit(self, value: float) -> tuple[float, float]:
        """Distance from the centre in standard deviations, and its derivative by the value."""
        if self.relative:
            return math.log(value / self.centre) / self.sd, 1 / (value * self.sd)
        return (value - self.centre) / self.sd, 1 / self.sd


@dataclass(frozen=True)
class FreeEntry:
    """An entry to be estimated.

    Attributes:
        value: of the scene, SI; the first guess.
        log: varied in its logarithm.
        low, high: bounds of the search, SI.
        unit: SI unit, empty for a number.
    """

    name: str
    value: float
    log: bool
    low: float
    high: float
    unit: str
    prior: Prior | None = None

    def inner(self, value: float) -> float:
        """The variable of the search."""
        return math.log(value) if self.log else value

    def outer(self, inner: float) -> float:
        """The value of the entry."""
        return math.exp(inner) if self.log else inner


@dataclass(frozen=True)
class FreeEntries:
    """The entries of a fit, in order, and the map to the variables of the search."""

    entries: tuple[FreeEntry, ...]

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(each.name for each in self.entries)

    @property
    def size(self) -> int:
        return len(self.entries)

    @property
    def start(self) -> np.ndarray:
        return np.array([each.inner(each.value) for each in self.entries])

    @property
    def low(self) -> np.ndarray:
        return np.array([each.inner(each.low) for each in self.entries])

    @property
    def high(self) -> np.ndarray:
        return np.array([each.inner(each.high) for each in self.entries])

    def values(self, inner: np.ndarray) -> np.ndarray:
        """Values of the entries, SI."""
        return np.array([each.outer(float(one)) for each, one in zip(self.entries, inner, strict=True)])

    def rates(self, values: np.ndarray) -> np.ndarray:
        """Derivatives of the values by the variables of the search."""
        return np.array([value if each.log else 1.0 for each, value in zip(self.entries, values, strict=True)])


def free_entries(
    scene: Scene,
    names: Sequence[str] | str,
    data: Measurements,
    priors: Mapping[str, str] | None = None,
    rtol: float = 1e-9,
    labels: tuple[str, str] = ("free", "prior"),
) -> FreeEntries:
    """The checked free entries of a scene.

    Raises:
        InputError: an entry that the scene has not, that is a choice, or varies in the data; one without a first
            guess; a prior of another entry.
    """
    known = tuple(name for name in known_of_particles(scene) if name not in SPINS)
    asked = check_names(names, known, labels[0])
    if not asked:
        raise InputError(labels[0], "", ", ".join(known), "names no entry")
    for name in asked:
        if name in data.columns:
            raise InputError(labels[0], name, "entries that are not a column of the data", "is given row by row")
    priors = {} if priors is None else priors
    for name in priors:
        if name not in asked:
            raise InputError(labels[1], name, ", ".join(asked), "is not free")
    law = Law(scene, asked, data, rtol)
    start = np.array([float(scene.entries[name]) for name in asked])
    for row in law.impossible(start)[:1].tolist():
        given = ", ".join(f"{name} = {values[row]:.6g}" for name, values in data.columns.items())
        field = f"data, {data.label(row)}, column {', '.join(data.columns)}"
        raise InputError(field, given, "values that make a scene together with its other entries", "is impossible")
    found = []
    for k, name in enumerate(asked):
        entry = scene.fields[name]
        if entry.range in (POSITIVE, NOT_NEGATIVE) and start[k] <= 0:
            raise InputError(labels[0], name, "an entry with a first guess above 0", "is 0 in the scene")
        log = entry.range not in _SPAN and entry.range is not ANY and start[k] > 0
        low, high = _SPAN.get(entry.range, (start[k] / _RANGE, start[k] * _RANGE) if log else (-1e3, 1e3))
        low, high = (_feasible(law, start, k, end) for end in (low, high))
        prior = _prior(scene, name, priors[name], log, labels[1]) if name in priors else None
        found.append(FreeEntry(name, float(start[k]), log, low, high, entry.unit or "", prior))
    return FreeEntries(tuple(found))


def _feasible(law: Law, start: np.ndarray, k: int, end: float) -> float:
    """The end of the range of entry k, or where towards it the scene becomes impossible."""
    values = start.copy()

    def holds(value: float) -> bool:
        values[k] = value
        return law.at(values) is not None

    if holds(end):
        return end
    good, bad = float(start[k]), end
    for _ in range(_BISECTIONS):
        middle = math.sqrt(good * bad) if good > 0 and bad > 0 else (good + bad) / 2
        good, bad = (middle, bad) if holds(middle) else (good, middle)
    return good


def _prior(scene: Scene, name: str, text: object, log: bool, label: str) -> Prior:
    """A prior from text such as "2 um +- 20 %" (relative) or "2 um +- 0.4 um"."""
    accepted = f'{name} as VALUE +- SD, such as "{scene.fields[name].example.strip(chr(34))} +- 20 %"'
    parts = _SEPARATOR.split(text.strip()) if isinstance(text, str) else []
    if len(parts) != 2 or not all(parts):
        raise InputError(label, text, accepted, f"is no prior of {name}")
    centre = scene.si_number(name, parts[0], f"{label} {name}")
    if parts[1].endswith("%"):
        try:
            sd = float(parts[1][:-1]) / 100
        except ValueError:
            raise InputError(label, text, accepted, f"is no prior of {name}") from None
        if log and centre > 0:
            prior = Prior(centre, sd, True)
        else:
            prior = Prior(centre, sd * abs(centre), False)
    else:
        prior = Prior(centre, scene.si_number(name, parts[1], f"{label} {name}"), False)
    if not (prior.sd > 0 and math.isfinite(prior.sd)):
        raise InputError(label, text, accepted, "has no positive standard deviation")
    return prior
