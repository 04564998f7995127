"""A trajectory as an xarray Dataset: gap, velocities, rates and angle against time, with units."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version

import numpy as np
import xarray as xr

from ...errors import ComputationError
from ...model.dimensionless import Problem
from ...model.model import Model
from .integrators import IntegrationFailed, plain
from .replay import Piece, Replay

# Per phase, denser towards its ends, where the fast transients are; the integrator's steps do not depend on them.
_POINTS = 64
_PART = np.linspace(0, 1, _POINTS + 1)
_GRID = _PART**3 * (10 - 15 * _PART + 6 * _PART**2)

_VARIABLES: dict[str, tuple[str, str]] = {
    "gap": ("m", "gap between the surfaces"),
    "normal_velocity": ("m/s", "normal velocity, negative on approach"),
    "rotation_rate": ("rad/s", "angular velocity of the line of centres"),
    "spin": ("rad/s", "angular velocity of each sphere (of a pair: the first) about its own centre"),
    "spin_partner": ("rad/s", "angular velocity of the partner about its own centre"),
    "sliding_velocity": ("m/s", "tangential velocity of the sphere's centre and the wall past each other"),
    "rotation": ("rad", "angle turned by the line of centres"),
}


Sample = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray | None]]
"""Parts of a phase's duration, 0 to 1 -> states as columns, and the angle turned where it is known (rad)."""


@dataclass(frozen=True)
class Stretch:
    """An integrated phase: its name, start and duration (x0/v0), and its states."""

    name: str
    time: float
    duration: float
    sample: Sample


def stretch(piece: Piece, model: Model, replayed: Replay, p: np.ndarray, plugin: str) -> Stretch:
    """A phase of a replay, integrated again through the requested times; ComputationError if that fails."""
    size, turned = len(model.state), tuple(name for name in replayed.extras if name == "rotation")
    names, tolerance = (*model.state, *turned), replayed.tolerance
    offset = tolerance.offset if turned else 0.0
    shown = [*range(size), *(size + replayed.extras.index(name) for name in turned)]

    def sample(parts: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
        try:
            inside = integrated(parts)
        except IntegrationFailed as failure:
            state = dict(zip(model.state, piece.start.tolist(), strict=False))
            message, advice = f"the trajectory by {plugin} gave up ({failure})", "try the other --engine"
            raise ComputationError(message, str(piece.phase), piece.time, state, advice) from None
        y = np.column_stack([piece.start[shown], inside])
        return y[:size], y[names.index("rotation")] - offset if "rotation" in names else None

    def integrated(parts: np.ndarray) -> np.ndarray:
        grid = tuple(parts[1:])
        try:
            return plain(piece.flow, plugin, tolerance, grid)(piece.start, p, piece.duration)[shown]
        except IntegrationFailed:  # possibly due to the ledger, which is not needed here
            flow = replace(piece.flow, extras=turned)
            return plain(flow, plugin, tolerance, grid)(piece.start[shown], p, piece.duration)

    return Stretch(str(piece.phase), piece.time, piece.duration, sample)


def dataset(
    stretches: Sequence[Stretch], model: Model, n: Problem, first: np.ndarray, outcome: str, engine: str, rtol: float
) -> xr.Dataset:
    """A trajectory on a grid of _POINTS per phase; the time of an event occurs twice, before and after it.

    Arguments:
        first: the state at initial contact, used alone if the collision is decided there.
        outcome, engine, rtol: for the attributes, which suffice to compute it again.
    """
    p, size = model.group_values(n.groups), len(model.state)
    times: list[np.ndarray] = []
    columns: list[np.ndarray] = []
    angles: list[np.ndarray] = []
    phases: list[str] = []
    for phase in stretches:
        states, angle = phase.sample(_GRID)
        times.append(phase.time + phase.duration * _GRID)
        columns.append(states)
        angles.append(np.zeros(_GRID.size) if angle is None else angle)
        phases += [phase.name] * _GRID.size
    if not columns:  # decided at initial contact
        times, columns, phases = [np.zeros(1)], [first[:size, None]], ["initial contact"]
        angles = [np.zeros(1)]
    y, time = np.hstack(columns), np.concatenate(times) * n.time
    zero = np.zeros(time.size)
    values = {"gap": y[0] * n.length, "normal_velocity": y[1] * n.speed}
    if model.oblique:
        outputs = dict(zip(model.names("outputs"), np.asarray(model.function("outputs")(y, p).full()), strict=True))
        values |= {
            "rotation_rate": outputs["final_rotation_rate"] * n.rate,
            "spin": outputs["final_spin"] * n.rate,
            "rotation": np.concatenate(angles),
        }
        if "final_spin_partner" in outputs:
            values["spin_partner"] = outputs["final_spin_partner"] * n.rate
        if model.wall:
            slip = np.asarray(model.function("surface_slip")(y, p).full())[0]  # of sliding over rolling
            values["sliding_velocity"] = (slip + outputs["final_spin"]) * n.speed * n.groups["obliquity"]
    else:
        values |= {"rotation_rate": zero, "spin": zero, "rotation": zero}
    variables = {
        name: ("time", value, {"units": _VARIABLES[name][0], "long_name": _VARIABLES[name][1]})
        for name, value in values.items()
    }
    coordinates = {
        "time": ("time", time, {"units": "s", "long_name": "time since initial contact"}),
        "phase": ("time", np.array(phases)),
    }
    release = version("wetdoublet")
    return xr.Dataset(variables, coordinates, {
        "title": f"Trajectory of an oblique wet collision: {n.scene.name or 'unnamed scene'}",
        "source": f"wetdoublet {release}", "scene": n.scene.to_toml(), "outcome": outcome, "engine": engine,
        "rtol": rtol, "version": release,
    })  # fmt: skip
