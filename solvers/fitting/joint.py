"""One likelihood of several sets of impacts, each of a scene of its own: entries that they share, and their own.

Noise may be free as well: `noise.restitution` is a factor of the standard deviations that the data give.
"""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..boundaries.experiment import free_names
from ..errors import InputError
from ..host.arguments import check_mapping, check_names
from ..scene.scene import Scene
from ..sensitivity.parameters import refuse_texts
from .data_table import read_data
from .free_entries import NOISE, FreeEntries, FreeEntry, Normalisation, free_entries, in_unit
from .likelihood import Evaluation, Likelihood
from .measurements import SCATTER, Measurements, stacked
from .scatter import Resolution

_MOST = 3.0  # factor to either side within which noise is looked for
_WIDEST = 0.33  # largest relative scatter of a speed, and largest scatter of an angle (rad)


@dataclass(frozen=True)
class Part:
    """Impacts of one scene.

    Attributes:
        label: the scene's name, if it is its own, else its number from 1.
        scene: with the first guesses of its entries.
        entries: free entry of the scene or noise of the data -> its name in the fit.
    """

    label: str
    scene: Scene
    data: Measurements
    entries: Mapping[str, str]

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(name for name in self.entries if not name.startswith(NOISE))


def worded(parts: Sequence[Part], name: str, value: float | None) -> str:
    """The value of a free entry of a fit as text with the unit in which its scene gives it."""
    return in_unit(*home(parts, name), value)


def home(parts: Sequence[Part], name: str) -> tuple[Scene, str]:
    """The first scene that has a free entry of a fit, and the entry's name there."""
    return next((member.scene, own) for member in parts for own, entry in member.entries.items() if entry == name)


class Joint:
    """The sum of the log-likelihoods of parts, as a function of the values of all free entries.

    Arguments:
        names: of the free entries, in order.
        rtol: relative tolerance of the integrations.

    Attributes:
        size: number of impacts.
        constant: (impacts,), as of `Likelihood`.
        tell: called after each evaluation with its cost, relative to one of all parts at the usual resolution.
    """

    tell: Callable[[float], None] = staticmethod(lambda _cost: None)

    def __init__(self, parts: Sequence[Part], names: Sequence[str], rtol: float) -> None:
        self.parts = tuple(Likelihood(member.scene, tuple(member.entries), member.data, rtol) for member in parts)
        self._places = [[names.index(name) for name in member.entries.values()] for member in parts]
        self.size, self._width = sum(term.size for term in self.parts), len(names)
        self.constant = np.concatenate([term.constant for term in self.parts])
        for term in self.parts:
            term.tell = lambda cost, share=term.size / self.size: self.tell(share * cost)  # type: ignore[misc]

    def values(self, values: np.ndarray) -> list[np.ndarray]:
        return [values[places] for places in self._places]

    def aim(self, values: np.ndarray) -> None:
        for term, own in zip(self.parts, self.values(values), strict=True):
            term.aim(own)

    def refine(self, values: np.ndarray, tolerance: float, at_least: bool = False) -> bool:
        own = zip(self.parts, self.values(values), strict=True)
        more = [term.refine(values_of, tolerance, at_least) for term, values_of in own]
        return any(more)

    def __call__(self, values: np.ndarray, resolution: Resolution | None = None) -> Evaluation | None:
        """The log-likelihoods of all impacts; None where the values make a scene impossible."""
        evaluations = []
        for likelihood, own in zip(self.parts, self.values(values), strict=True):
            evaluation = likelihood(own, resolution)
            if evaluation is None:
                return None
            evaluations.append(evaluation)
        scores = np.zeros((self.size, self._width))
        at = np.cumsum([0, *(term.size for term in self.parts)])
        for places, result, first, last in zip(self._places, evaluations, at[:-1], at[1:], strict=True):
            scores[first:last, places] = result.scores
        rows, plain, probability, undecided = (
            np.concatenate([getattr(result, name) for result in evaluations])
            for name in ("rows", "plain", "probability", "undecided")
        )
        sizes = [term.size for term in self.parts]
        mean, spread = (stacked([getattr(block, name) for block in evaluations], sizes) for name in ("mean", "spread"))
        return Evaluation(rows, scores, plain, probability, undecided, mean, spread)


def problem(
    scene: Any,
    data: Any,
    free: Sequence[str] | str,
    prior: Mapping[str, str] | None,
    own: Sequence[str] | str | Mapping[str, Sequence[str]],
    rtol: float,
) -> tuple[tuple[Part, ...], FreeEntries]:
    """The checked parts and free entries of a fit; arguments as of `fit`."""
    several = isinstance(scene, (list, tuple))
    sources, tables = (list(scene), data) if several else ([scene], [data])
    if not isinstance(tables, (list, tuple)) or len(tables) != len(sources) or not sources:
        count = len(tables) if isinstance(tables, (list, tuple)) else 1
        raise InputError("data", f"{count} sets of impacts", f"one for each of the {len(sources)} scenes")
    scenes = [Scene.load(source, free=free) for source in sources]
    measured = [
        read_data(raw, first, f"data {k + 1}" if len(sources) > 1 else "data")
        for k, (raw, first) in enumerate(zip(tables, scenes, strict=True))
    ]
    times = Counter(setup.name for setup in scenes)
    labels = [setup.name if times[setup.name] == 1 and setup.name else str(k + 1) for k, setup in enumerate(scenes)]
    if len(set(labels)) < len(labels):  # a scene is called as another one's number
        labels = [str(k + 1) for k in range(len(scenes))]
    noise = [_noise(dataset) for dataset in measured]
    candidates = list(dict.fromkeys(name for k, setup in enumerate(scenes) for name in (*free_names(setup), *noise[k])))
    for setup in scenes:
        refuse_texts(setup, free, candidates, "free")
    chosen = check_names(free, candidates, "free", "names no entry")
    groups = _groups(own, chosen, labels)
    priors = (
        {} if prior is None else dict(check_mapping(prior, "prior", 'entries and priors, {"NAME": "2 um +- 20 %"}'))
    )
    merged: dict[str, FreeEntry] = {}
    parts, unused = [], {*priors}
    for k, (first, table) in enumerate(zip(scenes, measured, strict=True)):
        entries = {
            name: f"{name}@{groups[name][k]}" if name in groups else name
            for name in sorted(chosen, key=lambda entry: entry.startswith(NOISE))  # the noise last
            if name in (*free_names(first), *noise[k])
        }
        parts.append(Part(labels[k], first, table, entries))
        names = parts[-1].names
        told = {name: priors[label] for name in names for label in (entries[name], name) if label in priors}
        unused -= {*entries.values(), *names}
        entries_free = free_entries(first, names, table, told, rtol).entries if names else ()
        entries_free += tuple(_noise_entry(name, table) for name in entries if name not in names)
        for entry in entries_free:
            key = entries[entry.name]
            merged[key] = _both(merged[key], entry) if key in merged else replace(entry, name=key)
    for name in unused:
        raise InputError("prior", name, ", ".join(merged), "is not free")
    order = sorted(merged, key=lambda name: chosen.index(name.partition("@")[0]))
    return tuple(parts), FreeEntries(tuple(merged[name] for name in order))


def _groups(own: Any, chosen: Sequence[str], labels: Sequence[str]) -> dict[str, Sequence[str]]:
    """Entry that is not shared -> label of its value in each scene; an empty one stands for the scenes' own."""
    groups: dict[str, Any] = (
        dict(own) if isinstance(own, Mapping) else dict.fromkeys(check_names(own, chosen, "own"), labels)
    )
    for name, group in groups.items():
        check_names(name, chosen, "own")
        groups[name] = group = group or labels
        if isinstance(group, str) or len(group) != len(labels):
            raise InputError(f"own {name}", group, f"a label for each of the {len(labels)} scenes")
    return groups


def _noise(data: Measurements) -> list[str]:
    """The noise of the data that may be free."""
    scatter = [name for name in SCATTER if (getattr(data, f"{name}_sd") > 0).any()]
    return [f"{NOISE}{name}" for name in (*(n for n, c in _counts(data).items() if c), *scatter)]


def _counts(data: Measurements) -> dict[str, int]:
    """Result -> number of its values of which the likelihood holds a density."""
    return {name: int((data.separated & np.isfinite(value)).sum()) for name, (value, _) in data.observed.items()}


def _noise_entry(name: str, data: Measurements) -> FreeEntry:
    of, low, high = name.removeprefix(NOISE), 1 / _MOST, _MOST
    if of in SCATTER:
        size = data.speed_sd / data.speed if of == "speed" else data.angle_sd
        return FreeEntry(name, 1.0, True, low, max(min(high, _WIDEST / float(size.max())), 1.0))
    return FreeEntry(name, 1.0, True, low, high, Normalisation(_counts(data)[of], low))


def _both(first: FreeEntry, other: FreeEntry) -> FreeEntry:
    """An entry that two parts share."""
    low, high, prior = max(first.low, other.low), min(first.high, other.high), first.prior or other.prior
    if low >= high:
        raise InputError("free", first.name, "entries that have a value which all scenes may have", "has none")
    if isinstance(first.prior, Normalisation) and isinstance(other.prior, Normalisation):
        prior = replace(first.prior, count=first.prior.count + other.prior.count)
    return replace(first, low=low, high=high, prior=prior)
