"""One impact on a film: frames of free flight, straight lines through them, and what follows at the scene's gaps.

Before the films touch and after the pair has separated the relative motion is uniform (gravity is common to both), so a
straight line is fitted to each part. Its covariance, from the noise of the positions, is carried to every result.
"""

import math
import sys
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import block_diag

from ...generated.automaton import STICK
from ..errors import InputError, several
from .flights import FLIGHT
from .measurements import CORRELATION, OBSERVED
from .straight import LEAST, REACH, Flight, Line, flight_of, line_through, near_contact, rests_from, state_at, uneven

_SIGNED = ("tangential_restitution", "rotation")
_NAMES = ("speed", "angle", *OBSERVED)  # at the scene's gaps
_WITH_SD = ("", "_sd")
_CLEAR = 4.0  # standard deviations of the noise by which a pair is apart
_WIDER, _MANY = 0.25, 20  # share by which gaps are widened, beyond which frames are free flight, where so many remain
_BLURRED = 0.1  # noise of a relative coordinate, over the distance of touching solids
_LITTLE = 1e-99  # of a variance
_STRAY = 10.0  # times the usual distance from a line, which a frame of a film that is tracked well does not reach
_BY_DIRECTION = (
    "count by the direction of their line of centres only: they lie off the straight path of the others, as of a "
    "tracker that displaces near discs"
)
_ROUNDING = 1e-9  # of positions, over the distance of the centres
_SIDEWAYS = 3.0  # standard deviations from which an impact is oblique
_STEP = 1e-2  # of differences, over the standard deviation of a parameter
_FEW = 4  # places at which frames are lost that explain a path better than a tracker does
_REFITS = 3  # of a line whose frames near contact are those before it meets
_FRAMES = "frames of a uniform motion, numbered as they were filmed, each once"
_RESTING = 0.01  # of the distance of touching solids, within which a distance no longer changes
_FASTEST = math.pi / 2  # rotation between two frames from which turns may have been missed
_TURN = 2 * math.pi


@dataclass(frozen=True)
class FilmedImpact:
    """The frames of one impact, and what the scene and the caller say of them.

    Attributes:
        label: what names it in messages.
        path: its frames: each once, in order, with both centres.
        repeated: names of frames, or times, that several rows have.
        solids, touch, apart: distances of the centres where the solids touch, where the films do, and at rupture, m.
        noise: of a relative coordinate, m; None where the film is to tell it.
        near: gap below which frames are left out, m; None where the film is to tell it.
        per_frame: s; None where times are given.
        rounding: standard deviation of a relative coordinate from the digits that are written, m.
    """

    label: str
    path: Flight
    repeated: list[str]
    solids: float
    touch: float
    apart: float
    noise: float | None
    scale_sd: float
    near: float | None
    per_frame: float | None
    rounding: float

    def measured(self) -> tuple[dict[str, Any], float, list[str]]:
        """Results by name, the noise of a relative coordinate (m), and remarks; InputError where there are none."""
        return _Measured(self).results()


class _Measured:
    """What is measured on a film, step by step: contact, free flight, its lines, and results at the scene's gaps."""

    def __init__(self, film: FilmedImpact) -> None:
        self.film, self.where, self.remarks = film, f"tracks, {film.label}", list[str]()
        self.time, self.relative, self.names = film.path.time, film.path.places, film.path.names
        self.distance = np.linalg.norm(self.relative, axis=1)
        if film.repeated and film.per_frame is None:
            accepted = "rising times, or a column frame and its rate"
            raise InputError(self.where, several(film.repeated), accepted, "is shared by several rows")
        if self.time.size < LEAST:
            problem = f"has {self.time.size} in all"
            raise InputError(self.where, None, f"at least {LEAST} frames before the impact", problem)

    def results(self) -> tuple[dict[str, Any], float, list[str]]:
        self.find_contact()
        self.check_count()
        self.check_flight()
        self.leave_out_near_frames()
        self.fit_lines()
        if (wider := self.gap_of_strays()) is not None:
            return replace(self.film, near=wider).measured()
        self.check_times(self.gap)
        self.check_contact()
        return self.at_gaps()

    # ---- which frames are free flight

    def find_contact(self) -> None:
        """`before` and `after`: masks of the frames of free flight; from `first` to `last` the pair is in contact."""
        film, time, distance, size = self.film, self.time, self.distance, self.time.size
        jitter = np.abs(np.diff(self.relative, 2, axis=0))  # of a uniform motion noise alone
        clear = _CLEAR * (film.noise or (float(np.median(jitter)) / (0.6745 * math.sqrt(6)) if jitter.size else 0.0))
        nearest = int(np.argmin(distance))
        nearly = distance[nearest] + _RESTING * film.solids  # a tracker may never see them touch
        met = np.append(np.flatnonzero(distance[:nearest] <= max(film.touch, nearly) + clear), nearest)
        self.leaving = max(film.apart, nearly) + clear
        nearby = np.append(nearest, nearest + np.flatnonzero(distance[nearest:] <= self.leaving))
        rest = rests_from(time, distance, max(clear, _RESTING * film.solids))
        self.first, self.last, self.rests = int(min(met[0], rest)), int(nearby[-1]), rest < size
        frames = np.arange(size)
        self.before, self.after = frames < self.first, (frames > self.last) & (rest == size)
        self.sticks, self.apart_still = not self.after.any(), distance[nearest] > film.touch + clear
        self.least = float(distance[nearest])

    def check_count(self) -> None:
        for flags, side in ((self.before, "before the impact"), (self.after | self.sticks, "after the separation")):
            if flags.sum() < LEAST:
                problem = f"has {int(flags.sum())} frames {side}" + ": is the scale off?" * (not flags.any())
                raise InputError(self.where, None, f"at least {LEAST} frames {side}", problem)

    @property
    def sure(self) -> float:
        """Distance of the centres at which they have separated for certain, m."""
        return self.film.solids + (1 + _WIDER) * (self.film.apart - self.film.solids)

    @property
    def floor(self) -> float:
        """Least noise of a relative coordinate, m."""
        return max(self.film.rounding, self.film.noise or 0.0, _ROUNDING * self.film.touch)

    def free(self, gap: float) -> list[Flight]:
        """Both flights, or the approach to a stick, where the spheres are farther apart than a gap."""
        beyond, masks = self.distance >= self.film.solids + gap, (self.before, self.after)
        flights = [self.film.path.subset(flags & beyond) for flags in masks if flags.any()]
        return flights if min(piece.time.size for piece in flights) >= LEAST else []

    def check_times(self, gap: float, most: float = math.inf) -> None:
        """InputError for frames that are lost, at most so many of them, repeated or of uneven times."""
        interval, repeated = self.film.per_frame or float(np.median(np.diff(self.time))), self.film.repeated
        text, lost = uneven(self.free(gap), interval, self.floor, self.film.rounding)
        faults = [f"has {several(repeated)} more than once"] if repeated else []
        faults += [text] if text and lost <= most else []
        if faults:
            raise InputError(self.where, None, _FRAMES, "; ".join(faults))

    def check_flight(self) -> None:
        """InputError for a film that ends too early, and for centres that are exchanged on the way."""
        distance, sure = self.distance, self.sure
        if not self.sticks and distance[-LEAST:].max() < sure:
            rupture = f"where the scene's rupture is at {self.film.apart:.4g} m: is it a stick?"
            accepted = f"a film that goes on until the spheres are {sure:.4g} m apart"
            raise InputError(self.where, None, accepted, f"ends {distance[-1]:.4g} m apart, {rupture}")
        apart = self.first + np.flatnonzero(distance[self.first : self.last] > self.leaving + sure - self.film.apart)
        if apart.size >= LEAST:
            problem = f"separate at {self.names[apart[0]]}, and meet again: are these several films?"
            raise InputError(self.where, None, "a column impact that tells films apart", problem)
        for flight in self.free(0.0):
            back = np.flatnonzero((flight.places[1:] * flight.places[:-1]).sum(axis=1) < 0)
            if back.size:
                problem = f"turn by more than 90 deg after {flight.names[back[0]]}: are the two spheres exchanged?"
                raise InputError(self.where, None, "a uniform motion", problem)

    def gap_near_contact(self) -> float:
        """The gap below which a tracker displaces the centres, from the paths themselves."""
        solids, repeated = self.film.solids, self.film.repeated
        displaced, gap = near_contact(self.free(0.0), solids, self.floor)
        if not repeated:
            self.check_times(REACH * solids)
        # frames that are lost near contact displace the others inward; a tracker that pushes looks like many lost
        most = math.inf if displaced <= 0 or repeated else _FEW if gap >= REACH * solids else sys.maxsize
        self.check_times(0.0, most)
        if math.isinf(gap):
            problem = "lie off a straight path the more, the nearer the spheres are: does the tracker bend it?"
            raise InputError(self.where, None, f"at least {LEAST} frames of a uniform approach", problem)
        return max(gap, REACH * solids) if self.rests and self.apart_still and self.free(REACH * solids) else gap

    def leave_out_near_frames(self) -> None:
        """Take frames near contact out of `before` and `after`; of those in `turned_only` the direction counts."""
        film, solids = self.film, self.film.solids
        self.gap = self.gap_near_contact() if film.near is None else film.near
        near = self.distance < solids + self.gap
        for mask, reach in ((self.before, film.touch), (self.after, film.apart)):  # the scene's gaps may be too small
            wide = self.distance > solids + (1 + _WIDER) * (reach - solids)
            if (mask & wide & ~near).sum() >= _MANY:
                mask &= wide
        self.turned_only = [flags & near & (film.near is None) for flags in (self.before, self.after)]
        if blank := int(((self.before | self.after) & near).sum()):
            use = "are left out" if film.near is not None else _BY_DIRECTION
            self.remarks.append(f"{blank} frames in which the gap is below {self.gap:.3g} m {use}")
        self.before, self.after = self.before & ~near, self.after & ~near
        self.check_count()

    # ---- lines

    def fit_lines(self) -> None:
        """`lines` before and after, the noise `sigma` about them; `first` and `last` by the frames that they use."""
        film, used, self.time = self.film, [self.before, self.after], self.time - self.time[self.first]
        self.lines: list[Line] = []
        sides = ((self.before, film.touch, -1), (self.after, film.apart, 1))
        for k, (mask, reach, side) in enumerate(sides[: 1 if self.sticks else 2]):
            for _ in range(_REFITS):  # frames by direction are free flight until the line meets
                line = line_through(self.time, self.relative, mask, used[k] & ~mask)
                used[k] = mask | (
                    self.turned_only[k] & (side * (self.time - state_at(line.course, reach, side)[3]) > 0)
                )
            self.lines.append(line)
        self.first = int(np.flatnonzero(used[0])[-1]) + 1
        if not self.sticks:
            self.last = int(np.flatnonzero(used[1])[0]) - 1
        squares, freedom = (sum(getattr(line, name) for line in self.lines) for name in ("squares", "freedom"))
        self.sigma = film.noise or math.sqrt(squares / freedom)
        if self.sigma > _BLURRED * film.solids:
            problem = (
                f"scatter by {self.sigma / math.sqrt(2):.3g} m about their lines: look at the scale and the tracker"
            )
            accepted = f"centres to {_BLURRED / math.sqrt(2):.2g} of the touching distance"
            raise InputError(self.where, None, accepted, problem)

    def gap_of_strays(self) -> float | None:
        """A wider gap to leave out, where a frame far off its line is near contact; None if all lie on their lines."""
        film, near = self.film, self.film.near
        for mask, reach, line in zip((self.before, self.after), (film.touch, self.sure), self.lines):
            passing = abs(flight_of(line.course)[1])
            if passing >= reach:
                problem = f"pass each other at {passing:.4g} m, beyond {reach:.4g} m: is the scale or the diameter off?"
                raise InputError(self.where, None, "two centres that come within the film", problem)
            frames, (start, velocity) = np.flatnonzero(mask), line.course
            off = np.linalg.norm(self.relative[mask] - start - self.time[mask, None] * velocity, axis=1)
            worst, usual = int(np.argmax(off)), max(float(np.median(off)), film.noise or 0.0)
            if off[worst] <= _STRAY * usual + _ROUNDING * film.touch:
                continue
            beside = self.distance[frames[worst]] - film.solids
            if near is None and beside < REACH * film.solids:
                return float(beside + _RESTING * film.solids)  # a tracker takes part of the other disc for this one
            problem = f"{off[worst]:.3g} m off its line at {self.names[frames[worst]]}, others {usual:.2g} m"
            raise InputError(self.where, None, "positions along straight lines", problem)
        return None

    def check_contact(self) -> None:
        """InputError where they do not meet, or too little is filmed of a stick; remarks on how near they come."""
        film, solids, time = self.film, self.film.solids, self.time
        end = float(np.median(self.distance[max(self.first, time.size - LEAST) :])) if self.sticks else self.least
        contact = film.path.subset(slice(self.first - 2, self.last + 3))
        again = [] if self.sticks else contact.repeated(self.sigma, film.rounding, uniform=False)
        if again:
            raise InputError(self.where, None, _FRAMES, f"has the same picture again after {contact.names[again[0]]}")
        if self.sticks:
            if self.apart_still and not (self.rests and end < (1 + REACH) * solids):
                problem = f"end {end:.4g} m apart, before the films meet at {film.touch:.4g} m"
                problem += ", and stay there: is the scale, the diameter or the tracker off?" * self.rests
                raise InputError(self.where, None, "two centres that come within the film", problem)
            if time.size - self.first < LEAST:
                problem = f"has {time.size - self.first} after they meet"
                raise InputError(self.where, None, f"at least {LEAST} frames after the films meet", problem)
            self.remarks.append(
                f"together to the end, {time[-1] - time[self.first]:.3g} s after they met: taken for a stick"
            )
        if (self.sticks and self.apart_still) or end < (1 - 2 * _RESTING) * solids - _CLEAR * self.sigma:
            self.remarks.append(
                f"its distance {'no longer changes' if self.sticks else 'is least'} at {end:.4g} m, where solids touch "
                f"at {solids:.4g} m and films at {film.touch:.4g} m: look at the scale, the diameter and the tracker"
            )

    # ---- results

    def of_lines(self, parameters: np.ndarray) -> np.ndarray:
        """Free flight, then speed, angle and results at the scene's gaps; nothing of a separation for a stick.

        Arguments:
            parameters: of the lines, and the relative error of the scale.
        """
        film, courses = self.film, (1 + parameters[-1]) * parameters[:-1].reshape(-1, 2, 2)
        sense = math.copysign(1.0, flight_of(self.lines[0].course)[1])
        at, normal, sideways, since = state_at(courses[0], film.touch, -1)
        speed, parameter, time_before, direction = flight_of(courses[0])
        free = [speed, sense * parameter]
        # the angle of the model, whose rotation rate is v0 tan(theta0)/(4a): that of touching solids
        row = [normal, math.atan2(abs(sideways) * film.solids / film.touch, normal)]
        if not self.sticks:
            then, opening, along, until = state_at(courses[1], film.apart, 1)
            turn = then - at - _TURN * round((then - at - self.turned_in_contact()) / _TURN)
            tangential = along / sideways if sideways else math.nan
            row += [-opening / normal, tangential, until - since, turn * math.copysign(1, sideways)]
            exit_speed, exit_parameter, time_after, direction_after = flight_of(courses[1])
            coming = math.remainder(at - direction - math.pi, _TURN)
            going = math.remainder(direction_after - then, _TURN)
            free += [exit_speed, sense * exit_parameter, time_after - time_before, sense * (coming + turn + going)]
        return np.array([*free, *row])

    @cached_property
    def turned(self) -> np.ndarray:
        """Direction of the line of centres at each frame, with whole turns, rad."""
        return np.unwrap(np.arctan2(self.relative[:, 1], self.relative[:, 0]))

    def turned_in_contact(self) -> float:
        turned = self.turned
        return float(turned[self.last + 1] - turned[self.first - 1])

    def at_gaps(self) -> tuple[dict[str, Any], float, list[str]]:
        """Results with standard deviations, the noise, and remarks."""
        centre = np.array([*(number for line in self.lines for number in line.course.ravel()), 0.0])
        blocks = [np.linalg.cholesky(line.covariance) * self.sigma for line in self.lines]
        steps = block_diag(*blocks, [[self.film.scale_sd]]).T  # independent deviations of the parameters
        moved = [self.of_lines(centre + _STEP * step) - self.of_lines(centre - _STEP * step) for step in steps]
        slopes = np.array(moved) / (2 * _STEP)
        covariance = slopes.T @ slopes
        sd = np.sqrt(np.diag(covariance))
        values = dict.fromkeys((name + suffix for name in (*_NAMES, *FLIGHT) for suffix in _WITH_SD), math.nan)
        count = 2 if self.sticks else len(FLIGHT)
        for name, value, error in zip([*list(FLIGHT)[:count], *_NAMES], self.of_lines(centre), sd):
            values |= {name: float(value), f"{name}_sd": float(error)}
        correlation = (covariance / np.maximum(np.outer(sd, sd), _LITTLE))[:count, :count][np.tril_indices(count, -1)]
        values |= {name + suffix: math.nan for name in self.unknown(values) for suffix in _WITH_SD}
        written = "" if self.sticks else " ".join(f"{number:.6f}" for number in correlation)
        return values | {"outcome": STICK if self.sticks else "", CORRELATION: written}, self.sigma, self.remarks

    def unknown(self, values: dict[str, float]) -> tuple[str, ...]:
        """Results of a separation that these lines do not tell, each with a remark; InputError without contact time."""
        if self.sticks:
            return ()
        unknown = tuple[str, ...]()
        if abs(values["exit_parameter"]) >= self.film.apart:
            unknown = OBSERVED
            rupture = "passes the other centre beyond the scene's rupture gap: no e_n there"
            self.remarks.append(f"its line after separation {rupture}")
        elif not values["contact_time"] > 0:
            problem = f"last {values['contact_time']:.3g} s: is the scale or the rate off?"
            raise InputError(self.where, None, "contacts that take time", problem)
        if values["angle"] <= _SIDEWAYS * values["angle_sd"]:
            self.remarks.append(
                "head-on within its uncertainty, so that e_t and the sense of the rotation are not known"
            )
            return (*unknown, *_SIGNED)
        if np.abs(np.diff(self.turned[self.first - 1 : self.last + 2])).max() > _FASTEST:
            self.remarks.append("it turns by more than 90 deg between two frames, so that its turns cannot be counted")
            return (*unknown, "rotation", "turn")
        return unknown
