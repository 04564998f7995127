"""`sensitivities()`: a scene in, derivatives of its collision's results out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath

import numpy as np

from ..buffered import LOCK
from ..errors import ComputationError, InputError, did_you_mean
from ..integrators import IntegrationFailed, Tolerance, tolerance
from ..locate import Locate, Path
from ..model import choose, load
from ..numbers import Numbers, numbers
from ..scene import Scene
from ..settings import check_engine, check_rtol
from . import nearness
from .derivatives import LANDED, LANDED_TWICE, adjoint, curvature, evaluate, forward, settled
from .flight import Course, Flight, course_of, flight, influential
from .parameters import SCALES, Kind, Way, check_hold, check_wrt, kind_of, references, way
from .quantities import QUANTITIES, SPENT, check_of, computed
from .result import Near, Sensitivities

METHODS = ("forward", "adjoint")
_BEST = "rosenbrock"  # its derivatives are some hundred times more accurate than those of CVODES at one tolerance
_LOOSEST = 1e-8  # the located flight only has to be near: landings take the rest


def check_method(method: object, label: str = "method") -> str:
    """How to differentiate; InputError if it is neither forward nor adjoint."""
    if not isinstance(method, str) or method not in METHODS:
        raise InputError(label, method, ", ".join(METHODS), "is not known" + did_you_mean(method, METHODS))
    return method


def sensitivities(
    scene: Scene | str | FilePath,
    of: Sequence[str] | str = ("restitution",),
    wrt: Sequence[str] | str | None = None,
    *,
    stokes: float | str | None = None,
    speed: float | str | None = None,
    angle: float | str | None = None,
    method: str = "forward",
    rtol: float = 1e-9,
    engine: str | None = None,
    hold: str = "speed",
    hessian: bool = False,
) -> Sensitivities:
    """Exact derivatives of a collision's results, through its events.

    Arguments:
        scene: a Scene, a path to a scene file, or a preset's name.
        of: results by name: `restitution`, `contact_time`, ..., `energy.capillary`.
        wrt: parameters by dotted name; None: every number of the scene, and the impact's speed, Stokes number and angle.
        stokes, speed, angle: the impact, as for `collide`.
        method: "forward" costs with the parameters asked, "adjoint" with the results.
        rtol: relative tolerance, 1e-13..1e-3.
        engine: "cvodes" or "rosenbrock"; None: rosenbrock, the more accurate one.
        hold: what of the impact stays when another parameter varies, its "speed" or its "stokes" number.
        hessian: second derivatives as well (rosenbrock only).

    Returns:
        Sensitivities: value, gradient and elasticity by name.

    Raises:
        InputError: a name or option is not acceptable.
        ComputationError: the flight could not be completed, or it is so near a boundary that no derivative exists.

    Example:
        >>> from wetdoublet.solvers import sensitivities
        >>> found = sensitivities("granulation", of=["restitution"], stokes=0.02, angle="75 deg")
        >>> found.gradient["restitution"]["bridge.surface_tension"] < 0
        True
    """
    of, method, hold = check_of(of), check_method(method), check_hold(hold)
    rtol, chosen = check_rtol(rtol), check_engine(engine)
    plugin = chosen or _BEST
    if hessian and plugin != "rosenbrock":
        raise InputError("engine", plugin, "rosenbrock", "has no second derivatives")
    loaded = Scene.load(scene).with_impact(stokes=stokes, speed=speed, angle=angle)
    names = check_wrt(loaded, wrt)
    v0, theta0 = loaded.need_impact()
    with LOCK:
        problem = Problem.of(loaded, v0, theta0, names, hold)
        return problem.solve(of, method, plugin, rtol, hessian)


@dataclass(frozen=True)
class Slopes:
    """Derivatives of a course's quantities in theta: z (q,), dz/dtheta (q, n), groups' d2z (q, n, n) if asked for."""

    value: np.ndarray
    first: np.ndarray
    second: np.ndarray | None


@dataclass(frozen=True)
class Problem:
    """A collision, the parameters to differentiate in, and the reference that theta is measured from."""

    scene: Scene
    n: Numbers
    wrt: tuple[str, ...]
    kind: Kind
    reference: np.ndarray

    @classmethod
    def of(cls, scene: Scene, speed: float, angle: float, wrt: tuple[str, ...], hold: str) -> Problem:
        """The problem of a scene's collision at a normal speed (m/s) and angle (rad)."""
        kind = kind_of(scene, hold)
        return cls(scene, numbers(scene, speed, angle), wrt, kind, references(scene, kind, speed, angle))

    def solve(self, of: tuple[str, ...], method: str, plugin: str, rtol: float, hessian: bool) -> Sensitivities:
        """Value, gradient and elasticity of the quantities `of`."""
        try:
            located, near = self.located(of, rtol)
        except ComputationError as error:
            raise self.n.in_si(error) from None
        todo = tuple(name for name in computed(of) if self._defined(name, located))
        slopes = self.slopes(located, todo, method, plugin, rtol, hessian) if todo else None
        return self._labelled(of, todo, slopes, located, near, method, plugin)

    def located(self, of: tuple[str, ...], rtol: float) -> tuple[Path, Near | None]:
        """The flight and the nearest boundary that it shows; ComputationError if that is too near."""
        finder = Locate(load(choose(self.scene, self.n.oblique)), self.n.groups, min(rtol, _LOOSEST))
        path = finder.run()
        near = nearness.checked(self.scene, self.n, finder, path, rtol)
        if not self.n.oblique and path.separated and self._odd(of):
            path = Locate(load(choose(self.scene, True)), self.n.groups, min(rtol, _LOOSEST)).run()
        return path, near

    def _odd(self, of: tuple[str, ...]) -> bool:
        """Whether something asked for begins to depend on the angle at zero."""
        return "impact.angle" in self.wrt and any(QUANTITIES[name].odd for name in of)

    def _defined(self, name: str, path: Path) -> bool:
        """Whether physics defines a quantity for the collision, as something that varies."""
        if name == "tangential_restitution" and not self.n.oblique:
            return False
        return path.separated or name == "energy.initial"

    def slopes(
        self, path: Path, of: tuple[str, ...], method: str, plugin: str, rtol: float, hessian: bool
    ) -> Slopes:
        """Derivatives in theta of the quantities of a located flight, in SI."""
        full = "energy.tangential_lubrication" in of
        course = course_of(path, choose(self.scene, path.model.oblique, full=full))
        told = tolerance(rtol, plugin, self.n.groups)
        whole = flight(course, of, plugin, told)
        via = way(self.kind, self.wrt, whole.groups)
        p, scales = np.split(via.values(self.reference).full().ravel(), [len(whole.groups)])
        slopes, _ = via.slopes(self.reference)
        active = influential(course, self.n.groups)
        first = np.asarray(slopes.full())
        dp, ds = first[: p.size] * np.array(active)[:, None], first[p.size :]
        durations = np.array([step.duration for step in path.steps])
        try:
            durations, z, dz = _differentiated(whole, course, p, durations, dp, active, method)
            if hessian:
                durations = settled(whole, p, durations, _landed(course), LANDED_TWICE)
                bent = _bent(whole, p, durations, dp, active)
        except IntegrationFailed as failure:
            raise ComputationError(
                f"{plugin} could not differentiate the flight ({failure})",
                phase=str(path.steps[-1].phase),
                advice="try another --rtol, or the other --engine",
            ) from None
        where = [SCALES.index(scale) if (scale := QUANTITIES[name].scale) else None for name in of]
        scale = np.array([1.0 if k is None else scales[k] for k in where])
        scaled = np.array([np.zeros(len(self.wrt)) if k is None else ds[k] for k in where]).reshape(len(of), -1)
        second = None
        if hessian:
            second = self._second(via, whole, z, dz, bent, scale, scaled, where)
        return Slopes(z * scale, dz @ dp * scale[:, None] + z[:, None] * scaled, second)

    def _second(
        self,
        via: Way,
        whole: Flight,
        z: np.ndarray,
        dz: np.ndarray,
        bent: np.ndarray,
        scale: np.ndarray,
        scaled: np.ndarray,
        where: list[int | None],
    ) -> np.ndarray:
        """Hessians in theta: of the flight in its groups, of the groups, and of the scales."""
        dp = np.asarray(via.slopes(self.reference)[0].full())[: len(whole.groups)]
        found = []
        for k in range(z.size):
            weights = np.concatenate([dz[k] * scale[k], np.zeros(len(SCALES))])
            if (at := where[k]) is not None:
                weights[len(whole.groups) + at] = z[k]
            crossed = np.outer(dz[k] @ dp, scaled[k])
            ways = np.asarray(via.bends(self.reference, weights).full())
            found.append(bent[k] * scale[k] + crossed + crossed.T + ways)
        return np.array(found)

    def _labelled(
        self,
        of: tuple[str, ...],
        todo: tuple[str, ...],
        slopes: Slopes | None,
        path: Path,
        near: Near | None,
        method: str,
        plugin: str,
    ) -> Sensitivities:
        units = self.units()
        values: dict[str, float | None] = {}
        gradients: dict[str, np.ndarray | None] = {}
        bends: dict[str, np.ndarray | None] = {}
        terms = dict(zip(todo, range(len(todo)), strict=True))
        for name in of:
            weights = np.zeros(len(todo))
            for part, sign in _parts(name):
                if part in terms:
                    weights[terms[part]] += sign
            if slopes is not None and all(part in terms for part, _ in _parts(name)):
                values[name] = float(weights @ slopes.value) + 0.0
                gradients[name] = weights @ slopes.first / units
                if slopes.second is not None:
                    bends[name] = np.einsum("k,kij->ij", weights, slopes.second) / np.outer(units, units)
            elif name == "restitution":
                values[name], gradients[name] = 0.0, np.zeros(len(units))
                bends[name] = np.zeros((len(units), len(units)))
            else:
                values[name], gradients[name], bends[name] = None, None, None
        reference = dict(zip(self.wrt, (self._value_of(name) for name in self.wrt), strict=True))
        return Sensitivities(
            value=values,
            gradient={name: _row(self.wrt, row) for name, row in gradients.items()},
            elasticity={
                name: _elasticities(reference, None if name == "energy.residual" else values[name], row)
                for name, row in gradients.items()
            },
            hessian=None
            if slopes is not None and slopes.second is None
            else {
                name: {
                    one: _row(self.wrt, None if matrix is None else matrix[k]) for k, one in enumerate(self.wrt)
                }
                for name, matrix in bends.items()
            },
            reference=reference,
            outcome=path.outcome,
            method=method,
            engine=plugin,
            hold=self.kind.hold,
            near=near,
            scene=self.scene,
        )

    def units(self) -> np.ndarray:
        """dp/dtheta of the parameters."""
        return np.asarray(way(self.kind, self.wrt, ()).slopes(self.reference)[1].full()).ravel()

    def _value_of(self, name: str) -> float:
        if name == "impact.speed":
            return self.n.speed
        if name == "impact.stokes":
            return self.n.stokes
        return float(self.reference[self.kind.entries.index(name)])


def _parts(name: str) -> list[tuple[str, float]]:
    """A quantity as a sum of what is computed."""
    if name != "energy.residual":
        return [(name, 1.0)]
    return [("energy.initial", 1.0), ("energy.final", -1.0), *((part, -1.0) for part in SPENT)]


def _row(names: tuple[str, ...], row: np.ndarray | None) -> dict[str, float | None]:
    return {name: None if row is None else float(row[k]) + 0.0 for k, name in enumerate(names)}


def _elasticities(
    reference: dict[str, float], value: float | None, row: np.ndarray | None
) -> dict[str, float | None]:
    found: dict[str, float | None] = {}
    for k, (name, p) in enumerate(reference.items()):
        found[name] = float(row[k]) * p / value + 0.0 if row is not None and value and p else None
    return found


def _landed(course: Course) -> np.ndarray:
    return np.array([k for k, leg in enumerate(course.legs) if leg.flown and leg.event is not None], dtype=int)


def _differentiated(
    whole: Flight,
    course: Course,
    p: np.ndarray,
    durations: np.ndarray,
    dp: np.ndarray,
    active: list[bool],
    method: str,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Durations, quantities, and their derivatives in the groups (those that no direction needs are left out)."""
    for _ in range(2):
        z, shifts, dz = _once(whole, p, durations, dp, active, method)
        if shifts.size == 0 or np.max(np.abs(shifts)) <= LANDED:
            return durations, z, dz
        durations = settled(whole, p, durations, _landed(course), LANDED)
    return durations, z, dz


def _once(
    whole: Flight, p: np.ndarray, durations: np.ndarray, dp: np.ndarray, active: list[bool], method: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One evaluation; derivatives in the groups are those along the directions that are asked for, at least."""
    if method == "adjoint":
        z, shifts, gradients = evaluate(adjoint(whole, len(whole.of)), p, durations, np.eye(len(whole.of)))
        return z.ravel(), shifts.ravel(), gradients.T
    seeds = _directions(p, dp, active)
    if seeds.shape[1] == 0:
        z, shifts = evaluate(whole.function, p, durations)
        return z.ravel(), shifts.ravel(), np.zeros((z.size, p.size))
    z, shifts, slopes = evaluate(forward(whole, seeds.shape[1]), p, durations, seeds)
    return z.ravel(), shifts.ravel(), slopes @ np.linalg.pinv(seeds)


def _directions(p: np.ndarray, dp: np.ndarray, active: list[bool]) -> np.ndarray:
    """Directions in the groups that span those of the parameters: theirs, or the groups' own if those are fewer.

    Each parameter's own direction where they are few; a group moves by itself, or by one where it is zero.
    """
    moving = [k for k in range(p.size) if active[k] and np.any(dp[k])]
    used = np.unique(dp[:, np.any(dp != 0, axis=0)], axis=1)  # speed and Stokes number are one
    if used.shape[1] < len(moving) and np.linalg.matrix_rank(used) == used.shape[1]:
        return used
    own = np.zeros((p.size, len(moving)))
    own[moving, range(len(moving))] = [p[k] or 1.0 for k in moving]
    return own


def _bent(
    whole: Flight, p: np.ndarray, durations: np.ndarray, dp: np.ndarray, active: list[bool]
) -> np.ndarray:
    """Hessians of the quantities along the parameters' directions, by their own directions in the groups."""
    seeds = _directions(p, dp, active)
    back = np.linalg.pinv(seeds) @ dp
    found = []
    for k in range(len(whole.of)):
        weights = np.zeros(len(whole.of))
        weights[k] = 1.0
        if seeds.shape[1] == 0:
            found.append(np.zeros((dp.shape[1], dp.shape[1])))
            continue
        [product] = evaluate(curvature(whole, seeds.shape[1]), p, durations, weights, seeds)
        matrix = back.T @ (seeds.T @ product) @ back
        found.append((matrix + matrix.T) / 2)
    return np.array(found)
