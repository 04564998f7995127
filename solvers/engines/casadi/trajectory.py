"""A trajectory as an xarray Dataset: gap, velocities, rates and angle against time, with units."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from ...errors import ComputationError
from ...model.dimensionless import Problem
from ...model.model import Model
from ...model.phases import extra_units
from ...scene.origin import provenance, release
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
    "kinetic": ("J", "kinetic energy"),
    "strings": ("J", "potential energy of the strings"),
    "normal_lubrication": ("J", "energy taken so far by the film along the line of centres"),
    "tangential_lubrication": ("J", "energy taken so far by the shear"),
    "capillary": ("J", "work so far against the bridge"),
    "attraction": ("J", "work so far against van der Waals forces"),
    "own_terms": ("J", "gain so far of declared energies, and work against declared forces"),
}
TAKEN = ("normal_lubrication", "tangential_lubrication", "capillary", "attraction", "own_work")
"""Terms of the ledger that are integrated along with the motion."""


Sample = Callable[[np.ndarray], tuple[np.ndarray, Mapping[str, np.ndarray]]]
"""Parts of a phase's duration, 0 to 1 -> states as columns, and integrals: `rotation` (rad), `TAKEN` (m v0^2)."""


@dataclass(frozen=True)
class Stretch:
    """An integrated phase: its name, start and duration (x0/v0), and its states."""

    name: str
    time: float
    duration: float
    sample: Sample


def stretch(piece: Piece, model: Model, replayed: Replay, p: np.ndarray, plugin: str) -> Stretch:
    """A phase of a replay, integrated again through the requested times; ComputationError if that fails."""
    size, names, tolerance = len(model.state), replayed.extras, replayed.tolerance
    turned = tuple(name for name in names if name == "rotation")

    def sample(parts: np.ndarray) -> tuple[np.ndarray, Mapping[str, np.ndarray]]:
        try:
            return integrated(parts, names)
        except IntegrationFailed:  # possibly due to the ledger
            try:
                return integrated(parts, turned)
            except IntegrationFailed as failure:
                state = dict(zip(model.state, piece.start.tolist(), strict=False))
                message, advice = f"the trajectory by {plugin} gave up ({failure})", "try the other --engine"
                raise ComputationError(message, str(piece.phase), piece.time, state, advice) from None

    def integrated(parts: np.ndarray, extras: tuple[str, ...]) -> tuple[np.ndarray, Mapping[str, np.ndarray]]:
        start = piece.start[[*range(size), *(size + names.index(name) for name in extras)]]
        flow = replace(piece.flow, extras=extras)
        y = np.column_stack([start, plain(flow, plugin, tolerance, tuple(parts[1:]))(start, p, piece.duration)])
        states, units = dict(zip(model.state, y, strict=False)), extra_units(model, extras, p)
        along = {name: unit * (row - tolerance.offset) for name, unit, row in zip(extras, units, y[size:], strict=True)}
        return y[:size], {**along, **({"rotation": states["rotation"]} if "rotation" in states else {})}

    return Stretch(str(piece.phase), piece.time, piece.duration, sample)


def dataset(
    stretches: Sequence[Stretch], model: Model, n: Problem, first: np.ndarray, outcome: str, engine: str, rtol: float
) -> xr.Dataset:
    """A trajectory on a grid of _POINTS per phase; the time of an event occurs twice, before and after it.

    Terms of the ledger are in it if they were integrated along with every phase.

    Arguments:
        first: the state at initial contact, used alone if the collision is decided there.
        outcome, engine, rtol: for the attributes, which suffice to compute it again.
    """
    p, size = model.group_values(n.groups), len(model.state)
    times: list[np.ndarray] = []
    columns: list[np.ndarray] = []
    integrals: list[Mapping[str, np.ndarray]] = []
    phases: list[str] = []
    for phase in stretches:
        states, along = phase.sample(_GRID)
        times.append(phase.time + phase.duration * _GRID)
        columns.append(states)
        integrals.append({"rotation": np.zeros(_GRID.size), **along})
        phases += [phase.name] * _GRID.size
    if not columns:  # decided at initial contact
        times, columns, phases = [np.zeros(1)], [first[:size, None]], ["initial contact"]
        integrals = [{"rotation": np.zeros(1)}]
    y, time = np.hstack(columns), np.concatenate(times) * n.time
    along = {
        name: np.concatenate([integral[name] for integral in integrals])
        for name in ("rotation", *TAKEN)
        if all(name in integral for integral in integrals)
    }
    zero = np.zeros(time.size)
    values = {"gap": y[0] * n.length, "normal_velocity": y[1] * n.speed}
    if model.oblique:
        outputs = dict(zip(model.names("outputs"), np.asarray(model.function("outputs")(y, p).full()), strict=True))
        values |= {
            "rotation_rate": outputs["final_rotation_rate"] * n.rate,
            "spin": outputs["final_spin"] * n.rate,
            "rotation": along["rotation"],
        }
        if "final_spin_partner" in outputs:
            values["spin_partner"] = outputs["final_spin_partner"] * n.rate
        if model.wall:
            slip = np.asarray(model.function("surface_slip")(y, p).full())[0]  # of sliding over rolling
            values["sliding_velocity"] = (slip + outputs["final_spin"]) * n.speed * n.groups["obliquity"]
    else:
        values |= {"rotation_rate": zero, "spin": zero, "rotation": zero}
    stored = zip(model.names("energies"), np.asarray(model.function("energies")(y, p).full()), strict=True)
    energies = dict(stored) | {name: value for name, value in along.items() if name != "rotation"}
    if model.own_terms:
        gained = energies.pop("own_energy", zero)
        energies["own_terms"] = gained - gained[0] + energies.pop("own_work", zero)
    values |= {name: value * n.energy for name, value in energies.items()}
    variables = {
        name: ("time", value, {"units": _VARIABLES[name][0], "long_name": _VARIABLES[name][1]})
        for name, value in values.items()
    }
    coordinates = {
        "time": ("time", time, {"units": "s", "long_name": "time since initial contact"}),
        "phase": ("time", np.array(phases)),
    }
    return xr.Dataset(variables, coordinates, {
        "title": f"Trajectory of an oblique wet collision: {n.scene.name or 'unnamed scene'}",
        "source": f"wetdoublet {release()}", **provenance(n.scene), "outcome": outcome, "engine": engine,
        "rtol": rtol,
    })  # fmt: skip
