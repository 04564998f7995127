"""Derivatives of a trajectory in the parameters at fixed time: dy(t)/dp on a grid, as a Dataset.

A quantity that jumps at an event has no derivative there; just before and just after the event the derivatives differ
by the saltation. `d_event_time` has the derivatives of the events' times.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np
from casadi import MX, SX, Function, densify, horzcat, jtimes, vec, vertcat

from ..engines.casadi.integrators import IntegrationFailed, Tolerance, plain, quiet, tolerance_for
from ..engines.casadi.locate import EventSequence
from ..engines.choice import casadi_gradient_engine
from ..engines.settings import check_plugin, check_rtol
from ..errors import ComputationError, InputError
from ..host.pictures import register
from ..host.thread_caches import own_cache
from ..model.model import select_model
from ..model.phases import Flow, expressions
from ..scene.held import held_quantity
from ..scene.scene import Scene
from .derivatives import evaluate, settled
from .directions import inverse, landed, spanning
from .parameters import SIDEWAYS, check_wrt, parameter_map
from .problem import Problem
from .trajectory_expression import Course, course_of, ending, follow_course, influential, symbols

if TYPE_CHECKING:
    import xarray

POINTS = 64  # points of a phase, denser at its ends
_PART = np.linspace(0, 1, POINTS + 1)
_GRID = tuple(float(part) for part in (_PART**3 * (10 - 15 * _PART + 6 * _PART**2))[1:])
_TIME, _RATE = 1, 2  # indices of the scales
_VARIABLES = {
    "gap": ("m", "gap between the surfaces"),
    "normal_velocity": ("m/s", "normal velocity, negative on approach"),
    "rotation_rate": ("rad/s", "angular velocity of the line of centres"),
    "spin": ("rad/s", "angular velocity of each sphere about its own centre"),
    "rotation": ("rad", "angle turned by the line of centres"),
}
_ODD = ("rotation_rate", "spin", "rotation")  # in a tilt of a head-on collision


def trajectory_sensitivities(
    scene: Scene | str | FilePath,
    wrt: Sequence[str] | str | None = None,
    *,
    stokes: float | str | None = None,
    speed: float | str | None = None,
    angle: float | str | None = None,
    rtol: float = 1e-9,
    engine: str | None = None,
    relative_speed: float | str | None = None,
    hold: str | None = None,
) -> xarray.Dataset:
    """The trajectory over time and its derivatives in the parameters, at fixed time, with the jumps at the events.

    Arguments:
        scene, stokes, speed, angle, rtol, engine, relative_speed, hold: as for `sensitivities`.
        wrt: parameters by dotted name; None: all.

    Returns:
        Dataset over `time` (s; 65 points a phase, an event's time twice: before and after it) and `parameter`:
        gap, normal_velocity, rotation_rate, spin, rotation (SI), each with a `d_NAME` of the same unit per the
        parameter's (`time`, `parameter`), and `event_time`, `d_event_time` over `event`.

    Raises:
        InputError: a name or option is not acceptable.
        ComputationError: as for `sensitivities`. For a stick, the trajectory ends where the outcome is decided.

    Example:
        >>> from wetdoublet.solvers import trajectory_sensitivities
        >>> found = trajectory_sensitivities("granulation", ["liquid.viscosity"], stokes=0.02, angle="75 deg")
        >>> found.d_gap.dims
        ('time', 'parameter')
    """
    import xarray as xr

    register()
    rtol, plugin = check_rtol(rtol), casadi_gradient_engine(check_plugin(engine))
    loaded = Scene.load(scene).with_impact(stokes, speed, angle, relative_speed)
    hold = held_quantity(loaded, hold)
    names = check_wrt(loaded, wrt)
    problem = Problem.of(loaded, *loaded.need_impact(), names, hold)
    path, _ = problem.located(rtol)
    sideways, reference = np.isin(names, SIDEWAYS), [problem.value_of(name) for name in names]
    if tilts := not problem.n.oblique and bool(sideways.any()):
        if not path.separated:
            moving = ", ".join(name for name in names if name in SIDEWAYS)
            raise InputError("wrt", moving, f"parameters other than {moving}", "moves a head-on stick out of its line")
        problem, path = problem.tilted()
    pieces, events = _pieces(problem, path, plugin, rtol)
    if not pieces:
        raise ComputationError("no trajectory: the outcome is decided at initial contact", advice="try another impact")
    units = problem.units()
    data: dict[str, Any] = {}
    for k, (name, (unit, what)) in enumerate(_VARIABLES.items()):
        value = np.concatenate([piece[1][k] for piece in pieces])
        slope = np.concatenate([piece[2][k] for piece in pieces]) / units
        if tilts:  # by symmetry: odd in the tilt, or even
            value = value * (name not in _ODD)
            slope[:, sideways != (name in _ODD)] = 0.0
        data[name] = ("time", value, {"units": unit, "long_name": what})
        data[f"d_{name}"] = (("time", "parameter"), slope, {"long_name": f"derivative of the {what}, at fixed time"})
    data["event_time"] = ("event", np.array([time for _, time, _ in events]), {"units": "s"})
    moves = np.array([move for *_, move in events]).reshape(len(events), len(names)) / units
    moves[:, sideways & tilts] = 0.0
    data["d_event_time"] = (("event", "parameter"), moves)
    coordinates = {
        "time": ("time", np.concatenate([piece[0] for piece in pieces]), {"units": "s"}),
        "phase": ("time", np.concatenate([np.full(piece[0].size, piece[3]) for piece in pieces])),
        "parameter": list(names),
        "reference": ("parameter", reference, {"long_name": "its own value, SI"}),
        "event": [name for name, *_ in events],
    }
    return xr.Dataset(data, coordinates, {"outcome": path.outcome, "engine": plugin, "hold": hold, "rtol": rtol})


Piece = tuple[np.ndarray, np.ndarray, np.ndarray, str]
"""Times (n,), the five variables (5, n), their derivatives in theta (5, n, parameters), the phase's name."""


def _pieces(
    problem: Problem, path: EventSequence, plugin: str, rtol: float
) -> tuple[list[Piece], list[tuple[str, float, np.ndarray]]]:
    """The phases one by one, and the events with their times and time derivatives."""
    tolerance = tolerance_for(rtol, plugin, problem.n.groups)
    whole = course_of(path, select_model(problem.scene, path.model.oblique, full=True))
    groups = tuple(whole.model.groups)
    via = parameter_map(problem.kind, problem.wrt, groups)
    p, scales = np.split(via.values(problem.reference).full().ravel(), [len(groups)])
    slopes = np.asarray(via.slopes(problem.reference)[0].full())
    active = influential(whole, problem.n.groups)
    dp, ds = slopes[: p.size] * np.array(active)[:, None], slopes[p.size :]
    seeds = spanning(p, dp, active)
    if not seeds.shape[1]:
        seeds = np.zeros((p.size, 1))
    back = inverse(seeds) @ dp
    durations = np.array([step.duration for step in path.steps])
    pieces: list[Piece] = []
    events: list[tuple[str, float, np.ndarray]] = []
    before, d_before = 0.0, np.zeros(dp.shape[1])
    try:
        durations = settled(ending(whole, plugin, tolerance), p, durations, landed(whole), 1e-9)
        for k, step in enumerate(path.steps):
            if step.duration > 0:
                part = replace(whole, legs=whole.legs[: k + 1])
                leg = _leg(part, seeds.shape[1], plugin, tolerance)
                y, rates, tangents, clock, d_clock = evaluate(leg, p, durations[: k + 1], seeds)
                time = before + durations[k] * np.array([0.0, *_GRID])
                # converted to a fixed time in seconds, from a fixed time in x0/v0 since the last event
                delay = d_before + time[:, None] * ds[_TIME] / scales[_TIME]
                moved = (tangents @ back).reshape(5, time.size, -1) - rates[:, :, None] * delay
                units = _units(scales, ds)
                value = y * units[0][:, None]
                slope = moved * units[0][:, None, None] + y[:, :, None] * units[1][:, None, :]
                pieces.append((time * scales[_TIME], value, slope, str(step.phase)))
                before, d_before = float(clock.item()), (d_clock @ back).ravel()
            happens = before * ds[_TIME] + d_before * scales[_TIME]
            events += [(kind, before * scales[_TIME], happens) for kind in step.kinds]
    except IntegrationFailed as failure:
        raise ComputationError(f"{plugin} could not differentiate the trajectory ({failure})") from None
    return pieces, events


def _units(scales: np.ndarray, ds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """SI scales of the five variables, and their derivatives in theta: length, speed, rate, rate, none."""
    length, time, rate, _ = scales
    speed = length / time
    d_speed = speed * (ds[0] / length - ds[_TIME] / time)
    none = np.zeros(ds.shape[1])
    return np.array([length, speed, rate, rate, 1.0]), np.array([ds[0], d_speed, ds[_RATE], ds[_RATE], none])


@own_cache(64)
def _leg(course: Course, count: int, plugin: str, tolerance: Tolerance) -> Function:
    """Function (groups, durations, directions) -> values over a course's last leg, and their derivatives.

    Outputs: the five variables, their rates, the variables' derivatives along the directions (at a fixed time since the
    leg began), the time of its end, and that time's derivatives.
    """
    model = course.model
    extras = ("rotation",) if model.has("turning_rate") and not model.strings else ()
    p, durations = symbols(course)
    seeds = MX.sym("seeds", p.numel(), count)
    last = course.legs[-1]
    start = follow_course(replace(course, legs=course.legs[:-1]), p, durations[:-1], extras, plugin, tolerance).y
    end = follow_course(course, p, durations, extras, plugin, tolerance)
    flow = Flow(course.choice, last.phase.region, extras)
    with quiet():
        engine = plain(flow, plugin, tolerance, _GRID).function
        inside = engine(x0=start, p=vertcat(p, durations[-1]))["xf"]
        shown = _shown(flow, tolerance.offset)
        columns = [start, *(inside[:, k] for k in range(POINTS))]
        y, rates = (horzcat(*each) for each in zip(*(shown(column, p) for column in columns)))
        # rows of `vec(y.T)`, ordered by variable
        tangents = densify(jtimes(vec(y.T), p, seeds))
        return Function(
            "leg", [p, durations, seeds], [y, rates, tangents, end.time, densify(jtimes(end.time, p, seeds))]
        )


@own_cache(64)
def _shown(flow: Flow, offset: float) -> Function:
    """Function (state with extras, groups) -> gap, normal velocity, rotation rate, spin, rotation; and their rates."""
    model, parts = flow.model, expressions(flow)
    outputs: dict[str, Any] = model("outputs") if model.oblique else {}
    turned = parts.extras["rotation"] - offset if "rotation" in parts.extras else model.state.get("rotation", SX(0))
    column = vertcat(
        model.state["gap"],
        model.state["normal_velocity"],
        outputs.get("final_rotation_rate", SX(0)),
        outputs.get("final_spin", SX(0)),
        turned,
    )
    rates = jtimes(column, parts.variables, parts.rates)
    return Function("shown", [parts.variables, model.parameters], [densify(column), densify(rates)])
