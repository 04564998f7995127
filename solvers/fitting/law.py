"""The collision law at points of many rows: outcomes, results, and their derivatives by the free entries.

All points of a call go through the kernel together. Quantities that differ between rows, or from the scene's, are
passed as columns, so that no scene is made anew.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from casadi import SX, Function, densify, jacobian, vertcat

from ...generated.automaton import LAST_ANSWER, Status
from ..engines.taylor.call import Impacts, run_kernel
from ..engines.taylor.tangent import COLUMNS, differentiates, run_tangent
from ..errors import ComputationError
from ..many.batch import Batch
from ..many.by_kernel import admissible
from ..many.compute import compute
from ..many.dataset import empty, fill
from ..scene.quantities import quantities
from ..scene.scene import Scene
from ..scene.schema import MEETING, SPINS
from ..settings import KERNEL_STEPS
from .measurements import Measurements

UNDECIDED = -1
_ENDLESS = (Status.NO_BUDGET, Status.CHATTER)  # the other engines' budget of steps is the same
_HEAD_ON = 1e-12  # angle (rad) below which an impact is head-on: rounding on a line along the speeds
_ANGLE = np.radians(89.5)  # largest impact angle at which a scattered impact is computed
_PLACES: dict[str, tuple[int, int | str]] = {  # column of the derivative, field of the value
    "restitution": (0, 0),
    "tangential_restitution": (1, 1),
    "contact_time": (COLUMNS["time"], "time"),
    "rotation": (COLUMNS["turned"], "turned"),
}
_SPIN_QUANTITIES = ("impact_spin", "impact_partner_spin")


@dataclass(frozen=True)
class Results:
    """Results at points and their derivatives, SI; NaN where the kernel has none.

    Attributes:
        outcome: (points,).
        value: (results, points).
        free: (results, points, free entries), by the free entries' own values.
        speed, angle: (results, points), by normal speed and angle.
    """

    outcome: np.ndarray
    value: np.ndarray
    free: np.ndarray
    speed: np.ndarray
    angle: np.ndarray


class Law:
    """The collision law of a scene with free entries, for the rows of a measurement.

    Arguments:
        scene: the scene.
        names: the free entries, dotted.
        data: the rows.
        rtol: relative tolerance of the integrations.

    Raises:
        ComputationError: the kernel does not differentiate the scene's collisions here.
    """

    def __init__(self, scene: Scene, names: tuple[str, ...], data: Measurements, rtol: float) -> None:
        self.scene, self.names, self.data, self.rtol = scene, names, data, rtol
        if not differentiates(scene, (True,)):
            raise _without_kernel()
        self.parts = np.array([bool(np.isfinite(scene.fields[name].range.high)) for name in names], bool)
        own: dict[str, Any] = {name: value for name, value in scene.si if name not in MEETING}
        self._own = own | dict(data.columns)
        entries = [*names, *data.columns]
        column = SX.sym("entries", len(entries))
        by_name = {name: column[k] for k, name in enumerate(entries)}
        of = quantities(own | by_name, scene.ways)
        self._quantities = tuple(name for name, value in of.items() if name != "density")
        stacked = vertcat(*(SX(of[name]) for name in self._quantities))
        slopes = jacobian(stacked, column[: len(names)]) if names else SX(stacked.numel(), 0)
        self._map = Function("quantities", [column], [densify(stacked), densify(slopes)])

    def at(self, values: np.ndarray) -> BoundLaw | None:
        """The law with these values of the free entries; None where they make a row's scene impossible."""
        by_quantity, slopes = self._mapped(values)
        if not _possible(self.scene, by_quantity).all():
            return None
        rows = self.data.size if self.data.columns else 1
        jac = slopes.reshape(len(self._quantities), rows, len(self.names))
        return BoundLaw(self, values, by_quantity, dict(zip(self._quantities, jac, strict=True)))

    def impossible(self, values: np.ndarray) -> np.ndarray:
        """Indices of the rows whose scene is impossible with these values; row 0 stands for all without columns."""
        return np.flatnonzero(~_possible(self.scene, self._mapped(values)[0]))

    def _mapped(self, values: np.ndarray) -> tuple[dict[str, np.ndarray], np.ndarray]:
        rows = self.data.size if self.data.columns else 1
        given = [np.full(rows, value) for value in values.tolist()] + list(self.data.columns.values())
        mapped, slopes = self._map.map(rows)(np.array(given))
        return dict(zip(self._quantities, np.asarray(mapped.full()), strict=True)), np.asarray(slopes.full())


def _possible(scene: Scene, by_quantity: Mapping[str, np.ndarray]) -> np.ndarray:
    finite = np.isfinite(list(by_quantity.values())).all(axis=0)
    found: np.ndarray = finite & admissible(scene, by_quantity)
    return found


@dataclass(frozen=True)
class BoundLaw:
    """The law with given values of the free entries.

    Attributes:
        quantities: vocabulary name -> (rows,), or (1,) where all rows share them.
        slopes: vocabulary name -> (rows, free entries), or (1, free entries).
    """

    law: Law
    values: np.ndarray
    quantities: Mapping[str, np.ndarray]
    slopes: Mapping[str, np.ndarray]

    @property
    def scales(self) -> np.ndarray:
        """(free entries,), of which steps of differences are parts: 1 for fractions and angles, which may be 0."""
        found: np.ndarray = np.where(self.law.parts, 1.0, np.abs(self.values))
        return found

    def outcomes(self, row: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> np.ndarray:
        """Outcomes at normal speeds (m/s) and angles (rad; a negative one is its mirror image) of these rows.

        What the kernel follows until its budget of steps ends, and whatever no engine follows to the end, is UNDECIDED.
        """
        impacts = self.impacts(row, speed, angle)
        found = run_kernel(impacts, self.law.rtol, jumps=2)
        if found is None:
            raise _without_kernel()
        outcome: np.ndarray = found["outcome"].astype(np.int8)
        late = np.flatnonzero(found["status"] > LAST_ANSWER)
        outcome[late] = UNDECIDED
        late = late[~np.isin(found["status"][late], _ENDLESS)]
        if late.size:
            outcome[late] = self._completed(row[late], impacts.part(late))
        return outcome

    def results(
        self,
        of: tuple[str, ...],
        row: np.ndarray,
        speed: np.ndarray,
        angle: np.ndarray,
        forward: bool = False,
        budget: int | None = None,
    ) -> Results:
        """Results at points, with derivatives.

        Arguments:
            forward: carry all derivatives forward, also where the restitution's could be taken back.
            budget: steps of a trajectory, where longer ones may be left out.
        """
        impacts = self.impacts(row, speed, angle)
        count, size = row.size, len(self.law.names)
        found = Results(
            np.zeros(count, np.int8),
            np.full((len(of), count), np.nan),
            np.zeros((len(of), count, size)),
            np.zeros((len(of), count)),
            np.zeros((len(of), count)),
        )
        turns = impacts.oblique
        for oblique in (True, False):
            which = np.flatnonzero(turns == oblique)
            if which.size:
                self._fill(found, of, row, impacts, which, oblique, forward, budget or KERNEL_STEPS)
        found.angle[:] *= np.where(angle < 0, -1.0, 1.0)
        if "rotation" in of:
            mirrored = angle < 0
            k = of.index("rotation")
            found.value[k, mirrored] *= -1
            found.free[k, mirrored] *= -1
            found.speed[k, mirrored] *= -1
            found.angle[k, mirrored] *= -1
        return found

    def plain(self, of: tuple[str, ...], row: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> np.ndarray:
        """The results alone, (results, points): of long trajectories in a fraction of the time."""
        impacts = self.impacts(row, speed, angle)
        whole = not set(of) <= {"restitution", "tangential_restitution"}  # times and angles need every step
        answers = run_kernel(impacts, self.law.rtol, "rotation" in of, jumps=0 if whole else 2)
        if answers is None:
            raise _without_kernel()
        done = (answers["status"] <= LAST_ANSWER) & (answers["outcome"] > 0)
        found = np.empty((len(of), row.size))
        for k, name in enumerate(of):
            value = _value(answers, name)
            if name == "contact_time":
                value = value * (self.quantities["film_thickness"][self._share(row)] / impacts.speed)
            found[k] = np.where(done, value, np.nan) * np.where((angle < 0) & (name == "rotation"), -1, 1)
        return found

    def _share(self, row: np.ndarray) -> np.ndarray:
        """Index of each point's quantities."""
        return row if next(iter(self.quantities.values())).size > 1 else np.zeros(row.size, int)

    def _fill(
        self,
        into: Results,
        of: tuple[str, ...],
        row: np.ndarray,
        impacts: Impacts,
        which: np.ndarray,
        oblique: bool,
        forward: bool,
        budget: int,
    ) -> None:
        those, rtol = impacts.part(which), self.law.rtol
        moved = tuple(name for name, slope in self.slopes.items() if slope.any())
        wanted = (*moved, "speed", "angle")
        back = not forward and of == ("restitution",)
        rotation = "rotation" in of
        run = run_tangent(those, oblique, rtol, rotation, None if back else wanted, None, budget, back, False)
        if run is None:
            raise _without_kernel()
        answers, slopes, names = run.answers, run.slopes, run.quantities
        late = np.flatnonzero(answers["status"] > LAST_ANSWER)
        if back and late.size:
            again = run_tangent(those.part(late), oblique, rtol, rotation, wanted, None, budget, False, False)
            assert again is not None
            answers[late], slopes[late] = again.answers, again.slopes[:, :, :1]
        done = (answers["status"] <= LAST_ANSWER) & (answers["outcome"] > 0)
        into.outcome[which] = np.where(answers["status"] <= LAST_ANSWER, answers["outcome"], -1)
        share = self._share(row[which])
        for k, name in enumerate(of):
            column, value = _PLACES[name][0], _value(answers, name)
            by = {one: slopes[:, names.index(one), column] for one in wanted if one in names}
            by_speed, by_angle = by.pop("speed").copy(), by.pop("angle", np.zeros(which.size)).copy()
            free = np.zeros((which.size, len(self.law.names)))
            for one, each in by.items():
                free += each[:, None] * self.slopes[one][share]
            if name == "contact_time":
                film = self.quantities["film_thickness"][share]
                scale = film / those.speed
                by_film = self.slopes["film_thickness"][share] / film[:, None]
                free = (free + value[:, None] * by_film) * scale[:, None]
                by_speed = (by_speed - value / those.speed) * scale
                by_angle, value = by_angle * scale, value * scale
            into.value[k, which] = np.where(done, value, np.nan)
            into.free[k, which], into.speed[k, which], into.angle[k, which] = free, by_speed, by_angle

    def displaced(self, k: int, value: float) -> BoundLaw | None:
        """The law with another value of free entry k."""
        values = self.values.copy()
        values[k] = value
        return self.law.at(values)

    def impacts(self, row: np.ndarray, speed: np.ndarray, angle: np.ndarray, every: bool = False) -> Impacts:
        """Impacts on these rows.

        Arguments:
            every: pass all quantities as columns, the scene's own too.
        """
        scene = self.law.scene
        others = {}
        mirrored = np.where(angle < 0, -1.0, 1.0)
        for name, values in self.quantities.items():
            if values.size == 1 and not every and float(values[0]) == scene.material.get(name):
                continue
            others[name] = values[row] if values.size > 1 else np.full(row.size, values[0])
        for name in _SPIN_QUANTITIES:
            spin = self.quantities.get(name)
            if spin is not None and spin.any() and (angle < 0).any():
                others[name] = (spin[row] if spin.size > 1 else np.full(row.size, spin[0])) * mirrored
        size = np.abs(angle)
        return Impacts(scene, speed, np.where(size < _HEAD_ON, 0.0, np.minimum(size, _ANGLE)), others)

    def _completed(self, row: np.ndarray, impacts: Impacts) -> np.ndarray:
        """Outcomes of collisions that the kernel hands over, by the engines that finish them."""
        law = self.law
        vary = {name: np.full(row.size, value) for name, value in zip(law.names, self.values.tolist(), strict=True)}
        vary |= {name: values[row] for name, values in law.data.columns.items()}
        for name in SPINS:
            quantity = impacts.others.get(name.replace("impact.", "impact_"))
            if name in vary or (quantity is not None and name in law.scene.entries):
                vary[name] = np.asarray(quantity)
        request = Batch(law.scene, None, impacts.speed, impacts.angle, vary, law.rtol, "rosenbrock", ())
        results = empty(request.size, ())
        compute(request, np.arange(request.size), lambda where, block: fill(results, where, block))
        found: np.ndarray = results["outcome"]
        return found


def _value(answers: np.ndarray, name: str) -> np.ndarray:
    where = _PLACES[name][1]
    found: np.ndarray = (answers[where] if isinstance(where, str) else answers["shown"][:, where]).copy()
    return found


def outcomes_under(laws: Sequence[BoundLaw], row: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Outcomes of points under several laws of the same scene, by the kernel alone.

    Arguments:
        row, speed, angle: the points of the first law, of the second, and so on, as many of each.
    """
    found = _run_under(laws, row, speed, angle, 2)
    outcome: np.ndarray = np.where(found["status"] > LAST_ANSWER, UNDECIDED, found["outcome"]).astype(np.int8)
    return outcome


def times_under(laws: Sequence[BoundLaw], row: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Contact times over x0/v0 of the same; NaN for a doublet that stays."""
    found = _run_under(laws, row, speed, angle, 0)
    done = (found["status"] <= LAST_ANSWER) & (found["outcome"] > 0)
    times: np.ndarray = np.where(done, found["time"], np.nan)
    return times


def _run_under(
    laws: Sequence[BoundLaw], row: np.ndarray, speed: np.ndarray, angle: np.ndarray, jumps: int
) -> np.ndarray:
    parts = [slice(k * row.size // len(laws), (k + 1) * row.size // len(laws)) for k in range(len(laws))]
    made = [law.impacts(row[part], speed[part], angle[part], every=True) for law, part in zip(laws, parts)]
    others = {name: np.concatenate([each.others[name] for each in made]) for name in made[0].others}
    at = (np.concatenate([each.speed for each in made]), np.concatenate([each.angle for each in made]))
    found = run_kernel(Impacts(made[0].scene, *at, others), laws[0].law.rtol, jumps=jumps)
    if found is None:
        raise _without_kernel()
    return found


def _without_kernel() -> ComputationError:
    return ComputationError(
        "a fit needs derivatives by the compiled kernel, which this scene or machine has not",
        advice="install a C compiler, or leave out laws that have no derivative",
    )
