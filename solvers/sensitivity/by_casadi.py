"""Derivatives of a collision by CasADi: the phases that the kernel has found, as one differentiable expression.

    groups p -> start -> flow -> landing -> jump -> flow -> landing -> ... -> outputs

* `start`, the right-hand sides, the events' guards, the rebounds and `outputs` are the emitted functions of the model.
* A *flow* is CVODES or Rosenbrock over the duration of a phase, a constant (`engines/casadi/integrators.py`).
* A *landing* is one Taylor step onto the surface of the event that ends the phase. At the durations of the replay it is
  almost zero, but its derivative is the saltation.
* CasADi differentiates the whole: forward, one direction in the groups after another, or adjoint, a result at a time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from casadi import DM, MX, Function, densify, fmin, jtimes, vertcat

from ..collision.by_kernel import sequence_of
from ..engines.casadi.integrators import IntegrationFailed, Tolerance, failures, landing, plain, quiet
from ..engines.casadi.replay import Replay, Stopped, replayed
from ..engines.casadi.sequence import EventSequence, PhaseRun
from ..errors import ComputationError
from ..host.thread_caches import own_cache
from ..model.key import ModelKey
from ..model.model import Model, load, select_model
from ..model.phases import Flow, extra_units
from ..model.rebound import reset, rubs
from ..results import DEFINITIONS
from ..scene.contact import GAPS, contact_word
from .boundary_distance import SADDLE, check_grip
from .parameters import SCALES, parameter_map
from .problem import NEAR, Problem, Query, Slopes

_SHARPEST_CVODES = 3e-12  # smallest tolerance of CVODES with sensitivities; below it some integrations fail
STATE = "state."  # begins the name of a component of the last state, among results
# Largest landing relative to its phase, and that wanted of a trajectory that amplifies errors. The error of a
# derivative is its square times the amplification, near a saddle one over the distance. Beyond `_LOST` no correction
# of durations helps.
_LANDED, _AMPLIFIED, _LOST = 3e-7, 1e-10, 0.5
# The same in x0/v0: a long phase that creeps to its event changes by as much however long it took; rounding.
_LONG, _ROUNDED = 1e-5, 1e-13
_TRIES = 8


# ---- the expression


@dataclass(frozen=True)
class Course:
    """A model and the legs of a collision: the key of its cached expression.

    A leg is a phase of the record, without its times and words, or its part up to a kink; its duration is 1, or 0 where
    the event happens as the last leg ends.
    """

    choice: ModelKey
    extras: tuple[str, ...]  # quadratures
    legs: tuple[PhaseRun, ...]
    edge_watched: bool

    @cached_property
    def model(self) -> Model:
        return load(self.choice)

    @property
    def durations(self) -> int:
        """How many legs are integrated."""
        return sum(leg.duration > 0 for leg in self.legs)

    def reset(self, leg: PhaseRun) -> Function:
        """What happens at the end of a leg (`model.rebound.reset`)."""
        return reset(self.choice, leg.criterion, leg.holds, leg.own)

    def influences(self, groups: Mapping[str, float]) -> np.ndarray:
        """Mask of the groups that influence the course: not those of rebound criteria that it does not meet."""
        landed = {leg.event for leg in self.legs}
        met = GAPS[contact_word(groups)] if "contact" in landed else None
        absent = {
            "glass_number": "glass" not in landed,
            **{gap: gap != met for gap in GAPS.values()},
            "dry_restitution": not any(leg.rebounds for leg in self.legs),
            **dict.fromkeys(
                ("friction", "contact_tangential_restitution"),
                not any(rubs(self.model, leg.criterion) for leg in self.legs),
            ),
        }
        return np.array([not absent.get(name, False) for name in self.model.groups])


def course_of(path: EventSequence, replay: Replay, choice: ModelKey) -> Course:
    """The course of a replay of a collision; phases are its pieces, which kinks of a law's force divide."""
    model, pieces, legs = load(choice), iter(replay.pieces), []
    for step in path.steps:
        last = replace(step, duration=0.0, event=None, kinds=step.kinds[:1] if step.rebounds else ())
        if step.duration > 0:
            piece = next(pieces)
            while piece.event in model.kinks:
                legs.append(PhaseRun(piece.phase, 1.0, piece.event, ()))
                piece = next(pieces)
            last = replace(last, phase=piece.phase, duration=1.0, event=piece.event)
        legs.append(last)
    return Course(choice, replay.extras, tuple(legs), path.edge_watched)


@dataclass
class End:
    """Last state of a course and what it sums up, as expressions in the groups and durations; `y` has the extras."""

    start: MX
    y: MX
    time: MX
    smallest_gap: MX
    lost: MX  # by rebounds, by their friction, to declared events
    shifts: list[MX]  # by the landings, relative to the durations


def follow(course: Course, p: MX, durations: MX, plugin: str, tolerance: Tolerance) -> End:
    """A course from initial contact on."""
    model, k = course.model, 0
    size = len(model.state)
    start = model.function("start")(DM.zeros(size), p)
    y = vertcat(start, DM.ones(len(course.extras)) * tolerance.offset)
    at = End(start, y, MX(0), start[0], MX.zeros(3), [])
    for leg in course.legs:
        if leg.duration > 0:
            flow = Flow(course.choice, leg.phase.region, course.extras, course.edge_watched)
            at.y = plain(flow, plugin, tolerance).function(x0=at.y, p=vertcat(p, durations[k]))["xf"]
            at.time += durations[k]
            shift = MX(0)
            if leg.event is not None:
                at.y, shift, _ = landing(flow, leg.event)(at.y, vertcat(p, leg.phase.motion))
            at.time += shift
            at.shifts.append(shift / durations[k])
            at.smallest_gap = fmin(at.smallest_gap, at.y[0])
            k += 1
        if leg.rebounds or leg.holds or leg.own:
            after, *lost, _ = course.reset(leg)(at.y[:size], p)
            at.lost += vertcat(*lost)
            at.y = vertcat(after, at.y[size:])
    return at


@own_cache(256)
def trajectory(course: Course, of: tuple[str, ...], plugin: str, tolerance: Tolerance) -> Function:
    """A course as a function: (groups, durations) -> results `of`, and shifts of the durations by the landings."""
    p, durations = MX.sym("groups", len(course.model.groups)), MX.sym("durations", course.durations)
    end = follow(course, p, durations, plugin, tolerance)
    shifts = vertcat(*end.shifts) if end.shifts else MX(0, 1)
    named = results(course, p, end, tolerance)
    column = vertcat(*(named.get(name, MX(0)) for name in of))
    return Function("trajectory", [p, durations], [column, shifts])


def results(course: Course, p: MX, end: End, tolerance: Tolerance) -> dict[str, MX]:
    """Results by their names in `DEFINITIONS`, and the last state by `STATE` and the names of its components."""
    model = course.model
    size = len(model.state)
    y = end.y[:size]
    outputs, before, after = (
        model.function("outputs")(y, p),
        *(model.function("energies")(s, p) for s in (end.start, y)),
    )
    named = dict(zip(model.names("outputs"), (outputs[k] for k in range(outputs.numel())), strict=True))
    energies = {name: (before[k], after[k]) for k, name in enumerate(model.names("energies"))}
    named |= {"contact_time": end.time, "smallest_gap": end.smallest_gap}
    named |= {"energy.dry_contact": end.lost[0], "energy.own_events": end.lost[2]}
    named["energy.initial"], named["energy.final"] = energies["kinetic"]
    if "strings" in energies:
        named["energy.strings"] = energies["strings"][1] - energies["strings"][0]
    if model.oblique:
        first, last = (model.function("surface_slip")(state, p) for state in (end.start, y))
        named["slip_restitution"] = last / first
    if "rotation" in model.state:
        named["rotation"] = y[list(model.state).index("rotation")]
    for k, (name, unit) in enumerate(zip(course.extras, extra_units(model, course.extras, p), strict=True)):
        named[name if name == "rotation" else f"energy.{name}"] = unit * (end.y[size + k] - tolerance.offset)
    if model.own_terms:
        before, after = energies.get("own_energy", (MX(0), MX(0)))
        named["energy.own_terms"] = after - before + named.pop("energy.own_work", MX(0))
    named["energy.dry_friction"] = named.get("energy.dry_friction", MX(0)) + end.lost[1]
    return named | {STATE + name: y[k] for k, name in enumerate(model.state)}


def quadratures(model: Model, of: Iterable[str]) -> tuple[str, ...]:
    """Names of the quadratures that results need: the rotation where it is no state, and terms of the ledger."""
    turns = model.has("turning_rate") and not model.strings
    has = {*model.names("energy_rates"), *(("rotation",) if turns else ())}
    rows = (DEFINITIONS[name] for name in of if name in DEFINITIONS)
    wanted = ["own_work" if row.term == "own_terms" else row.term for row in rows if row.integral]
    return tuple(name for name in wanted if name in has)


# ---- its derivatives


@own_cache(256)
def first_derivatives(function: Function, count: int, adjoint: bool) -> Function:
    """Function (groups, durations, seeds) -> results, shifts, and derivatives of the results.

    Forward, seeds are directions (groups x count), and derivatives are along these (results x count). Adjoint, they
    are weights (results x count), and derivatives are gradients of the weighted sums (groups x count).
    """
    p, durations = (MX.sym(name, function.size1_in(k)) for k, name in enumerate(("groups", "durations")))
    z, shifts = function(p, durations)
    seeds = MX.sym("seeds", (z if adjoint else p).numel(), count)
    with quiet():
        slopes = densify(jtimes(z, p, seeds, adjoint))
        return Function("adjoint" if adjoint else "forward", [p, durations, seeds], [z, shifts, slopes])


def evaluate(function: Function, *arguments: np.ndarray) -> list[np.ndarray]:
    """The results of a function, as arrays; IntegrationFailed where an integrator in it fails."""
    with failures():
        arrays = [np.asarray(result.full()) for result in function.call([DM(argument) for argument in arguments])]
    if not all(np.isfinite(array).all() for array in arrays):
        raise IntegrationFailed("a result is not finite")
    return arrays


def derivatives(
    function: Function, p: np.ndarray, durations: np.ndarray, dp: np.ndarray, method: str, amplified: bool
) -> tuple[np.ndarray, np.ndarray]:
    """The results of a trajectory and their derivatives in the groups, valid along `dp` (groups, n).

    Durations are corrected by the landings until these are short: an integrator with derivatives takes other steps.

    Arguments:
        amplified: the trajectory is known to amplify small errors.

    Raises:
        IntegrationFailed: the integrator failed, or its solution misses an event.
    """
    adjoint = method == "adjoint"
    seeds = np.eye(function.size1_out(0)) if adjoint else spanning(p, dp)
    derivative = first_derivatives(function, seeds.shape[1], adjoint)
    for _ in range(_TRIES):
        z, shifts, slopes = evaluate(derivative, p, durations, seeds)
        shifts = shifts.ravel()
        missed = np.max(np.abs(shifts), initial=0.0)
        limits = np.minimum(_AMPLIFIED if amplified else _LANDED, np.maximum(_LONG / durations, _ROUNDED))
        if np.all(np.abs(shifts) <= limits) or missed > _LOST:
            break
        durations = durations * (1 + shifts)
    if missed > _LANDED:
        raise IntegrationFailed("its solution misses an event of the trajectory")
    return z.ravel(), slopes.T if adjoint else slopes @ inverse(seeds)


def spanning(p: np.ndarray, dp: np.ndarray) -> np.ndarray:
    """Directions in the groups that span `dp`: `dp` itself, or unit directions of the groups if those are fewer.

    A unit direction changes a group by its own value, or by one if that is zero.
    """
    moving = np.flatnonzero(np.any(dp != 0, axis=1))
    moving = moving if moving.size else np.array([0])
    used = np.unique(dp[:, np.any(dp != 0, axis=0)], axis=1)  # speed and Stokes number give the same direction
    if used.shape[1] < moving.size and np.linalg.matrix_rank(used) == used.shape[1]:
        return used
    unit = np.zeros((p.size, moving.size))
    unit[moving, range(moving.size)] = np.where(p[moving] == 0, 1.0, p[moving])
    return unit


def inverse(seeds: np.ndarray) -> np.ndarray:
    """Left inverse of directions, scaled by rows, because groups may differ by many orders of magnitude."""
    rows = np.abs(seeds).max(axis=1, initial=0.0)
    rows[rows == 0] = 1.0
    sized = seeds / rows[:, None]
    columns = np.linalg.norm(sized, axis=0)
    columns[columns == 0] = 1.0
    return np.asarray(np.linalg.pinv(sized / columns) / columns[:, None] / rows)


# ---- of a collision


def slopes(problem: Problem, query: Query, plugin: str) -> Slopes:
    """Derivatives of the results of a collision by its parameters; ComputationError if the engine fails."""
    scene, n = problem.scene, problem.n
    choice = select_model(scene, n.oblique, full="energy.tangential_lubrication" in query.of)
    mapping = parameter_map(problem.kind, problem.wrt, tuple(load(choice).groups))
    numbers, by_theta, units = mapping.at(problem.reference(problem.kind.entries))
    p, scales = np.split(numbers, [-len(SCALES)])
    record, parting = partial(sequence_of, n), problem.path.parting
    try:
        z, dz, dp = differentiated(record, choice, query, plugin, parting, p, by_theta[: p.size])
    except ComputationError as error:
        raise n.in_si(error) from None
    # in SI: a result is its dimensionless value times a scale
    places = [(*SCALES, None).index(DEFINITIONS[name].scale) for name in query.of]
    scale = np.append(scales, 1.0)[places]
    by_scale = np.vstack([by_theta[p.size :], np.zeros(len(units))])[places]
    return z * scale, (dz @ dp * scale[:, None] + z[:, None] * by_scale) / units


def differentiated(
    record: Callable[[float], EventSequence],
    choice: ModelKey,
    query: Query,
    plugin: str,
    parting: float,
    p: np.ndarray,
    dp: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The results of a collision that is replayed, their derivatives in the groups, and the directions that matter.

    Arguments:
        record: as for `replayed`.
        parting: opening speed at separation over v0.
        p, dp: groups, and directions (groups, n) along which derivatives are needed.

    Raises:
        ComputationError: the replay does not agree with the record, or the trajectory cannot be differentiated.
    """
    sharp, near = query.sharpened(parting), query.near
    if plugin == "cvodes":
        if query.amplified and near is not None and near.boundary == SADDLE:
            message = "no derivative by cvodes: its steps do not follow those of a trajectory that lies at the"
            raise ComputationError(f"{message} {near}, nearer than {NEAR:g}", advice="--engine rosenbrock")
        sharp = max(sharp, _SHARPEST_CVODES)
    try:
        path, replay = replayed(record, choice, quadratures(load(choice), query.of), plugin, sharp)
    except Stopped as stopped:
        raise stopped.error(plugin, load(choice)) from None
    check_grip(replay.grip, query.rtol)
    course = course_of(path, replay, choice)
    function = trajectory(course, query.of, plugin, replay.tolerance)
    durations, dp = np.array([piece.duration for piece in replay.pieces]), dp * course.influences(path.groups)[:, None]
    try:
        z, dz = derivatives(function, p, durations, dp, query.method, query.amplified)
    except IntegrationFailed as failure:
        raise ComputationError(
            f"{plugin} could not differentiate the trajectory ({failure})",
            phase=str(path.steps[-1].phase),
            advice="try another --rtol, or the other --engine",
        ) from None
    return z, dz, dp
