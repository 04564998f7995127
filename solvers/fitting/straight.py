"""Straight lines through tracked centres, and whether they move uniformly: lost frames, uneven times, bent paths.

Lost frames and uneven times displace positions along the motion, never across it: the scatter across is the noise.
A tracker that takes two near discs for a larger or a smaller shape displaces them along their line of centres.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import bdtrc, fdtri, ndtri, stdtr, stdtrit

from ..errors import several

LEAST = 4  # frames of a line
_RARE = 1e-6  # probability of an alarm about a film without fault
REACH = 0.4  # gap up to which trackers are known to displace touching discs, over the distance of touching solids
_BENT = 1e-3  # probability below which they are bent near contact
_STRAIGHT = 0.02  # probability from which frames do not differ from those farther away
_ZONES = (0.07, 0.15, 0.3, 0.5)  # widths in which a tracker may displace, over the distance of touching solids
_GAPS = np.arange(1, 26) / 25  # gaps up to which frames may be left out, likewise
_STEPS = (0.5, 0.3, 0.15, 0.05)  # quantiles of the steps that are tried as the motion of one frame
_CLEAR = 6.0  # noise, below which a step cannot be told from it
_ALIKE = 1e-4  # probability of so many pictures that are alike by chance, below which they are one
_NORMAL = ndtri((np.arange(200) + 0.5) / 200)
_JUMPS = 500  # most jumps that are looked for
_UNEVEN = 0.2  # scatter along the motion, over a step, from which a speed cannot be trusted


@dataclass(frozen=True)
class Flight:
    """Frames before or after an impact: times, both centres (n, 4), and what names them."""

    time: np.ndarray
    centres: np.ndarray
    names: Sequence[str]

    @property
    def places(self) -> np.ndarray:
        """Relative positions, (n, 2)."""
        return np.asarray(self.centres[:, 2:] - self.centres[:, :2])

    @property
    def again(self) -> np.ndarray:
        """Of all frames but the last, whether the next one has the same centres."""
        return np.asarray((self.centres[1:] == self.centres[:-1]).all(axis=1))

    def subset(self, which: np.ndarray | slice) -> "Flight":
        """The frames of a mask."""
        return Flight(self.time[which], self.centres[which], np.asarray(self.names)[which].tolist())

    def residuals(self, values: np.ndarray) -> np.ndarray:
        """Of a straight line in time through values (n, ...)."""
        since, off = self.time - self.time.mean(), values - values.mean(axis=0)
        return np.asarray(off - np.multiply.outer(since, since @ off / (since @ since)))

    def repeated(self, sigma: float, rounding: float, *, uniform: bool) -> list[int]:
        """Frames whose picture is there twice: more are like the next one than there would be by chance.

        A coordinate comes again the less often, the more of its digits it moves by. Rounding may repeat all four at
        once, noise each on its own.

        Arguments:
            uniform: the motion is, but for gravity; else it is that of the steps before and behind such a frame.
        """
        steps, pitch = np.diff(self.centres, axis=0), math.sqrt(3) * rounding
        again = np.flatnonzero(self.again) if uniform else 1 + np.flatnonzero(self.again[1:-1])
        if not again.size:
            return []
        noise, count = math.sqrt(max(sigma**2 - rounding**2, 0.0)), len(steps)
        if uniform:
            first, last = steps[: count // 2].mean(axis=0), steps[count // 2 :].mean(axis=0)
            ends = np.array([[1.5 * first - 0.5 * last], [1.5 * last - 0.5 * first]])
        else:
            ends = np.array([steps[again - 1], steps[again + 1]])
            ends = np.sign(ends) * np.maximum(np.abs(ends) - pitch - 2 * sigma, 0.0)
        moves = (np.abs(ends).min(axis=0) * (ends.prod(axis=0) > 0)).max(axis=1)  # of the fastest coordinate
        again = again if uniform else again[[np.argmax(moves)]]
        moved = moves.max() + np.linspace(noise, sigma, 5)[:, None] * _NORMAL
        chance = float(np.maximum(1 - np.abs(moved) / pitch, 0).mean(axis=1).max()) if pitch else 0.0
        chance *= min(1.0, pitch / (math.sqrt(2 * math.pi) * noise)) ** 3 if noise else 1.0
        return again.tolist() if bdtrc(again.size - 1, count, chance) < _ALIKE else []

    @property
    def axes(self) -> np.ndarray:
        """Unit vectors along and across the motion."""
        x, y = (self.time - self.time.mean()) @ self.places
        return np.array([[x, y], [-y, x]]) / (math.hypot(x, y) or 1.0)

    def gaps(self, solids: float) -> np.ndarray:
        return np.asarray(np.linalg.norm(self.places, axis=1) - solids)


def _noise(paths: Sequence[Flight], floor: float) -> tuple[float, int]:
    """Standard deviation of a coordinate across the motion, at least `floor`, and its degrees of freedom."""
    paths = [path for path in paths if path.time.size >= LEAST]
    squares = sum(float((path.residuals(path.places @ path.axes[1]) ** 2).sum()) for path in paths)
    freedom = sum(path.time.size - 2 for path in paths)
    return max(math.sqrt(squares / max(freedom, 1)), floor), freedom


def _lost(path: Flight, interval: float, sigma: float, freedom: int) -> tuple[np.ndarray, bool]:
    """Whole frames that are lost after each (-1: its picture is there twice), and whether noise is all that remains.

    As few as possible: none to begin with, then what the longer of the steps, and shorter ones, suggest.
    """
    steps = np.diff(path.places @ path.axes[0])
    counted = np.maximum(np.rint(np.diff(path.time) / interval), 1)
    lost = [_refined(path, np.zeros(steps.size), interval, sigma, freedom)]
    for step in np.quantile(steps / counted, _STEPS):
        if not lost[-1][1] and step > _CLEAR * sigma:
            more = np.maximum(np.rint(steps / step) - counted, 0)
            lost.append(_refined(path, more, interval, sigma, freedom))
    return lost[-1] if lost[-1][1] else lost[0]


def _refined(path: Flight, lost: np.ndarray, interval: float, sigma: float, freedom: int) -> tuple[np.ndarray, bool]:
    """The frames lost, begun from a guess, and whether noise is all that remains.

    The most significant jump is a number of whole steps of the motion: frames behind it are later by so many.
    """
    along, number = path.places @ path.axes[0], np.arange(path.time.size - 1, 0, -1)  # of frames behind each
    least = -stdtrit(freedom, _RARE / path.time.size) * sigma
    for _ in range(_JUMPS):
        time = path.time + np.append(0, lost.cumsum()) * interval
        off, since = replace(path, time=time).residuals(along), time - time.mean()
        after, moment = off[::-1].cumsum()[-2::-1], since[::-1].cumsum()[-2::-1]
        spread = np.maximum(number - number**2 / time.size - moment**2 / (since @ since), 1e-9)
        k = int(np.argmax(after**2 / spread))
        jump = after[k] / spread[k]
        step = (since @ along - jump * moment[k]) / (since @ since) * interval  # of a line with this jump
        more = round(jump / step) if abs(jump) < 1e6 * abs(step) else 0
        if abs(after[k]) <= least * math.sqrt(spread[k]) or more == 0 or lost[k] + more < -int(path.again[k]):
            break
        lost = lost + more * (np.arange(lost.size) == k)
    return lost, not _odd(off, sigma, freedom)


def _odd(off: np.ndarray, sigma: float, freedom: int) -> bool:
    """Whether residuals of a line are larger than the noise makes them."""
    return bool((off**2).sum() / (off.size - 2) > sigma**2 * fdtri(off.size - 2, freedom, 1 - _RARE))


def uneven(paths: Sequence[Flight], interval: float, floor: float, rounding: float) -> tuple[str, float]:
    """What is wrong with the times of the paths, in words, and at how many places frames are lost.

    Where steps are not clear of the noise every frame counts; infinite if lost frames do not explain it.

    Arguments:
        interval: time between two frames.
        floor: least standard deviation of a coordinate.
        rounding: that which the digits make.
    """
    sigma, freedom = _noise(paths, floor)
    where, again, most, explained, total = list[str](), list[str](), 0.0, True, 0.0
    for path in paths:
        raw = path.residuals(path.places @ path.axes[0])
        scatter = math.sqrt(float((raw**2).sum()) / (raw.size - 2))
        step = float(np.linalg.norm(path.places[-1] - path.places[0])) / (path.time[-1] - path.time[0]) * interval
        again += [f"after {path.names[k]}" for k in path.repeated(sigma, rounding, uniform=True)]
        lost, clear = _lost(path, interval, sigma, freedom)
        if lost.any() or (_odd(raw, sigma, freedom) and scatter > _UNEVEN * step):
            most, explained = max(most, scatter / sigma), explained and clear
        total += np.count_nonzero(lost) if step > _CLEAR * sigma else float(np.abs(lost).sum())
        for k in np.flatnonzero(lost).tolist():
            where.append(f"{f'{lost[k]:.0f} lost' if lost[k] > 0 else 'the same picture again'} after {path.names[k]}")
    if again:
        return f"has the same picture again {several(again)}", 0.0
    text = f"scatter {most:.2g} times as much along the motion as across it: "
    if most and explained:
        text += f"is a frame missing that the numbers of the frames do not count? {several(where)}"
    elif most:
        text += "are frames missing here and there that their numbers do not count, or are times rounded?"
    return text if most else "", total if explained else math.inf


def _bent(paths: Sequence[Flight], edge: float, solids: float, floor: float) -> tuple[float, float]:
    """How far frames near a gap are displaced outward along the line of centres, against those farther away.

    Returns:
        standard deviations, and the probability of as many by the scatter across the motion.
    """
    most, rare = 0.0, 1.0
    for zone in _ZONES:
        far = edge + zone * solids
        sigma, freedom = _noise([flight.subset(flight.gaps(solids) >= far) for flight in paths], floor)
        for path in paths if freedom else ():
            weight = np.maximum(far - path.gaps(solids), 0.0)[:, None]
            push = path.residuals(weight * path.places / np.linalg.norm(path.places, axis=1)[:, None])
            size = math.sqrt(float((push**2).sum()))
            if size > 1e-9 * solids**2:
                away = float((push * path.residuals(path.places)).sum()) / (size * sigma)
                chance = 2 * len(_ZONES) * len(paths) * float(stdtr(freedom, -abs(away)))
                most, rare = (away, chance) if chance < rare else (most, rare)
    return most, rare


def near_contact(paths: Sequence[Flight], solids: float, floor: float) -> tuple[float, float]:
    """Standard deviations by which frames near contact are displaced outward, and the gap from which they are not.

    At least the gap to which trackers are known to displace, where the film has frames beyond it; infinity if nowhere.
    """
    most, rare = _bent(paths, 0.0, solids, floor)
    if rare > _BENT:
        return 0.0, 0.0
    for gap in solids * np.append(_GAPS[_GAPS >= REACH], _GAPS):
        far = [path.subset(path.gaps(solids) >= gap) for path in paths]
        if min(path.time.size for path in far) >= LEAST and _bent(far, gap, solids, floor)[1] > _STRAIGHT:
            return most, float(gap)
    return (most, math.inf) if rare < _RARE else (0.0, 0.0)


@dataclass(frozen=True)
class Line:
    """A straight line through the frames of one side of an impact.

    Attributes:
        course: position at time 0 and velocity, (2, 2).
        covariance: of the course, over the variance of the noise.
        squares, freedom: sum of the squared residuals, and its degrees of freedom.
    """

    course: np.ndarray
    covariance: np.ndarray
    squares: float
    freedom: int


def line_through(time: np.ndarray, relative: np.ndarray, mask: np.ndarray, turned_only: np.ndarray) -> Line:
    """The line of the frames of a mask by least squares.

    Arguments:
        turned_only: frames of which the direction counts: by symmetry a tracker displaces near discs along their line.
    """
    across = relative[turned_only] @ [[0, 1], [-1, 0]] / np.linalg.norm(relative[turned_only], axis=1)[:, None]
    whole = np.kron(np.stack([np.ones(int(mask.sum())), time[mask]], axis=1), np.eye(2))
    design = np.concatenate([whole, np.hstack([across, time[turned_only, None] * across])])
    values = np.append(relative[mask].ravel(), np.zeros(len(across)))
    solution = np.linalg.lstsq(design, values, rcond=None)[0]
    squares = float(((values - design @ solution) ** 2).sum())
    return Line(solution.reshape(2, 2), np.linalg.inv(design.T @ design), squares, values.size - 4)


def flight_of(course: np.ndarray) -> tuple[float, float, float, float]:
    """Speed, least distance from the origin, signed by the sense of rotation, its time, and the direction."""
    (x, y), (u, v) = course
    speed = math.hypot(u, v)
    return speed, (x * v - y * u) / speed, -(x * u + y * v) / speed**2, math.atan2(v, u)


def state_at(course: np.ndarray, distance: float, side: int) -> tuple[float, float, float, float]:
    """Angle of the line of centres, approach and tangential speed, and time, where a path crosses a distance.

    Arguments:
        side: -1 for the earlier crossing, 1 for the later one.
    """
    start, velocity = course
    speed, along = float(velocity @ velocity), float(start @ velocity)
    root = max(along**2 - speed * (float(start @ start) - distance**2), 0.0)
    time = (-along + side * math.sqrt(root)) / speed
    place = start + time * velocity
    normal = place / np.linalg.norm(place)
    sideways = normal[0] * velocity[1] - normal[1] * velocity[0]
    return math.atan2(place[1], place[0]), -float(normal @ velocity), float(sideways), time


def rests_from(time: np.ndarray, distance: np.ndarray, tolerance: float) -> int:
    """Frame from which the distance no longer changes, and has not been smaller; the number of frames if it does."""
    end = float(np.median(distance[-LEAST:]))
    since = int(np.append(-1, np.flatnonzero(np.abs(distance - end) > tolerance))[-1]) + 1
    if since == 0 or time.size - since < LEAST or (distance[:since] < end).any():
        return time.size
    would_go = (distance[0] - end) / (time[since] - time[0]) * (time[-1] - time[since])  # as fast as before
    return since if would_go > 4 * tolerance else time.size
