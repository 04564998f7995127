"""Impacts measured in free flight: what is seen of a collision before its films meet and after it has separated.

Far from each other two spheres move straight. The line before an impact has a relative speed and an impact parameter,
its least distance from the other centre; the line after it has an exit speed and an exit parameter. Between the
instants of these least distances lies the delay; the turn is that of the line of centres from long before to long
after, 0 for a head-on rebound. None of these needs the gaps at which the film touches and the bridge ruptures: the
model has them, and flies on to the same lines.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..boundaries.experiment import LENGTHS, STEEPEST, Experiment, Results, Rows
from ..engines.settings import KERNEL_STEPS
from ..engines.taylor.call import KernelImpacts
from ..errors import InputError
from ..scene.groups import formulas

ARRIVING = {"relative_speed": "m/s", "impact_parameter": "m"}
DEPARTING = {"exit_speed": "m/s", "exit_parameter": "m", "delay": "s", "turn": "rad"}
"""Results of a flight and their units; the exit parameter and the turn are positive in the sense of the approach."""
FLIGHT = {**ARRIVING, **DEPARTING}

_COLLIDED = ("restitution", "tangential_restitution", "contact_time", "rotation")
_ROUNDED = 1e-6  # of correlations, as they are written
_TINY = 1e-200  # imaginary step of derivatives


@dataclass(frozen=True)
class Flights:
    """Lines before and after the impacts of a table, and how their errors depend on each other.

    Attributes:
        names: of ARRIVING and what is measured of DEPARTING.
        reach: (rows,), distance of the centres (m) at which speeds and angles of the rows' scatter are taken.
        values: (names, rows), as measured.
        regression: (rows, names, names), error of a value that is expected by those of the values before it.
    """

    names: tuple[str, ...]
    reach: np.ndarray
    values: np.ndarray
    regression: np.ndarray

    @classmethod
    def of(
        cls, measured: Mapping[str, tuple[np.ndarray, np.ndarray]], correlation: np.ndarray, reach: float
    ) -> tuple[Flights, np.ndarray]:
        """The flights, and standard deviations (names, rows) beside the values before.

        Arguments:
            measured: name -> values and standard deviations.
            correlation: (rows, FLIGHT, FLIGHT).
            reach: of the scene, m.
        """
        places = [list(FLIGHT).index(name) for name in measured]
        values, sd = (np.array(column) for column in zip(*measured.values()))
        valid = np.isfinite(values) & (sd > 0)
        sd = np.where(valid, sd, 1.0)
        both = valid.T[:, :, None] & valid.T[:, None]
        rows = np.where(both, (1 - _ROUNDED) * correlation[:, places][:, :, places], 0.0)
        rows += np.eye(len(places)) * np.where(both, _ROUNDED, 1.0)
        try:
            lower = np.linalg.cholesky(rows)
        except np.linalg.LinAlgError:
            raise InputError("data, column correlation", None, "a positive definite matrix", "is none") from None
        own = np.diagonal(lower, axis1=1, axis2=2)
        regression = np.eye(len(places)) - np.linalg.inv(lower / own[:, None])
        regression *= sd.T[:, :, None] / sd.T[:, None]
        passing = values[1] + 3 * sd[1]  # a line that passes beyond has no angle there
        return cls(tuple(measured), np.maximum(reach, passing), np.where(valid, values, 0.0), regression), sd * own.T

    def subset(self, which: np.ndarray) -> Flights:
        return Flights(self.names, self.reach[which], self.values[:, which], self.regression[which])


class FlightRows(Rows):
    """The quantities of rows that were measured in free flight, with the distances at which contact begins and ends."""

    def __init__(self, flights: Flights, *others: Any) -> None:
        self.flights = flights
        super().__init__(*others)

    def lengths(self, by_quantity: Mapping[str, Any]) -> dict[str, Any]:
        ratio = by_quantity["radius_ratio"]
        solids = by_quantity["reduced_radius"] * (1 + ratio) ** 2 / ratio
        rupture: Callable[..., Any] = lambda: 1.0  # noqa: E731 -- the film's
        names: tuple[str, ...] = ()
        if self.scene.bridge is not None:
            rupture, names = formulas(self.scene)["rupture_gap"]
        film = by_quantity["film_thickness"]
        return dict(
            zip(LENGTHS, (solids, solids + film, solids + film * rupture(*(by_quantity[name] for name in names))))
        )

    def unchecked(self, values: np.ndarray) -> Experiment:
        return FlightExperiment(**vars(super().unchecked(values)))


@dataclass(frozen=True)
class FlightExperiment(Experiment):
    """Collisions whose speeds and angles are those of the line of approach at each row's `Flights.reach`."""

    rows: FlightRows

    @property
    def collisions(self) -> Experiment:
        """The same, with speeds and angles at initial contact."""
        return Experiment(self.rows, self.values, self.columns, self.slopes, self.rtol)

    def _distances(self, row: np.ndarray) -> list[np.ndarray]:
        return [self.columns[name][row] for name in LENGTHS]

    def _arrival(self, row: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> list[np.ndarray]:
        return [*self._distances(row), self.rows.flights.reach[row % self.rows.size], speed, angle]

    def impacts(self, row: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> KernelImpacts:
        return self.collisions.impacts(row, *_at_contact(*self._arrival(row, speed, angle)))

    def plain(self, names: tuple[str, ...], row: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> np.ndarray:
        arrival = self._arrival(row, speed, angle)
        at = _at_contact(*arrival)
        if not set(names) & set(DEPARTING):
            return self.collisions.plain(names, row, *at)
        values = self.collisions.plain(_COLLIDED, row, *at)
        return self._expected(names, row, np.array([*_approach(*arrival), *_flown(*arrival[:3], *at, *values)]))[0]

    def results(
        self, names: tuple[str, ...], row: np.ndarray, speed: np.ndarray, angle: np.ndarray, forward: bool = False,
        budget: int = KERNEL_STEPS,
    ) -> Results:  # fmt: skip
        arrival = self._arrival(row, speed, angle)
        at, by = _with_slopes(_at_contact, arrival)
        flown = bool(set(names) & set(DEPARTING))
        of_collision = self.collisions.results(
            _COLLIDED if flown else names, row, at[0], at[1], forward=forward, budget=budget
        )
        free = np.array([self.slopes[name][row] for name in LENGTHS])  # of the distances
        moved = np.einsum("cdn,dnp->cnp", by[:, :3], free)  # normal speed and angle at contact
        of_contact = np.array([of_collision.speed, of_collision.angle])
        value, by_free = of_collision.value, of_collision.free + np.einsum("crn,cnp->rnp", of_contact, moved)
        by_speed, by_angle = (np.einsum("crn,cn->rn", of_contact, by[:, k]) for k in (4, 5))
        if flown:
            first, at_first = _with_slopes(_approach, arrival)
            last, at_last = _with_slopes(_flown, [*arrival[:3], *at, *value])
            value = np.concatenate([first, last])
            inner = at_last[:, 3:5]
            by_free = np.concatenate([
                np.zeros((len(first), *free.shape[1:])),
                np.einsum("kdn,dnp->knp", at_last[:, :3], free) + np.einsum("kcn,cnp->knp", inner, moved)
                + np.einsum("krn,rnp->knp", at_last[:, 5:], by_free),
            ])  # fmt: skip
            by_speed, by_angle = (
                np.concatenate([at_first[:, k], np.einsum("kcn,cn->kn", inner, by[:, k])
                                + np.einsum("krn,rn->kn", at_last[:, 5:], slope)])
                for k, slope in ((4, by_speed), (5, by_angle))
            )  # fmt: skip
            value, by_free, by_speed, by_angle = self._expected(names, row, value, by_free, by_speed, by_angle)
        return replace(of_collision, value=value, free=by_free, speed=by_speed, angle=by_angle)

    def _expected(
        self, names: tuple[str, ...], row: np.ndarray, value: np.ndarray, *slopes: np.ndarray
    ) -> list[np.ndarray]:
        """What these results are expected to be measured as, from the errors of the values before; and its slopes.

        Arguments:
            value: of all FLIGHT, (FLIGHT, impacts); slopes likewise.
        """
        flights, row = self.rows.flights, row % self.rows.size
        places = [list(FLIGHT).index(name) for name in flights.names]
        which = [flights.names.index(name) for name in names]
        own = (np.eye(len(places)) - flights.regression)[row]
        first = value[places] + np.einsum("njk,kn->jn", flights.regression[row], flights.values[:, row] - value[places])
        return [first[which], *(np.einsum("njk,kn...->jn...", own, slope[places])[which] for slope in slopes)]


def _approach(solids: Any, touch: Any, apart: Any, reach: Any, speed: Any, angle: Any) -> list[Any]:  # noqa: ARG001
    """Relative speed and impact parameter of a line with this normal speed and angle at a distance `reach`."""
    return [speed / np.cos(angle), reach * np.sin(angle)]


def _at_contact(solids: Any, touch: Any, apart: Any, reach: Any, speed: Any, angle: Any) -> list[Any]:
    """Normal speed and impact angle of the model where the films touch."""
    total, parameter = _approach(solids, touch, apart, reach, speed, angle)
    sine = parameter / touch
    sine = np.where(np.abs(sine) < np.sin(STEEPEST), sine, np.sign(np.real(sine)) * np.sin(STEEPEST))
    normal = total * np.sqrt(1 - sine**2)
    return [normal, np.arctan(total * sine * solids / (touch * normal))]


def _flown(
    solids: Any, touch: Any, apart: Any, normal: Any, angle: Any, e_n: Any, e_t: Any, time: Any, rotation: Any
) -> list[Any]:
    """Exit speed and parameter, delay and turn of a collision that begins at `touch` and ends at `apart`."""
    sideways = normal * np.tan(angle) * touch / solids
    opening, along = e_n * normal, np.where(np.abs(angle) > 0, e_t, 0.0) * sideways
    before, after = normal**2 + sideways**2, opening**2 + along**2
    with np.errstate(invalid="ignore", divide="ignore"):  # of sticks
        delay = time - touch * normal / before - apart * opening / after
        turn = rotation + np.arctan(sideways / normal) + np.arctan(along / opening)
        return [np.sqrt(after), apart * along / np.sqrt(after), delay, turn]


def _with_slopes(function: Callable[..., list[Any]], arguments: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Values, and derivatives (values, arguments, impacts) by complex steps."""
    count = range(len(arguments))
    steps = [function(*(argument + 1j * _TINY * (j == k) for j, argument in enumerate(arguments))) for k in count]
    return np.array(function(*arguments)), np.moveaxis(np.imag(steps) / _TINY, 0, 1)
