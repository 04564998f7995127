"""The likelihood of measured impacts, and its gradient by the free entries.

The likelihood of a row is the integral over the scatter in speed and angle of [the outcome agrees] times the density of
what was measured about the results of the collision. It is taken along lines through the scatter, which are split at
the changes of outcome; between two changes the results are interpolated (`scatter`).

Derivatives are taken at a fixed interpolation variable: the points of a segment move with its ends, and the square
roots cancel.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..boundaries.experiment import Experiment
from ..engines.settings import RTOL
from ..errors import InputError, several
from ..scene.scene import Scene
from ..scene.schema import SPINS
from .directions import directions, narrow_rows
from .free_entries import NOISE
from .interpolation import SegmentMap, segment_map
from .measurements import SCATTER, Measurements, rows_of
from .rare_outcomes import RARE, beyond_reach
from .scatter import REACH, Resolution, ScatterLines, Segments

NEGLIGIBLE = 1e-12  # probability of the scatter below which a segment is left out
COUNTS = (1, 3, 9, 21)
"""Numbers of lines that a row may have. Odd: the middle line goes through the nominal impact."""
KNEE, TAIL = 12.0, 4.0
"""A row that lies more than this many units of log-likelihood below the most likely observation (4.9 standard
deviations) contradicts the model; from there its log-likelihood falls with the logarithm of the distance."""

_BEYOND = 6.0  # standard deviations of noise and angle beyond which a restitution is impossible
_FINEST = 32  # most by which the points of a segment are multiplied
_SIDES = -0.02, 0.02  # relative steps of the differences by the scatter
_LINES = Resolution().lines
_USUAL = _LINES * Resolution().nodes
_CHANGE = 0.2  # part of a tolerance from which more lines are taken
_FIXED, _EXACT = 0.3, 3.0  # cost of an evaluation that does not depend on its nodes; factor of exact derivatives
_Terms = tuple[np.ndarray, np.ndarray, np.ndarray]  # rows, logarithms of positive terms, derivatives of these


@dataclass(frozen=True)
class Evaluation:
    """Log-likelihoods of the rows.

    Attributes:
        rows: (rows,), natural logarithms, relative to a perfect observation's density and limited (`KNEE`).
        scores: (rows, free entries), derivatives by the free entries' values.
        plain: (rows,), as `rows`, but not limited.
        probability: (rows,), of the observed outcome.
        undecided: (rows,), probability of impacts whose outcome no engine decides; they count as not observed.
        mean, spread: result -> (rows,), mean and standard deviation over the scatter where the outcome agrees.
    """

    rows: np.ndarray
    scores: np.ndarray
    plain: np.ndarray
    probability: np.ndarray
    undecided: np.ndarray
    mean: dict[str, np.ndarray]
    spread: dict[str, np.ndarray]

    @property
    def value(self) -> float:
        return float(self.rows.sum())


class Likelihood:
    """The log-likelihood of measurements as a function of the free entries' values.

    Arguments:
        scene, names, data: the scene, its free entries, after them the noise that is free, and the rows.
        rtol: relative tolerance of the integrations.

    Attributes:
        tell: called after each evaluation with its cost, relative to one at the usual resolution.
    """

    tell: Callable[[float], None] = staticmethod(lambda _cost: None)

    def __init__(self, scene: Scene, names: tuple[str, ...], data: Measurements, rtol: float = RTOL) -> None:
        self.data, self.names, self.size = data, names, data.size
        self.noise = tuple(name.removeprefix(NOISE) for name in names if name.startswith(NOISE))
        names = names[: len(names) - len(self.noise)]
        check_energy(scene, names, data)
        self.measured = tuple(name for name, (values, _) in data.observed.items() if np.isfinite(values).any())
        self.experiments = rows_of(scene, names, data, rtol)
        self.direction = np.zeros(data.size)  # of the lines of each row
        self.counts = np.full(data.size, _LINES)  # of lines of each row at the usual resolution
        self.constant = np.zeros(data.size)  # of the densities' normalisation
        for name in self.measured:
            values, sd = data.observed[name]
            seen = data.separated & np.isfinite(values)
            self.constant[seen] -= np.log(sd[seen] * np.sqrt(2 * np.pi))

    def aim(self, values: np.ndarray) -> None:
        """Turn the lines of each row across its changes of outcome and the bands that results leave.

        Raises:
            InputError: these values make the scene of a row impossible.
        """
        self.direction = directions(self.experiment_at(values), self.noisier(values), self.measured)

    def refine(self, values: np.ndarray, tolerance: float, at_least: bool = False) -> bool:
        """Choose each row's number of lines: the last of `COUNTS` that changes its log-likelihood.

        The next number is tried where one changes it by more than `tolerance`; a fifth of that counts as a change.

        Arguments:
            at_least: no number becomes smaller than it was, so that there are enough lines for other values too; none
                changes if these values make the scene impossible.

        Returns:
            Whether a row has more lines than before.
        """
        experiment, noise = self._experiment(values) if at_least else self.experiment_at(values), self._factors(values)
        if experiment is None:
            return False
        counts, undecided, now = np.ones(self.size, int), np.ones(self.size, bool), np.zeros(0)
        for count in COUNTS:
            fine = self.evaluate(experiment, Resolution().values, noise, np.where(undecided, count, 0)).rows
            if now.size:
                change = np.where(undecided, np.abs(fine - now), 0.0)
                counts[change > _CHANGE * tolerance] = count
                undecided = change > tolerance
                if not undecided.any():
                    break
            now = fine
        more = bool((counts > self.counts).any())
        self.counts = np.maximum(counts, self.counts) if at_least else counts
        return more

    def experiment_at(self, values: np.ndarray) -> Experiment:
        """The experiment with these values of the free entries; InputError if they make a row's scene impossible."""
        experiment = self._experiment(values)
        if experiment is None:
            named = ", ".join(f"{name} = {value:.6g}" for name, value in zip(self.names, values, strict=True))
            raise InputError("free", named, "values that the scene may have together", "make a scene impossible")
        return experiment

    def __call__(self, values: np.ndarray, resolution: Resolution | None = None) -> Evaluation | None:
        """The log-likelihoods at these values; None where they make the scene impossible."""
        experiment, resolution, noise = self._experiment(values), resolution or Resolution(), self._factors(values)
        if experiment is None:
            return None
        terms = self.evaluate(experiment, resolution, noise)
        for k, name in enumerate(self.noise, len(experiment.rows.names)):
            if name in SCATTER:  # the lines move with it
                sides = [self.evaluate(experiment, resolution, noise | {name: noise[name] * (1 + h)}) for h in _SIDES]
                terms.scores[:, k] = (sides[1].rows - sides[0].rows) / (_SIDES[1] - _SIDES[0]) / noise[name]
        return terms

    def _experiment(self, values: np.ndarray) -> Experiment | None:
        return self.experiments.at(values[: len(self.experiments.names)])

    def noisier(self, values: np.ndarray) -> Measurements:
        return self.data.noisier(self._factors(values))

    def _factors(self, values: np.ndarray) -> dict[str, float]:
        """The noise: result, speed or angle -> factor of its standard deviations."""
        return dict(zip(self.noise, values[len(self.experiments.names) :].tolist()))

    def evaluate(
        self, experiment: Experiment, resolution: Resolution, noise: Mapping[str, float],
        counts: np.ndarray | None = None,
    ) -> Evaluation:  # fmt: skip
        """The log-likelihoods of all rows in an experiment, without derivatives by the scatter in speed and angle.

        Arguments:
            noise: factors of standard deviations.
            counts: (rows,), of lines, in place of those that `refine` chose; 0 leaves a row out.
        """
        data, size = self.data.noisier(noise), self.size
        if counts is None:
            proportion = resolution.lines / _LINES if resolution.lines > 1 else 0.0
            counts = np.maximum(np.ceil(self.counts * proportion).astype(int), 1)
        narrow = narrow_rows(experiment, data, self.measured, self.direction)
        lines = ScatterLines.through(data, self.direction, counts, REACH, narrow.centre, narrow.width)
        changes = lines.changes(experiment, resolution)
        segments = Segments.between(lines, changes)
        unknown = segments.subset(segments.outcome < 0)
        undecided = np.bincount(unknown.row, unknown.share * unknown.mass(), size)
        segments = segments.subset((segments.outcome >= 0) & data.allowed[segments.row, segments.outcome])
        mass = segments.mass()
        probability = np.bincount(segments.row, segments.share * mass, size)
        dense = data.separated[segments.row]
        weighs = mass > np.where(dense, NEGLIGIBLE, 0.0)
        ends = segments.moving_ends(experiment, lines, changes, weighs, resolution)
        by_free = segments.mass_slopes(ends)
        moments = {name: np.zeros((3, size)) for name in self.measured}
        plain = ~dense & weighs
        terms: list[_Terms] = [(segments.row[plain], np.log((segments.weight * mass)[plain]), by_free[plain])]
        which = np.flatnonzero(dense & weighs)
        dense_part = segments.subset(which)
        results = dense_part.results(experiment, lines, ends[:, which], self.measured, resolution)
        for indices, mapping, value, slope in results:
            for some, finer in self._resolved(dense_part.row[indices], noise, mapping, value):
                at_ends, of = ends[:, which[indices[some]]], dense_part.subset(indices[some])
                terms.append(self._integrals(of, noise, at_ends, finer, value[:, some], slope[:, some], moments))
        rows, scores = _sums(terms, size, len(self.names))
        rare = np.flatnonzero((probability < RARE) & (counts > 0))
        if rare.size:
            moves = np.zeros((size, by_free.shape[1]))  # of the logarithm of the probability
            np.add.at(moves, segments.row, (segments.share * mass)[:, None] * by_free)
            moves /= np.maximum(probability, 1e-300)[:, None]
            as_given = replace(data, observed=self.data.observed)  # not with the noise: its derivative is 0 there
            log, slope = beyond_reach(
                experiment, as_given, rare, self.direction, self.measured, resolution, probability[rare], moves[rare]
            )
            missing = log > rows[rare]
            rows[rare[missing]], scores[rare[missing]] = log[missing], _widened(slope[missing], len(self.names))
        relative = float(counts.mean()) * resolution.nodes / _USUAL
        self.tell((_FIXED + (1 - _FIXED) * relative) * (1.0 if resolution.approximate else _EXACT))
        limited, factor = limit(rows)
        mean, spread = {}, {}
        for name, (share, first, second) in moments.items():
            with np.errstate(divide="ignore", invalid="ignore"):
                mean[name] = first / share
                spread[name] = np.sqrt(np.maximum(second / share - mean[name] ** 2, 0.0))
            mean[name][narrow.row], spread[name][narrow.row] = narrow.mean[name], narrow.spread[name]
        return Evaluation(
            limited + self.constant, scores * factor[:, None], rows + self.constant, np.minimum(probability, 1.0),
            undecided, mean, spread,
        )  # fmt: skip

    def _resolved(
        self, row: np.ndarray, noise: Mapping[str, float], mapping: SegmentMap, value: np.ndarray
    ) -> Iterator[tuple[np.ndarray, SegmentMap]]:
        """Indices of segments, and the map with points so dense that results change by their noise between two."""
        steps = np.ones(row.size)
        for k, name in enumerate(self.measured):
            measured, sd = (column[row] for column in self.data.observed[name])
            change = np.abs(np.diff(value[k] @ mapping.interpolate.T)).max(axis=1) / (sd * noise.get(name, 1.0))
            steps = np.fmax(steps, np.where(np.isfinite(measured), change, 1.0))
        times = 2 ** np.ceil(np.log2(np.minimum(steps, _FINEST))).astype(int)
        for factor in np.unique(times).tolist():
            count = factor * mapping.at_points.size
            yield np.flatnonzero(times == factor), segment_map(mapping.kind, mapping.at_nodes.size, count)

    def _integrals(
        self, segments: Segments, noise: Mapping[str, float], ends: np.ndarray, mapping: SegmentMap, value: np.ndarray,
        slope: np.ndarray, moments: dict[str, np.ndarray],
    ) -> _Terms:  # fmt: skip
        """The integrals of densities over segments of one kind; the moments of the results are added to `moments`."""
        row = segments.row
        lost = ~np.isfinite(value).all(axis=(0, 2))  # a trajectory on the way was not completed
        value, slope = np.nan_to_num(value), np.nan_to_num(slope)
        length = (segments.high - segments.low)[:, None]
        y = segments.low[:, None] + length * mapping.at_points
        scatter = -(y**2) / 2 - np.log(2 * np.pi) / 2 + np.log(length * mapping.rate * mapping.weight)
        exponent = scatter.copy()
        pulls, squares = [], dict.fromkeys(self.noise, np.zeros(exponent.shape))
        for k, name in enumerate(self.measured):
            measured, sd = (column[row, None] for column in self.data.observed[name])
            sd = sd * noise.get(name, 1.0)
            at = value[k] @ mapping.interpolate.T
            for power in range(3):
                np.add.at(moments[name][power], row, segments.weight * (np.exp(scatter) * at**power).sum(axis=1))
            misfit = np.where(np.isfinite(measured), (measured - at) / sd, 0.0)
            exponent -= misfit**2 / 2
            pulls.append(misfit / sd)
            squares[name] = misfit**2
        exponent[lost] = -np.inf
        top = np.max(exponent, axis=1, keepdims=True, initial=-1e300)
        density = np.exp(exponent - top)
        integral = density.sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.where(integral[:, None] > 0, density / integral[:, None], 0.0)
            logs = np.log(integral) + top[:, 0] + np.log(segments.weight)
        gradient = (ends[1] - ends[0]) / length
        # y moves with the ends, by (1 - g) of the lower one and g of the upper one
        mean_y, mean_gy = -(share * y).sum(axis=1), -(share * y * mapping.at_points).sum(axis=1)
        gradient += ends[0] * (mean_y - mean_gy)[:, None] + ends[1] * mean_gy[:, None]
        for pull, of_result in zip(pulls, slope, strict=True):
            gradient += np.einsum("sn,snp->sp", (share * pull) @ mapping.interpolate, of_result)
        for name in self.noise:
            gradient = np.column_stack([gradient, (share * squares[name]).sum(axis=1) / noise[name]])
        positive = integral > 0
        return row[positive], logs[positive], gradient[positive]


def _widened(slopes: np.ndarray, width: int) -> np.ndarray:
    """Derivatives with columns of zeros for the noise."""
    return np.pad(slopes, ((0, 0), (0, width - slopes.shape[1])))


def _sums(terms: Sequence[_Terms], rows: int, width: int) -> tuple[np.ndarray, np.ndarray]:
    """Logarithms of the sums of terms by row, -1e300 for an empty one, and their derivatives, in `width` columns."""
    row, log = (np.concatenate(column) for column in list(zip(*terms, strict=True))[:2])
    slope = np.concatenate([_widened(block, width) for *_, block in terms])
    top = np.full(rows, -1e300)
    np.maximum.at(top, row, log)
    term = np.exp(log - top[row])
    total = np.bincount(row, term, rows)
    logs = np.where(total > 0, top + np.log(np.maximum(total, 1e-300)), -1e300)
    slopes = np.zeros((rows, slope.shape[1]))
    np.add.at(slopes, row, (term / total[row])[:, None] * slope)
    return logs, slopes


def limit(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Log-likelihoods limited by a heavy tail (`KNEE`), and their derivatives by the log-likelihoods before that."""
    beyond = np.maximum(-KNEE - rows, 0.0)
    return np.maximum(rows, -KNEE) - TAIL * np.log1p(beyond / TAIL), 1 / (1 + beyond / TAIL)


def check_energy(scene: Scene, names: tuple[str, ...], data: Measurements) -> None:
    """InputError for restitutions that no values of the entries give: e_n^2 <= 1 + tan^2 of the impact angle.

    The right side is the kinetic energy of the impact over that of its normal motion; no law of the library but the
    strings' gives back more. Scenes with spins, which bring energy of their own, and a user's laws are not checked.
    """
    spinning = {*names, *data.columns, *(name for name, value in scene.si if value)} & set(SPINS)
    if "restitution" not in data.observed or spinning or scene.pendulum is not None or scene.package is not None:
        return
    values, noise = data.observed["restitution"]
    steepest = np.minimum(data.angle + _BEYOND * data.angle_sd, np.pi / 2)
    with np.errstate(invalid="ignore"):
        rows = np.flatnonzero((values - _BEYOND * noise) * np.cos(steepest) > 1)
    if rows.size:
        k, where = int(rows[0]), several([data.label(row) for row in rows.tolist()])
        most = f"at most 1/cos(angle) = {1 / np.cos(data.angle[k]):.4g} there, and {_BEYOND:g} standard deviations"
        raise InputError("restitution", float(values[k]), most, f"is more than the impact's energy allows ({where})")
