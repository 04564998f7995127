"""`fit()`: parameters of a scene from measured impacts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import chi2

from ...generated.automaton import OUTCOMES, STICK
from ..engines.settings import check_rtol
from ..errors import several
from ..host.arguments import check_function
from ..host.progress import Estimated, Progress
from ..model.validity import warn
from ..scene.scene import Scene
from .ends import End
from .examine import examine
from .free_entries import IDENTIFIED, NOISE, NOT_AT_ALL, FreeEntries, Prior, combinations
from .joint import Joint, Part, problem, worded
from .likelihood import KNEE, Evaluation
from .measurements import UNKNOWN, Measurements
from .optimise import Objective, Optimum, maximum_with_aiming, optimise, whitening
from .profiles import intervals, judged
from .result import CONTRADICTED, Estimate, Fit, RowDiagnostics
from .scatter import Resolution

RTOL = 1e-8
"""Relative tolerance of the collisions of a fit."""
_ONE_OUTCOME = "Such data can only bound an entry; within the bounds no value is better than another."
_UNLIKELY = 1e-3  # probability of residuals as large below which they are remarked on
_UNDECIDED = 1e-3  # probability of impacts without an outcome that is remarked on
_EVALUATIONS, _PER_PAIR = 20, 22  # usual number of evaluations, and more for each pair of free entries (measured)
_EVERYWHERE = 64  # starts in the whole range of the search, where the data contradict the model
_COARSE = 0.05  # error of the log-likelihood by quadrature that is remarked on


def fit(
    scene: Scene | str | Path | Sequence[Scene | str | Path],
    data: Any,
    free: Sequence[str] | str,
    *,
    prior: Mapping[str, str] | None = None,
    own: Sequence[str] | str | Mapping[str, Sequence[str]] = (),
    rtol: float = RTOL,
    starts: int = 16,
    seed: int = 0,
    progress: Progress | None = None,
) -> Fit:
    """Estimate entries of a scene from measured impacts, or of several scenes together.

    Arguments:
        scene: a Scene, a path or a preset's name, or a list of these; its values of the free entries are a first guess.
        data: a CSV file, a DataFrame, a Dataset, a mapping of columns, or Measurements (see `read_data`); of several
            scenes a list of these.
        free: entries to estimate, by dotted name; also "noise.restitution" (or another result that was measured),
            "noise.speed" and "noise.angle": factors of the standard deviations in the data.
        prior: what is known of free entries, as {"particles.roughness": "2 um +- 20 %"}: Gaussian in the logarithm
            where the standard deviation is in %, else in the entry.
        own: free entries of which each scene has a value of its own, NAME@LABEL in the result; all others are shared by
            the scenes that have them. A mapping gives a label for each scene, {"liquid.viscosity": ["oil", "oil",
            "water"]}, and equal labels share. Else the label is the scene's name, or its number if that is not unique.
        rtol: relative tolerance of the collisions.
        starts: quasi-random points from which the best are followed, beside the scene's own values.
        seed: of these points.
        progress: called with (evaluations done, evaluations in all) of the likelihood, in units of the usual one; the
            second is an estimate, which may grow, and is reached at the end.

    Returns:
        Fit: estimates, 95 % profile-likelihood intervals and verdicts; what each row says of them.

    Raises:
        InputError: a wrong entry, or a bad cell, named by row and column.
        ComputationError: the scene's collisions are not differentiated by a compiled kernel.
        KeyboardInterrupt: an interrupt; its message has the most likely values, once they are found.

    Example:
        >>> from wetdoublet.solvers import fit
        >>> speeds = [0.3, 0.8, 1.2, 1.6, 1.9, 2.2, 2.5, 3.0]
        >>> seen = ["stick"] * 5 + ["bounce"] * 3
        >>> found = fit("granulation", {"speed": speeds, "angle": [0.0] * 8, "outcome": seen}, "liquid.viscosity")
        >>> found.estimates["liquid.viscosity"].verdict
        'identified'
    """
    rtol = check_rtol(rtol)
    check_function(progress, "progress")
    parts, entries = problem(scene, data, free, prior, own, rtol)
    for member in parts:
        warn(member.scene)
    likelihood = Joint(parts, entries.names, rtol)
    work, best = Estimated(progress, _EVALUATIONS + _PER_PAIR * entries.size**2), None
    work.start()
    likelihood.tell = work.add
    try:
        odd = [examine(member.scene, member.data) for member in parts]
        best = optimise(likelihood, entries, starts, seed)
        contradicts = _is_contradicted(likelihood, entries, best)
        if contradicts:
            best = max(optimise(likelihood, entries, _EVERYWHERE, seed, everywhere=True), best, key=lambda at: at.value)
            best = maximum_with_aiming(likelihood, entries, best.inner)
            contradicts = _is_contradicted(likelihood, entries, best)
        if contradicts:  # profiles would say nothing, and take long
            ends = [[End(best.inner, open=True)] * 2 for _ in entries.entries]
        else:
            best, ends = intervals(likelihood, entries, best)
        for k, (member, findings) in enumerate(zip(parts, odd, strict=True)):
            about = [item.text for item in findings if contradicts or item.kind in ("speed", "outlier", "duplicate")]
            remarks = (*(f"Before the fit: {text}" for text in about), *member.data.remarks)
            parts = (*parts[:k], replace(member, data=replace(member.data, remarks=remarks)), *parts[k + 1 :])
        result = _result(parts, likelihood, entries, best, ends)
    except KeyboardInterrupt as interrupt:
        if best is None or str(interrupt):
            raise
        values = ", ".join(f"{name} = {worded(parts, name, size)}" for name, size in entries.named(best.inner).items())
        raise KeyboardInterrupt(f"interrupted: most likely are {values}; the intervals are not computed") from None
    finally:
        del likelihood.tell
    work.finish()
    return result


def _is_contradicted(likelihood: Joint, free: FreeEntries, best: Optimum) -> bool:
    """Whether even at the most likely values at least half of the impacts contradict the model."""
    evaluation = likelihood(free.values(best.inner))
    assert evaluation is not None  # the optimum is possible
    return bool(2 * np.count_nonzero(evaluation.plain - likelihood.constant < -KNEE) >= likelihood.size)


def log_likelihood(
    scene: Scene | str | Path | Sequence[Scene | str | Path], data: Any, free: Sequence[str] | str, *,
    prior: Mapping[str, str] | None = None, own: Sequence[str] | str | Mapping[str, Sequence[str]] = (),
    rtol: float = RTOL,
) -> LogLikelihood:  # fmt: skip
    """The log-density of a fit and its gradient as a plain function, for samplers and optimisers of one's own.

    Arguments:
        scene, data, free, prior, own, rtol: as of `fit`. Lines through the scatter are turned for the scene's values.

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
    parts, entries = problem(scene, data, free, prior, own, check_rtol(rtol))
    likelihood = Joint(parts, entries.names, rtol)
    likelihood.aim(entries.values(entries.start))
    return LogLikelihood(Objective(likelihood, entries, Resolution(approximate=False)))


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
        return self.objective.log_density(by_name)


def _result(parts: tuple[Part, ...], likelihood: Joint, free: FreeEntries, best: Optimum, ends: list[list[End]]) -> Fit:
    data = parts[0].data
    if len(parts) > 1:
        data = Measurements.joined([member.data for member in parts], [member.label for member in parts])
    objective, inner = Objective(likelihood, free, Resolution()), best.inner
    white, values = whitening(objective, inner), free.values(inner)
    evaluation = objective.at(inner)
    assert evaluation is not None  # the estimates are possible
    rows = _rows(likelihood, values, evaluation, evaluation.scores * free.rates(values) @ white)
    verdicts = [NOT_AT_ALL if rows.contradicted else judged(objective, inner, k, both) for k, both in enumerate(ends)]
    if _only_outcome(data) is not None:
        bounded = [
            verdict == IDENTIFIED and not isinstance(item.prior, Prior) for verdict, item in zip(verdicts, free.entries)
        ]
        verdicts = [NOT_AT_ALL if flag else verdict for flag, verdict in zip(bounded, verdicts)]
    estimates = {}
    for k, name in enumerate(free.names):
        low, high = (None if end.open else float(free.values(end.inner)[k]) for end in ends[k])
        estimates[name] = Estimate(float(values[k]), low, high, verdicts[k])
    covariance = white @ white.T
    spread = np.sqrt(np.diag(covariance))
    finer = likelihood(values, Resolution().doubled().values)
    error = np.nan if finer is None else finer.value - evaluation.value
    others = tuple((free.named(other.inner), other.value) for other in best.others)
    remarks = [*data.remarks, *_remarks(parts, data, rows, evaluation.undecided, error, others)]
    if rows.contradicted:
        remarks.insert(0, CONTRADICTED)
    if any(isinstance(entry.prior, Prior) for entry in free.entries):
        remarks.append("Intervals and verdicts are those of the likelihood times the priors.")
    return Fit(
        parts, data, estimates, objective.log_likelihood(inner), covariance / np.outer(spread, spread),
        () if rows.contradicted else combinations(free, objective.information(inner), verdicts),
        tuple(remarks), rows, float(error), others,
        objective, tuple((below.inner, above.inner) for below, above in ends),
    )  # fmt: skip


def _only_outcome(data: Measurements) -> str | None:
    """The outcome of all impacts, if they have one and nothing else was measured."""
    codes = set(data.outcome.tolist())
    return None if len(codes) > 1 or UNKNOWN in codes or data.separated.any() else OUTCOMES[codes.pop()]


def _rows(
    likelihood: Joint, values: np.ndarray, evaluation: Evaluation, white_scores: np.ndarray
) -> RowDiagnostics:  # fmt: skip
    parts = [term.noisier(own) for term, own in zip(likelihood.parts, likelihood.values(values), strict=True)]
    noisy, residual = Measurements.joined(parts, [""] * len(parts)).observed, {}
    for name, mean in evaluation.mean.items():
        measured, sd = noisy[name]
        with np.errstate(invalid="ignore"):
            residual[name] = (measured - mean) / np.hypot(sd, evaluation.spread[name])
    relative = evaluation.plain - likelihood.constant
    pull = np.linalg.norm(white_scores, axis=1)
    return RowDiagnostics(evaluation.probability, evaluation.mean, residual, relative, pull)


def _remarks(
    parts: tuple[Part, ...], data: Measurements, rows: RowDiagnostics, undecided: np.ndarray, error: float,
    others: tuple[tuple[dict[str, float], float], ...],
) -> list[str]:  # fmt: skip
    remarks = []
    if (word := _only_outcome(data)) is not None:
        alike = "stick" if word == STICK else f"have the outcome {word}, and no result was measured"
        remarks.append(f"All impacts {alike}. {_ONE_OUTCOME}")
    odd = rows.contradicting
    if odd.size:
        names = several([data.label(k) for k in odd.tolist()])
        verb = "contradicts" if odd.size == 1 else "contradict"
        remarks.append(
            f"{odd.size} of {data.size} impacts {verb} the model at these estimates ({names}): their scatter does not "
            "allow what was observed. They count less than others."
        )
    if undecided.max(initial=0.0) > _UNDECIDED:
        worst = int(np.argmax(undecided))
        remarks.append(
            f"Of the scatter of an impact ({data.label(worst)}), {100 * undecided[worst]:.2g} % has no outcome: "
            "its collisions take more steps than an integration may. This part counts as not observed."
        )
    for name, residual in rows.residual.items():
        misfits = residual[np.isfinite(residual)]
        if misfits.size and chi2.sf(float((misfits**2).sum()), misfits.size) < _UNLIKELY:
            rms = float(np.sqrt((misfits**2).mean()))
            factor = f"{NOISE}{name}"
            is_free = any(factor in member.entries for member in parts)
            advice = f"{factor} is free, and goes no further" if is_free else f"free {factor} estimates the noise"
            remarks.append(
                f"Residuals of {name} are {rms:.2g} times what scatter and noise allow: the model does not fit, or "
                f"the noise is larger than given. The intervals are then too narrow; {advice}."
            )
    if not abs(error) < _COARSE:
        remarks.append(
            f"The integrals over the scatter are uncertain: the log-likelihood changes by {error:.2g} with finer ones."
        )
    if others:
        values = ", ".join(f"{name} = {worded(parts, name, value)}" for name, value in others[0][0].items())
        remarks.append(
            f"The likelihood has {len(others) + 1} separate maxima. At the next, {values}, the log-likelihood is "
            f"{others[0][1]:.3f}."
        )
    return remarks
