"""Free entries of a fit: scale, bounds and prior of each, and how their values and combinations are worded.

An entry that is positive by its meaning varies in its logarithm; fractions and angles vary as they are.
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..boundaries.experiment import Rows, free_names
from ..errors import InputError
from ..host.arguments import check_mapping, check_names
from ..scene import units
from ..scene.fields import ANY, FRACTION, NOT_NEGATIVE, PART, POISSON, POSITIVE, WETTING_ANGLE
from ..scene.scene import Scene
from ..sensitivity.parameters import refuse_texts
from .measurements import Measurements, rows_of

IDENTIFIED = "identified"
ONE_SIDE = "bounded on one side"
COMBINED = "only in combination"
NOT_AT_ALL = "not identifiable from these data"
"""The four verdicts on an entry."""

_TIED = 0.95  # correlation from which two identified entries are reported as a combination too
_LEAST_POWER = 0.1  # least exponent that is worth naming, relative to the largest
_BETTER = 10.0  # a combination is reported if it is known better than its entries by this factor
_RANGE = 1e3  # factor to either side of the scene's value within which a positive entry is looked for
_SPAN = {FRACTION: (0.0, 1.0), PART: (1e-6, 1.0), POISSON: (-0.999, 0.5), WETTING_ANGLE: (0.0, math.pi / 2)}
_BISECTIONS = 40
NOISE = "noise."
"""Before the name of a result, or of speed or angle: a factor of its standard deviations, as a free entry."""
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
class Normalisation:
    """What a noise f adds to the log-likelihood, -count log(f), as one more of the squares that a fit minimises.

    Attributes:
        count: number of the measured values.
        low: least noise; there the square is 1.
    """

    count: int
    low: float

    @property
    def offset(self) -> float:
        return 0.5 - self.count * math.log(self.low)

    def misfit(self, value: float) -> tuple[float, float]:
        """The root of the square, and its derivative by the value."""
        root = math.sqrt(1 + 2 * self.count * math.log(value / self.low))
        return root, self.count / (value * root)


@dataclass(frozen=True)
class FreeEntry:
    """An entry to be estimated.

    Attributes:
        value: of the scene, SI; the first guess.
        log: varied in its logarithm.
        low, high: bounds of the search, SI.
    """

    name: str
    value: float
    log: bool
    low: float
    high: float
    prior: Prior | Normalisation | None = None

    def inner(self, value: float) -> float:
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
        return tuple(entry.name for entry in self.entries)

    @property
    def size(self) -> int:
        return len(self.entries)

    @property
    def logarithmic(self) -> np.ndarray:
        """Mask of the entries that vary in their logarithms."""
        return np.array([entry.log for entry in self.entries])

    @property
    def start(self) -> np.ndarray:
        return np.array([entry.inner(entry.value) for entry in self.entries])

    @property
    def low(self) -> np.ndarray:
        return np.array([entry.inner(entry.low) for entry in self.entries])

    @property
    def high(self) -> np.ndarray:
        return np.array([entry.inner(entry.high) for entry in self.entries])

    @property
    def vague(self) -> np.ndarray:
        """The information of the range of the search: that of a standard deviation of half the range."""
        return np.diag((2.0 / (self.high - self.low)) ** 2)

    def inner(self, values: np.ndarray) -> np.ndarray:
        """The variables of the search at values of the entries, SI."""
        return np.array([entry.inner(float(value)) for entry, value in zip(self.entries, values, strict=True)])

    def values(self, inner: np.ndarray) -> np.ndarray:
        return np.array([entry.outer(float(value)) for entry, value in zip(self.entries, inner, strict=True)])

    def named(self, inner: np.ndarray) -> dict[str, float]:
        return dict(zip(self.names, self.values(inner).tolist(), strict=True))

    def rates(self, values: np.ndarray) -> np.ndarray:
        """Derivatives of the values by the variables of the search."""
        return np.array([value if entry.log else 1.0 for entry, value in zip(self.entries, values, strict=True)])

    def misfits(self, inner: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distance of each entry from its prior's centre, in standard deviations, and its derivative; 0 without one."""
        values = self.values(inner)
        pairs = [
            (0.0, 0.0) if entry.prior is None else entry.prior.misfit(float(value))
            for entry, value in zip(self.entries, values, strict=True)
        ]
        misfits, slopes = np.array(pairs).T
        return misfits, slopes * self.rates(values)


def free_entries(
    scene: Scene,
    names: Sequence[str] | str,
    data: Measurements,
    priors: Mapping[str, str] | None = None,
    rtol: float = 1e-9,
) -> FreeEntries:
    """The checked free entries of a scene.

    Raises:
        InputError: an entry that the scene has not, that is a choice, or varies in the data; one without a first
            guess; a prior of another entry.
    """
    candidates = free_names(scene)
    refuse_texts(scene, names, candidates, "free")
    chosen = check_names(names, candidates, "free", "names no entry")
    for name in chosen:
        if name in data.columns:
            raise InputError("free", name, "entries that are not a column of the data", "is given row by row")
    accepted = 'entries and priors, {"NAME": "2 um +- 20 %"}'
    priors = {} if priors is None else check_mapping(priors, "prior", accepted)
    for name in priors:
        if name not in chosen:
            raise InputError("prior", name, ", ".join(chosen), "is not free")
    rows = rows_of(scene, chosen, data, rtol)
    start = np.array([float(scene.entries[name]) for name in chosen])
    for row in np.flatnonzero(~rows.unchecked(start).possible)[:1].tolist():
        values_there = ", ".join(f"{name} = {values[row]:.6g}" for name, values in data.columns.items())
        field = f"data, {data.label(row)}, column {', '.join(data.columns)}"
        raise InputError(
            field, values_there, "values that make a scene together with its other entries", "is impossible"
        )
    entries = []
    for k, name in enumerate(chosen):
        entry = scene.fields[name]
        if entry.range in (POSITIVE, NOT_NEGATIVE) and start[k] <= 0:
            raise InputError("free", name, "an entry with a first guess above 0", "is 0 in the scene")
        log = entry.range not in _SPAN and entry.range is not ANY and start[k] > 0
        low, high = _SPAN.get(entry.range, (start[k] / _RANGE, start[k] * _RANGE) if log else (-1e3, 1e3))
        low, high = (_feasible(rows, start, k, end) for end in (low, high))
        prior = _prior(scene, name, priors[name], log) if name in priors else None
        entries.append(FreeEntry(name, float(start[k]), log, low, high, prior))
    return FreeEntries(tuple(entries))


def _feasible(rows: Rows, start: np.ndarray, k: int, end: float) -> float:
    """The end of the range of entry k, or where towards it the scene becomes impossible."""
    values = start.copy()

    def possible(value: float) -> bool:
        values[k] = value
        return rows.at(values) is not None

    if possible(end):
        return end
    good, bad = float(start[k]), end
    for _ in range(_BISECTIONS):
        middle = math.sqrt(good * bad) if good > 0 and bad > 0 else (good + bad) / 2
        good, bad = (middle, bad) if possible(middle) else (good, middle)
    return good


def _prior(scene: Scene, name: str, text: object, log: bool) -> Prior:
    """A prior from text such as "2 um +- 20 %" (relative) or "2 um +- 0.4 um"."""
    accepted = f'{name} as VALUE +- SD, such as "{scene.fields[name].example.strip(chr(34))} +- 20 %"'
    parts = _SEPARATOR.split(text.strip()) if isinstance(text, str) else []
    if len(parts) != 2 or not all(parts):
        raise InputError("prior", text, accepted, f"is no prior of {name}")
    centre = scene.si_number(name, parts[0], f"prior {name}")
    if parts[1].endswith("%"):
        try:
            sd = float(parts[1][:-1]) / 100
        except ValueError:
            raise InputError("prior", text, accepted, f"is no prior of {name}") from None
        relative = log and centre > 0
        prior = Prior(centre, sd if relative else sd * abs(centre), relative)
    else:
        prior = Prior(centre, scene.si_number(name, parts[1], f"prior {name}"), False)
    if not (prior.sd > 0 and math.isfinite(prior.sd)):
        raise InputError("prior", text, accepted, "has no positive standard deviation")
    return prior


def combinations(
    free: FreeEntries, information: np.ndarray, verdicts: Sequence[str], subject: str = "The data"
) -> tuple[str, ...]:
    """Sentences on products of powers of entries that are known better than the entries.

    Arguments:
        information: matrix in the variables of the search, which are logarithms for the entries named.
        subject: of the sentences, in the plural.
    """
    covariance = np.linalg.pinv(information + free.vague)
    correlation = covariance / np.sqrt(np.outer(np.diag(covariance), np.diag(covariance)))
    np.fill_diagonal(correlation, 0.0)
    tied = [
        k
        for k, verdict in enumerate(verdicts)
        if free.entries[k].log
        and information[k, k] > 1e-12
        and (verdict == COMBINED or (np.abs(correlation[k]) > _TIED).any())
    ]
    if len(tied) < 2:
        return ()
    values, vectors = np.linalg.eigh(np.linalg.inv(covariance[np.ix_(tied, tied)]))  # whatever the others are
    sentences = []
    for value, vector in zip(values[::-1], vectors.T[::-1], strict=True):
        if value <= 0 or value < _BETTER**2 * values[0]:
            break
        first = int(np.argmax(np.abs(vector)))
        powers = vector / vector[first]
        product = _product({free.names[tied[k]]: p for k, p in enumerate(powers.tolist()) if abs(p) >= _LEAST_POWER})
        error = abs(1 / np.sqrt(value) / vector[first])
        precision = f"to {100 * np.expm1(error):.2g} %" if error < 1 else f"to a factor of {np.exp(error):.2g}"
        open_ones = sum(verdicts[k] == COMBINED for k in tied)
        alone = f"; {'neither' if len(tied) == 2 else 'none of them'} alone" if open_ones == len(tied) else ""
        sentences.append(f"{subject} fix {product} {precision} (standard error){alone}.")
    return tuple(sentences)


def _product(powers: Mapping[str, float]) -> str:
    """A product of powers as text, negative ones as a denominator; the first of them positive."""
    if next(iter(powers.values())) < 0:
        powers = {name: -power for name, power in powers.items()}
    text = ""
    for name, power in powers.items():
        size = f"{abs(power):.2g}"
        text += (" / " if power < 0 else " * " if text else "") + name + (f"^{size}" if size != "1" else "")
    return text


def unit_shown(scene: Scene, name: str) -> tuple[str, float]:
    """The unit in which the scene gives an entry, and its size in SI; empty and 1 for a plain number."""
    if name.startswith(NOISE):
        return "", 1.0
    si = "m^3" if scene.ways.volume == "absolute" and name == "bridge.volume" else scene.fields[name].unit
    if si is None:
        return "", 1.0
    raw = dict(scene.given).get(name)
    written = units.unit_of(raw) if isinstance(raw, str) else ""
    return (written, units.factor(written, si, name, si, raw)) if written else (si, 1.0)


def in_unit(scene: Scene, name: str, value: float | None) -> str:
    """A value in SI as text with the scene's unit; a dash for none."""
    if value is None:
        return "-"
    unit, size = unit_shown(scene, name)
    return f"{value / size:.4g} {unit}".strip()


def interval(scene: Scene, name: str, low: float | None, high: float | None) -> str:
    """An interval in the scene's unit, open ends in words."""
    if low is None:
        return "open at both ends" if high is None else f"below {in_unit(scene, name, high)}"
    if high is None:
        return f"above {in_unit(scene, name, low)}"
    return f"{low / unit_shown(scene, name)[1]:.4g} to {in_unit(scene, name, high)}"
