"""The likelihood of measured impacts, and its gradient by the free entries.

Of a row it is the integral over the scatter in speed and angle of [the outcome agrees] times the density of what was
measured about the results of the collision. Every line through the scatter is split at its changes of outcome. Between
two changes the results are smooth and are interpolated by Chebyshev polynomials in a variable in which a square root at
a change is smooth too; the integral over the polynomials costs no collisions.

Derivatives are taken at fixed interpolation variable: the points of a segment move with its ends, and the square roots
cancel.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from ..scene.scene import Scene
from ..scene.schema import SPINS
from ..settings import RTOL
from . import changes as boundaries
from .interpolation import SegmentMap, extension, segment_map
from .law import BoundLaw, Law
from .lines import Lines
from .measurements import Measurements
from .rare import RARE, RareRows
from .segments import Segments, moving_ends
from .sums import Moments, RowSums

NEGLIGIBLE = 1e-12  # probability of the scatter below which a segment is left out
FINER = (3, 7)
"""Factors of the number of lines of rows that need more."""
KNEE, TAIL = 12.0, 4.0
"""A row that lies more than this many units of log-likelihood below the most likely observation (4.9 standard
deviations) contradicts the model; from there its log-likelihood falls with the logarithm of the distance."""


_BEYOND = 6.0  # standard deviations of noise and angle beyond which a restitution is impossible
_NAMED = 8  # rows in a message
_QUICK = 1000  # steps of a trajectory with derivatives, beyond which others' on the same segment stand for them
_DEGREE = 4  # of the polynomial by which they do


@dataclass(frozen=True)
class Resolution:
    """How finely the scatter is integrated.

    Arguments:
        lines: lines through the scatter of a row.
        nodes: collisions on a segment; half as many more where it ends at a change.
        points: of the quadrature over the interpolated results.
        grid: points of a line at which the outcome is looked at.
        quick: derivatives beside slow saddles are approximate: of changes to 1e-4, of results from their neighbours.
        within: error of a probability from the place of a change.
    """

    lines: int = 3
    nodes: int = 8
    points: int = 128
    grid: int = 15
    quick: bool = True
    within: float = boundaries.WITHIN

    def doubled(self) -> Resolution:
        """The same, twice as fine and with exact derivatives."""
        return Resolution(2 * self.lines + 1, 2 * self.nodes, 2 * self.points, 2 * self.grid, False, self.within / 100)


COARSE = Resolution(1, 4, 64, 11)
EXACT = Resolution(quick=False, within=1e-10)


@dataclass(frozen=True)
class Evaluation:
    """Log-likelihoods of the rows.

    Attributes:
        rows: (rows,), natural logarithms, relative to a perfect observation's density and limited (`KNEE`).
        scores: (rows, free entries), derivatives by the free entries' values.
        plain: (rows,), as `rows` without the limit.
        probability: (rows,), of the observed outcome.
        undecided: (rows,), probability that no engine decides the outcome; it counts as not observed.
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


def _check_energy(scene: Scene, names: tuple[str, ...], data: Measurements) -> None:
    """InputError for restitutions that no values of the entries give: e_n^2 <= 1 + tan^2 of the impact angle.

    That is the kinetic energy of the impact, of which no law of the library but the strings' gives back more. Not
    looked at with spins, which bring energy of their own, and a user's laws.
    """
    spinning = {*names, *data.columns, *(name for name, value in scene.si if value)} & set(SPINS)
    if "restitution" not in data.observed or spinning or scene.pendulum is not None or scene.package is not None:
        return
    values, noise = data.observed["restitution"]
    steepest = np.minimum(data.angle + _BEYOND * data.angle_sd, np.pi / 2)
    with np.errstate(invalid="ignore"):
        rows = np.flatnonzero((values - _BEYOND * noise) * np.cos(steepest) > 1)
    if rows.size:
        k, more = int(rows[0]), ", ..." if rows.size > _NAMED else ""
        where = ", ".join(data.label(each) for each in rows[:_NAMED].tolist()) + more
        most = f"at most 1/cos(angle) = {1 / np.cos(data.angle[k]):.4g} there, and {_BEYOND:g} standard deviations"
        raise InputError("restitution", float(values[k]), most, f"is more than the impact's energy allows ({where})")


class Likelihood:
    """The log-likelihood of measurements as a function of the free entries' values.

    Arguments:
        scene, names, data: scene, free entries and rows.
        rtol: relative tolerance of the integrations.
    """

    def __init__(self, scene: Scene, names: tuple[str, ...], data: Measurements, rtol: float = RTOL) -> None:
        self.data, self.names = data, names
        _check_energy(scene, names, data)
        self.of = tuple(name for name, (values, _) in data.observed.items() if np.isfinite(values).any())
        self.law = Law(scene, names, data, rtol)
        self.direction = np.zeros(data.size)
        self.more = np.ones(data.size, int)  # factor of the lines of each row, odd
        density = data.separated
        self.constant = np.zeros(data.size)  # of the densities' normalisation
        for name in self.of:
            values, sd = data.observed[name]
            seen = density & np.isfinite(values)
            self.constant[seen] -= np.log(sd[seen] * np.sqrt(2 * np.pi))

    # ---- the frame

    def aim(self, values: np.ndarray) -> None:
        """Turn the lines of every row to where its results change fastest, for these values.

        Raises:
            InputError: values that no scene may have.
        """
        law = self.bound(values)
        data = self.data
        if not ((data.speed_sd > 0) & (data.angle_sd > 0)).any():
            return
        nearest = np.full(data.size, np.inf)
        for across in (0.0, np.pi / 2):
            lines = Lines.of(data, np.full(data.size, across), np.ones(data.size, int))
            found = boundaries.locate(law, lines, within=1e-3)
            if not found.size:
                continue
            order = np.argsort(np.abs(found.y))
            rows, first = np.unique(lines.row[found.line[order]], return_index=True)
            which = order[first]
            closer = np.abs(found.y[which]) < nearest[rows]
            rows, which = rows[closer], which[closer]
            if not rows.size:
                continue
            fine = replace(found, y=found.y.copy())
            normal = boundaries.normals(law, lines, fine, which, True)
            turned = self._direction(lines, found.line[which], found.y[which], normal.speed, normal.angle)
            turned = np.where(np.isfinite(turned), turned, across)
            nearest[rows], self.direction[rows] = np.abs(found.y[which]), turned
        for k, name in enumerate(self.of):
            smooth = np.flatnonzero(data.separated & np.isfinite(data.observed[name][0]))
            lines = Lines.of(data, self.direction, np.ones(data.size, int))
            there = law.results(self.of, smooth, *lines.at(smooth, np.zeros(smooth.size)))
            by = there.speed[k] * data.speed_sd[smooth], there.angle[k] * data.angle_sd[smooth]
            steep = np.hypot(*by) > data.observed[name][1][smooth]
            turned = self._direction(lines, smooth, np.zeros(smooth.size), there.speed[k], there.angle[k])
            steep &= np.isfinite(turned) & (there.outcome > 0)
            self.direction[smooth] = np.where(steep, turned, self.direction[smooth])
            if steep.any():
                break

    def _direction(
        self, lines: Lines, line: np.ndarray, y: np.ndarray, speed: np.ndarray, angle: np.ndarray
    ) -> np.ndarray:
        row = lines.row[line]
        if self.data.relative:
            at_speed, at_angle = lines.at(line, y)
            angle = angle - speed * at_speed * np.tan(at_angle)
            speed = speed * np.cos(at_angle)
        with np.errstate(invalid="ignore"):
            turned: np.ndarray = np.arctan2(angle * self.data.angle_sd[row], speed * self.data.speed_sd[row])
            turned[(angle == 0) & (speed == 0)] = np.nan
        return turned

    def refine(self, values: np.ndarray, within: float) -> None:
        """Give more lines to rows whose log-likelihood at these values is not within an error of what it should be."""
        law, size = self.bound(values), self.data.size
        self.more = np.ones(size, int)
        now, open_ = self.evaluate(law, Resolution()).rows, np.ones(size, bool)
        for factor in FINER:
            fine = self.evaluate(law, Resolution(), np.where(open_, factor, 0)).rows
            open_ &= np.abs(fine - now) > within
            self.more[open_], now = factor, fine
            if not open_.any():
                break

    def bound(self, values: np.ndarray) -> BoundLaw:
        """The law at these values; InputError where no scene may have them."""
        law = self.law.at(np.asarray(values, dtype=float))
        if law is None:
            said = ", ".join(f"{name} = {value:.6g}" for name, value in zip(self.names, values, strict=True))
            raise InputError("free", said, "values that the scene may have together", "make a scene impossible")
        return law

    # ---- the integral

    def __call__(self, values: np.ndarray, resolution: Resolution | None = None) -> Evaluation | None:
        """The log-likelihoods at these values; None where they make the scene impossible."""
        law = self.law.at(np.asarray(values, dtype=float))
        return None if law is None else self.evaluate(law, resolution or Resolution())

    def evaluate(self, law: BoundLaw, resolution: Resolution, factors: np.ndarray | None = None) -> Evaluation:
        """The log-likelihoods of all rows under a law.

        Arguments:
            factors: (rows,), of the number of lines, in place of those found by `refine`; 0 leaves a row out.
        """
        data, size = self.data, self.data.size
        if factors is None:
            factors = self.more if resolution.lines > 1 else np.ones(size, int)
        lines = Lines.of(data, self.direction, resolution.lines * factors)
        found = boundaries.locate(law, lines, resolution.grid, resolution.within)
        segments, unknown = Segments.of(lines, found, data.allowed)
        mass = segments.mass()
        probability = np.bincount(segments.row, segments.weight * mass, size)
        undecided = np.bincount(unknown.row, unknown.weight * unknown.mass(), size)
        dense = data.separated[segments.row]
        counts = mass > np.where(dense, NEGLIGIBLE, 0.0)
        ends = moving_ends(law, lines, found, segments, counts, resolution.quick)
        total = RowSums(size, len(self.names))
        plain = np.flatnonzero(~dense & counts)
        total.add(segments.row[plain], np.log(segments.weight[plain] * mass[plain]), segments.mass_slopes(ends)[plain])
        moments = Moments(self.of, size)
        self._densities(law, lines, segments, ends, np.flatnonzero(dense & counts), resolution, total, moments)
        rows, scores = total.result()
        rare = np.flatnonzero((probability < RARE) & (factors > 0))
        if rare.size:
            moves = np.zeros(scores.shape)  # of the logarithm of the probability
            np.add.at(moves, segments.row, (segments.weight * mass)[:, None] * segments.mass_slopes(ends))
            moves /= np.maximum(probability, 1e-300)[:, None]
            how = resolution.within, resolution.quick
            beyond = RareRows.of(law, data, rare, self.direction, self.of, *how)
            beyond = beyond.setting_in(probability[rare], moves[rare])
            missing = beyond.log > rows[rare]
            rows[rare[missing]], scores[rare[missing]] = beyond.log[missing], beyond.slope[missing]
        limited, factor = limit(rows)
        return Evaluation(
            limited + self.constant, scores * factor[:, None], rows + self.constant, np.minimum(probability, 1.0),
            undecided, *moments.result(),
        )  # fmt: skip

    def _densities(
        self,
        law: BoundLaw,
        lines: Lines,
        segments: Segments,
        ends: tuple[np.ndarray, np.ndarray],
        which: np.ndarray,
        resolution: Resolution,
        total: RowSums,
        moments: Moments,
    ) -> None:
        """Add the integrals of densities over segments `which`."""
        free = (segments.from_change[which].astype(int) + 2 * segments.to_change[which]).astype(int)
        groups = [(kind, which[free == kind]) for kind in range(4)]
        groups = [(kind, part) for kind, part in groups if part.size]
        if not groups:
            return
        counts = [resolution.nodes * 3 // 2 if kind else resolution.nodes for kind, _ in groups]
        maps = [segment_map(kind, count, resolution.points) for (kind, _), count in zip(groups, counts)]
        places, on = [], []
        for (_, part), each in zip(groups, maps):
            low, high = segments.low[part, None], segments.high[part, None]
            places.append((low + (high - low) * each.at_nodes).ravel())
            on.append(np.repeat(segments.line[part], each.at_nodes.size))
        y, line = np.concatenate(places), np.concatenate(on)
        row, at = lines.row[line], lines.at(line, y)
        found = law.results(self.of, row, *at, budget=_QUICK if resolution.quick else None)
        late = np.flatnonzero(found.outcome < 0)
        if late.size:
            found.value[:, late] = law.plain(self.of, row[late], at[0][late], at[1][late])
        by_speed, by_angle = lines.slopes(line, y)
        by_y = found.speed * by_speed + found.angle * by_angle
        first = 0
        for (_, part), each in zip(groups, maps):
            own = slice(first, first + part.size * each.at_nodes.size)
            first = own.stop
            shape = part.size, each.at_nodes.size
            value = found.value[:, own].reshape(-1, *shape)
            low_p, high_p = ends[0][part], ends[1][part]
            moves = low_p[:, None] * (1 - each.at_nodes)[:, None] + high_p[:, None] * each.at_nodes[:, None]
            slope = (
                found.free[:, own].reshape(-1, *shape, len(self.names))
                + by_y[:, own].reshape(-1, *shape)[..., None] * moves
            )
            slope = _extended(slope, found.outcome[own].reshape(shape) >= 0)
            self._integrate(segments, part, each, value, slope, low_p, high_p, total, moments)

    def _integrate(
        self,
        segments: Segments,
        part: np.ndarray,
        mapping: SegmentMap,
        value: np.ndarray,
        slope: np.ndarray,
        low_p: np.ndarray,
        high_p: np.ndarray,
        total: RowSums,
        moments: Moments,
    ) -> None:
        row = segments.row[part]
        lost = ~np.isfinite(value).all(axis=(0, 2))  # a trajectory on the way was not completed
        value, slope = np.nan_to_num(value), np.nan_to_num(slope)
        low, high = segments.low[part, None], segments.high[part, None]
        length = high - low
        y = low + length * mapping.at_points
        scatter = -(y**2) / 2 - np.log(2 * np.pi) / 2 + np.log(length * mapping.rate * mapping.weight)
        exponent = scatter.copy()
        pulls = []
        for k, name in enumerate(self.of):
            measured, sd = (each[row, None] for each in self.data.observed[name])
            at = value[k] @ mapping.interpolate.T
            moments.add(name, row, segments.weight[part], scatter, at)
            seen = np.isfinite(measured)
            misfit = np.where(seen, (measured - at) / sd, 0.0)
            exponent -= misfit**2 / 2
            pulls.append((k, misfit / sd))
        exponent[lost] = -np.inf
        top = np.max(exponent, axis=1, keepdims=True, initial=-1e300)
        density = np.exp(exponent - top)
        whole = density.sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.where(whole[:, None] > 0, density / whole[:, None], 0.0)
            logs = np.log(whole) + top[:, 0] + np.log(segments.weight[part])
        gradient = (high_p - low_p) / length
        # y moves with the ends: dy = low_p (1 - g) + high_p g
        mean_y, mean_gy = -(share * y).sum(axis=1), -(share * y * mapping.at_points).sum(axis=1)
        gradient += low_p * (mean_y - mean_gy)[:, None] + high_p * mean_gy[:, None]
        for k, pull in pulls:
            at_nodes = (share * pull) @ mapping.interpolate
            gradient += np.einsum("sn,snp->sp", at_nodes, slope[k])
        kept = np.flatnonzero(whole > 0)
        total.add(row[kept], logs[kept], gradient[kept])


def _extended(slope: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Slopes at all nodes of segments from those that are known, as they are smooth where the segment moves with them.

    Arguments:
        slope: (results, segments, nodes, free entries).
        known: (segments, nodes).
    """
    odd = np.flatnonzero(~known.all(axis=1) & known.any(axis=1))
    for k in odd.tolist():
        slope[:, k] = np.einsum("mn,rnp->rmp", extension(tuple(known[k].tolist()), _DEGREE), slope[:, k])
    return slope


def limit(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Log-likelihoods with their heavy tail, and the derivative of that by the plain ones."""
    beyond = np.maximum(-KNEE - rows, 0.0)
    return np.maximum(rows, -KNEE) - TAIL * np.log1p(beyond / TAIL), 1 / (1 + beyond / TAIL)
