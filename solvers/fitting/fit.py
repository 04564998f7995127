"""`fit()`: parameters of a scene from measured impacts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import chi2

from ...generated.automaton import OUTCOMES, STICK
from ..errors import ComputationError
from ..host.arguments import check_mapping
from ..model.validity import warn
from ..scene.scene import Scene
from ..settings import check_rtol
from .data import read_data
from .estimates import CONTRADICTED, Estimate, Rows
from .free_entries import FreeEntries, free_entries
from .likelihood import Likelihood, Resolution
from .measurements import UNKNOWN, Measurements
from .objective import Objective, whitening
from .optimise import Optimum, optimise, settled
from .profiles import DROP, End, beyond, checked, end
from .result import Fit, log_density
from .shown import in_unit
from .verdicts import IDENTIFIED, NOT_AT_ALL, combinations, judged

RTOL = 1e-8
"""Relative tolerance of the collisions of a fit."""
_RESTARTS = 3  # times that a more likely point, met on a profile, replaces the maximum
_ROUNDS = 5  # in which ends are moved beyond likely points
_ONE_OUTCOME = "Such data can only bound an entry; within the bounds no value is better than another."
_ODD = 1e-3  # probability of residuals as large as found below which they are remarked on
_UNDECIDED = 1e-3  # probability of impacts without an outcome that is remarked on
_COARSE = 0.05  # error of the log-likelihood by quadrature that is remarked on


def fit(
    scene: Scene | str | Path,
    data: Any,
    free: Sequence[str] | str,
    *,
    prior: Mapping[str, str] | None = None,
    rtol: float = RTOL,
    starts: int = 16,
    seed: int = 0,
) -> Fit:
    """Estimate entries of a scene from measured impacts.

    Arguments:
        scene: a Scene, a path or a preset's name; its values of the free entries are a first guess.
        data: a CSV file, a DataFrame, a Dataset, a mapping of columns, or Measurements (see `read_data`).
        free: entries to estimate, by dotted name.
        prior: what is known of free entries, as {"particles.roughness": "2 um +- 20 %"}: Gaussian in the logarithm
            where the standard deviation is in %, else in the entry.
        rtol: relative tolerance of the collisions.
        starts: quasi-random points from which the best are followed, beside the scene's own values.
        seed: of these points.

    Returns:
        Fit: estimates, 95 % profile-likelihood intervals and verdicts; what each row says of them.

    Raises:
        InputError: a wrong entry, or a bad cell, named by row and column.
        ComputationError: the scene's collisions are not differentiated by a compiled kernel.

    Example:
        >>> from wetdoublet.solvers import fit
        >>> speeds = [0.3, 0.8, 1.2, 1.6, 1.9, 2.2, 2.5, 3.0]
        >>> seen = ["stick"] * 5 + ["bounce"] * 3
        >>> found = fit("granulation", {"speed": speeds, "angle": [0.0] * 8, "outcome": seen}, "liquid.viscosity")
        >>> found.estimates["liquid.viscosity"].verdict
        'identified'
    """
    first = Scene.load(scene)
    rtol = check_rtol(rtol)
    table = data if isinstance(data, Measurements) else read_data(data, first)
    priors = None if prior is None else check_mapping(prior, "prior", 'entries and priors, {"NAME": "2 um +- 20 %"}')
    entries = free_entries(first, free, table, priors, rtol)
    warn(first)
    likelihood = Likelihood(first, entries.names, table, rtol)
    best = optimise(likelihood, entries, starts, seed)
    best, ends = _intervals(likelihood, entries, best)
    return _result(first, table, likelihood, entries, best, ends)


def log_likelihood(
    scene: Scene | str | Path, data: Any, free: Sequence[str] | str, *, prior: Mapping[str, str] | None = None,
    rtol: float = RTOL, resolution: Resolution | None = None,
) -> LogLikelihood:  # fmt: skip
    """The log-density of a fit and its gradient as a plain function, for samplers and optimisers of one's own.

    Arguments:
        scene, data, free, prior, rtol: as of `fit`. The lines through the scatter are turned for the scene's values.
        resolution: of the integrals.

    Returns:
        LogLikelihood: a function of a mapping or sequence of values, SI.

    Example:
        >>> from wetdoublet.solvers import log_likelihood
        >>> seen = {"speed": [1.0, 2.1], "angle": [0.2, 0.2], "outcome": ["stick", "bounce"]}
        >>> density = log_likelihood("granulation", seen, ["liquid.viscosity"])
        >>> value, gradient = density({"liquid.viscosity": 2.0})
        >>> sorted(gradient)
        ['liquid.viscosity']
    """
    first = Scene.load(scene)
    table = data if isinstance(data, Measurements) else read_data(data, first)
    entries = free_entries(first, free, table, prior, check_rtol(rtol))
    likelihood = Likelihood(first, entries.names, table, rtol)
    likelihood.aim(entries.values(entries.start))
    return LogLikelihood(Objective(likelihood, entries, resolution or Resolution(quick=False)))


class LogLikelihood:
    """A log-density of the free entries; `log_likelihood` makes it."""

    def __init__(self, objective: Objective) -> None:
        self.objective = objective

    @property
    def names(self) -> tuple[str, ...]:
        return self.objective.free.names

    def __call__(self, values: Mapping[str, float] | Sequence[float]) -> tuple[float, dict[str, float]]:
        """Value and gradient at values of all free entries, by name or in order, SI."""
        by_name = values if isinstance(values, Mapping) else dict(zip(self.names, values, strict=True))
        return log_density(self.objective, by_name)


def _intervals(likelihood: Likelihood, free: FreeEntries, best: Optimum) -> tuple[Optimum, list[tuple[End, End]]]:
    """The maximum, and the ends of all intervals; a more likely point that is met on the way becomes the maximum."""
    for _ in range(_RESTARTS):
        objective = Objective(likelihood, free, Resolution())
        ends: list[tuple[End, End]] = []
        better = None
        for k in range(free.size):
            ends.append((end(objective, best.inner, k, -1.0), end(objective, best.inner, k, 1.0)))
            better = next((each.better for each in ends[-1] if each.better is not None), None)
            if better is not None:
                break
        if better is None:
            ends, better = _checked(objective, best.inner, ends)
        if better is None:
            return best, ends
        again = settled(likelihood, free, better)
        best = Optimum(again.inner, again.value, best.others)
    advice = "give priors, free fewer entries, or start from other values"
    raise ComputationError("the likelihood has no maximum that its profiles agree on", advice=advice)


def _checked(
    objective: Objective, inner: np.ndarray, ends: list[tuple[End, End]]
) -> tuple[list[tuple[End, End]], np.ndarray | None]:
    """The ends, each looked for from the other intervals' ends too, and a point more likely than the maximum if met."""
    now = [list(pair) for pair in ends]
    for k in range(objective.free.size):
        for side in (0, 1):
            known = [each.inner for j, pair in enumerate(now) for each in pair if j != k]
            now[k][side] = checked(objective, inner, k, now[k][side], known)
            if now[k][side].better is not None:
                return ends, now[k][side].better
    for _ in range(_ROUNDS):  # what was seen on the way to one end may lie outside another
        moved = False
        for k in range(objective.free.size):
            for side, sign in enumerate((-1.0, 1.0)):
                point = beyond(objective, inner, k, now[k][side], sign < 0)
                if point is None:
                    continue
                way = (point - inner) / abs(point[k] - inner[k])
                now[k][side], moved = end(objective, inner, k, sign, DROP, point, way), True
                if now[k][side].better is not None:
                    return ends, now[k][side].better
        if not moved:
            break
    return [(below, above) for below, above in now], None


def _result(
    first: Scene, data: Measurements, likelihood: Likelihood, free: FreeEntries, best: Optimum,
    ends: list[tuple[End, End]],
) -> Fit:  # fmt: skip
    objective = Objective(likelihood, free, Resolution())
    inner = best.inner
    information = objective.information(inner)
    values = free.values(inner)
    white = whitening(objective, inner)
    rows = _rows(data, likelihood, free, objective, inner, white)
    verdicts = [NOT_AT_ALL if rows.contradicted else judged(objective, inner, k, *both) for k, both in enumerate(ends)]
    if _only_outcome(data) is not None:
        flat = [verdict == IDENTIFIED and each.prior is None for verdict, each in zip(verdicts, free.entries)]
        verdicts = [NOT_AT_ALL if each else verdict for each, verdict in zip(flat, verdicts)]
    estimates = {}
    for k, (name, (below, above)) in enumerate(zip(free.names, ends, strict=True)):
        low, high = (None if each.open else float(free.values(each.inner)[k]) for each in (below, above))
        estimates[name] = Estimate(float(values[k]), low, high, verdicts[k])
    covariance = white @ white.T
    spread = np.sqrt(np.diag(covariance))
    evaluation = objective.at(inner)
    assert evaluation is not None
    finer = likelihood(values, Resolution().doubled())
    error = np.nan if finer is None else finer.value - evaluation.value
    others = tuple((dict(zip(free.names, free.values(each.inner).tolist())), each.value) for each in best.others)
    remarks = [*data.remarks, *_remarks(first, data, rows, evaluation.undecided, error, others)]
    if rows.contradicted:
        remarks.insert(0, CONTRADICTED)
    if any(each.prior is not None for each in free.entries):
        remarks.append("Intervals and verdicts are those of the likelihood times the priors.")
    changed = first.with_si({name: each.value for name, each in estimates.items()})
    return Fit(
        changed, first, data, estimates, evaluation.value, covariance / np.outer(spread, spread),
        combinations(free, information, verdicts), tuple(remarks), rows, float(error), others, objective,
        tuple((below.inner, above.inner) for below, above in ends),
    )  # fmt: skip


def _only_outcome(data: Measurements) -> str | None:
    """The outcome of all impacts, if they have one and nothing else was measured."""
    codes = set(data.outcome.tolist())
    return None if len(codes) > 1 or UNKNOWN in codes or data.separated.any() else OUTCOMES[codes.pop()]


def _rows(
    data: Measurements, likelihood: Likelihood, free: FreeEntries, objective: Objective, inner: np.ndarray,
    white: np.ndarray,
) -> Rows:  # fmt: skip
    evaluation = objective.at(inner)
    assert evaluation is not None
    residual = {}
    for name in likelihood.of:
        measured, sd = data.observed[name]
        with np.errstate(invalid="ignore"):
            residual[name] = (measured - evaluation.mean[name]) / np.hypot(sd, evaluation.spread[name])
    scores = evaluation.scores * free.rates(free.values(inner))
    pull = np.linalg.norm(scores @ white, axis=1)
    relative = evaluation.plain - likelihood.constant
    return Rows(evaluation.probability, evaluation.mean, residual, relative, pull)


def _remarks(
    first: Scene, data: Measurements, rows: Rows, undecided: np.ndarray, error: float,
    others: tuple[tuple[dict[str, float], float], ...],
) -> list[str]:  # fmt: skip
    said = []
    if (word := _only_outcome(data)) is not None:
        alike = "stick" if word == STICK else f"have the outcome {word}, and no result was measured"
        said.append(f"All impacts {alike}. {_ONE_OUTCOME}")
    odd = rows.contradicting
    if odd.size:
        names = ", ".join(data.label(k) for k in odd[:8].tolist()) + (" ..." if odd.size > 8 else "")
        verb = "contradicts" if odd.size == 1 else "contradict"
        said.append(
            f"{odd.size} of {data.size} impacts {verb} the model at these estimates ({names}): their scatter does not "
            "allow what was observed. They count less than others."
        )
    if undecided.max(initial=0.0) > _UNDECIDED:
        worst = int(np.argmax(undecided))
        said.append(
            f"Of the scatter of an impact ({data.label(worst)}), {100 * undecided[worst]:.2g} % has no outcome: "
            "its collisions take more steps than an integration may. This part counts as not observed."
        )
    for name, residual in rows.residual.items():
        known = residual[np.isfinite(residual)]
        if known.size and chi2.sf(float((known**2).sum()), known.size) < _ODD:
            rms = float(np.sqrt((known**2).mean()))
            said.append(
                f"Residuals of {name} are {rms:.2g} times what scatter and noise allow: the model does not fit, or "
                "they are larger than given. The intervals are then too narrow."
            )
    if not abs(error) < _COARSE:
        said.append(
            f"The integrals over the scatter are uncertain: the log-likelihood changes by {error:.2g} with finer ones."
        )
    if others:
        values = ", ".join(f"{name} = {in_unit(first, name, value)}" for name, value in others[0][0].items())
        said.append(
            f"The likelihood has {len(others) + 1} separate maxima. At the next, {values}, the log-likelihood is "
            f"{others[0][1]:.3f}."
        )
    return said


__all__ = ["DROP", "RTOL", "Fit", "LogLikelihood", "fit", "log_likelihood"]
