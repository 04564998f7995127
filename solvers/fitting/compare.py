"""Laws, films and criteria compared on the same data: AIC, and what each predicts of impacts left out of its fit."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np

from ..engines.settings import check_rtol
from ..errors import ComputationError, InputError, did_you_mean
from ..formatting.markdown import aligned
from ..host.arguments import check_function, check_names
from ..host.cores import usable_cores
from ..host.progress import Progress
from ..host.workers import in_workers
from ..scene.scene import Scene
from .fit import RTOL
from .free_entries import FreeEntries, in_unit
from .joint import Joint, Part, problem
from .measurements import Measurements, read_data
from .optimise import Objective, Optimum, maximum_with_aiming, optimise
from .scatter import Resolution

CHOICES = ("bridge.law", "model.film", "model.glass", "model.tangential", "model.arm", "pendulum.law")


@dataclass(frozen=True)
class Candidate:
    """A scene with other choices, fitted.

    Attributes:
        name: the choices, as "bridge.law = willett".
        log_likelihood, aic: at its most likely values; lower AIC is better.
        predicted: mean log-likelihood of a row under the scene fitted to the other folds; None without folds.
        estimates: most likely values, SI.
        reason: why there are none of these.
    """

    name: str
    log_likelihood: float | None = None
    aic: float | None = None
    predicted: float | None = None
    estimates: Mapping[str, float] | None = None
    reason: str = ""


@dataclass(frozen=True)
class Comparison:
    """Candidates, the best by AIC first, those without a fit last."""

    scene: Scene
    candidates: tuple[Candidate, ...]

    def to_dict(self) -> list[dict[str, Any]]:
        """The JSON of the comparison."""
        records = [asdict(each) for each in self.candidates]
        return [{"choice": each.pop("name"), **each, "reason": each["reason"] or None} for each in records]

    def __str__(self) -> str:
        """A table; AIC as the difference from the best."""
        names = list(next((each.estimates for each in self.candidates if each.estimates), {}))
        least = min((each.aic for each in self.candidates if each.aic is not None), default=0.0)
        cells = [["choice", "AIC - best", "log-likelihood", "predicted per impact", *names]]
        for each in self.candidates:
            if each.aic is None or each.estimates is None:
                cells.append([each.name, each.reason, *[""] * (2 + len(names))])
                continue
            predicted = "-" if each.predicted is None else f"{each.predicted:.3f}"
            values = [in_unit(self.scene, name, each.estimates[name]) for name in names]
            cells.append([each.name, f"{each.aic - least:.2f}", f"{each.log_likelihood:.2f}", predicted, *values])
        return "\n".join(aligned(cells))


def compare_models(
    scene: Scene | str | Path,
    data: Any,
    free: Sequence[str] | str,
    *,
    over: Sequence[str] | str = ("bridge.law",),
    prior: Mapping[str, str] | None = None,
    folds: int = 5,
    rtol: float = RTOL,
    seed: int = 0,
    progress: Progress | None = None,
) -> Comparison:
    """Fit the scene and, for each named choice, the scene with every other value of it; these on all cores.

    Arguments:
        scene, data, free, prior, rtol: as of `fit`.
        over: choices by dotted name, of `CHOICES`; each is varied alone.
        folds: of the cross-validation; 0 for none.
        seed: of the folds.
        progress: called with (candidates fitted, candidates in all).

    Returns:
        Comparison: the candidates, the best by AIC first.

    Raises:
        InputError: as of `fit`, and a choice that the scene has not.

    Example:
        >>> from wetdoublet.solvers import compare_models
        >>> seen = {"speed": [0.1, 0.2, 0.3, 0.4], "angle": [0.8] * 4, "outcome": ["stick", "stick", "SRS", "SRS"]}
        >>> both = compare_models("granulation", seen, "liquid.viscosity", over="model.arm", folds=0)
        >>> [each.name for each in both.candidates if each.aic is None]
        []
    """
    first = Scene.load(scene)
    table = read_data(data, first)
    names = check_choices(first, over)
    if not isinstance(folds, int) or isinstance(folds, bool) or folds < 0 or folds == 1:
        raise InputError("folds", folds, "a whole number from 2, or 0 for no cross-validation")
    tolerance = check_rtol(rtol)
    check_function(progress, "progress")
    unchanged, *others = _scenes(first, names)
    tell = progress or (lambda _done, _total: None)
    tell(0, 1 + len(others))
    request = table, free, prior, min(folds, table.size), tolerance, seed
    candidates = [_candidate(unchanged[0], unchanged[1], *request)]
    cores = min(usable_cores(), len(others))
    tell(1, 1 + len(others))
    parts = ((name, (name, scene, *request)) for name, scene in others)
    tried = in_workers(cores, _tried, parts) if cores > 1 else ((name, _tried(*part)) for name, part in parts)
    for _, each in tried:
        candidates.append(each)
        tell(len(candidates), 1 + len(others))
    order = sorted(candidates, key=lambda each: (np.inf if each.aic is None else each.aic, each.name))
    return Comparison(first, tuple(order))


def check_choices(scene: Scene, over: Sequence[str] | str) -> tuple[str, ...]:
    """The names of `over`; InputError for one that is no choice, or of a table that the scene has not."""
    names = check_names(over, CHOICES, "over")
    known = [each for each in CHOICES if getattr(scene, each.partition(".")[0]) is not None]
    for name in names:
        if name not in known:
            problem = "is of a table that the scene has not" + did_you_mean(name, known)
            raise InputError("over", name, ", ".join(known), problem)
    return tuple(names)


def _scenes(first: Scene, names: Sequence[str]) -> list[tuple[str, Scene | InputError]]:
    """The scene and those with another choice, each with its name; an InputError where a choice is not possible."""
    current = {name: str(attrgetter(name)(first)) for name in names}
    scenes: list[tuple[str, Scene | InputError]] = [(", ".join(f"{name} = {current[name]}" for name in names), first)]
    for name in names:
        for other in first.fields[name].choices:
            if other != current[name]:
                try:
                    scenes.append((f"{name} = {other}", first.with_entries({name: other})))
                except InputError as error:
                    scenes.append((f"{name} = {other}", error))
    return scenes


def _tried(name: str, *request: Any) -> Candidate:
    """A candidate, or why there is none; arguments as of `_candidate`."""
    try:
        return _candidate(name, *request)
    except (InputError, ComputationError) as error:
        return Candidate(name, reason=str(error))


def _candidate(
    name: str, scene: Scene | InputError, data: Measurements, free: Sequence[str] | str,
    prior: Mapping[str, str] | None, folds: int, rtol: float, seed: int,
) -> Candidate:  # fmt: skip
    if isinstance(scene, InputError):
        raise scene
    (part,), entries = problem(scene, data, free, prior, (), rtol)
    likelihood = Joint((part,), entries.names, rtol)
    best = optimise(likelihood, entries)
    height = Objective(likelihood, entries, Resolution()).log_likelihood(best.inner)
    predicted = _predicted(part, entries, prior, best, folds, rtol, seed) if folds > 1 else None
    return Candidate(name, height, 2 * entries.size - 2 * height, predicted, entries.named(best.inner))


def _predicted(
    part: Part, free: FreeEntries, prior: Mapping[str, str] | None, best: Optimum, folds: int, rtol: float, seed: int
) -> float:
    """Mean log-likelihood of a row under the scene that is fitted to the rows of the other folds."""
    data = part.data

    def objective(rows: np.ndarray) -> Objective:
        parts, own = problem(part.scene, data.part(rows), free.names, prior, (), rtol)
        return Objective(Joint(parts, free.names, rtol), own, Resolution())

    order = np.random.default_rng(seed).permutation(data.size)
    total = 0.0
    for k in range(folds):
        left = np.sort(order[k::folds])
        kept = np.setdiff1d(order, left)
        train, test = objective(kept), objective(left)
        fitted = maximum_with_aiming(train.likelihood, train.free, best.inner)
        test.likelihood.aim(free.values(fitted.inner))
        total += test.log_likelihood(fitted.inner)
    return total / data.size
