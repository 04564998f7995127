"""`gradients_many()`: derivatives of many collisions of one scene, by the Taylor kernel, or one after another."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import LAST_ANSWER, OUTCOMES, Status
from ...generated.automaton import STICK as STICKS
from ..engines.choice import gradient_engine
from ..engines.taylor.call import Impacts
from ..engines.taylor.orders import order_backward, order_for
from ..engines.taylor.tangent import DISTANCES, Carried, run_tangent
from ..errors import WetDoubletError
from ..formatting.labelled import Column, labelled
from ..host.cores import usable_cores
from ..host.pictures import register
from ..many.batch import validated_batch
from ..many.results import FAILED, outcome_attributes
from ..model.validity import warn
from ..scene.groups import sideways
from ..scene.held import held_quantity
from ..scene.scene import Scene
from ..scene.schema import SPEEDS
from ..settings import KERNEL_STEPS, RTOL, check_engine
from . import by_kernel as kernel
from .boundary_distance import LOOK, limit, refused
from .parameters import RELATIVE, SIDEWAYS, Kind, check_wrt, kind_of, references
from .problem import NEAR, SHARPEST
from .result import Near
from .results import DIFFERENTIATED, check_quantities
from .sensitivities import sensitivities

if TYPE_CHECKING:
    import xarray

_SOON = 1000  # steps within which most separating collisions end
_LONG = 10 * KERNEL_STEPS  # steps for creeping collisions (runtime/implicit.h)
_STRETCH = 4096  # collisions in a block for a thread
STICK = "a stick: its restitution is 0, and nothing else of it is defined"


@dataclass
class _Asked:
    """The request, and the results so far; NaN where not computed."""

    scene: Scene
    speed: np.ndarray
    angle: np.ndarray
    kind: Kind
    wrt: tuple[str, ...]
    of: tuple[str, ...]
    rtol: float
    outcome: np.ndarray = field(init=False)
    value: np.ndarray = field(init=False)
    gradient: np.ndarray = field(init=False)
    reason: np.ndarray = field(init=False)
    engine: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        size = self.angle.size
        self.outcome = np.full(size, FAILED, dtype=np.int8)
        self.value = np.full((len(self.of), size), np.nan)
        self.gradient = np.full((len(self.of), size, len(self.wrt)), np.nan)
        self.reason = np.full(size, "", dtype=object)
        self.engine = np.full(size, "", dtype=object)

    @property
    def relative_speed(self) -> np.ndarray:
        """Magnitudes of the relative velocities, m/s."""
        return np.asarray(self.speed / np.cos(self.angle))

    def impacts(self, which: np.ndarray, stretch: float = 1.0) -> Impacts:
        return Impacts(self.scene, self.speed[which] * stretch, self.angle[which], {})

    def per_unit(self, slopes: np.ndarray, which: np.ndarray, units: np.ndarray) -> np.ndarray:
        """Derivatives by the parameters, from those in theta: (results, collisions, parameters).

        Arguments:
            units: dp/dtheta at the reference of `by_kernel`.
        """
        found: np.ndarray = slopes / units
        for k, name in enumerate(self.wrt):
            if name == RELATIVE:
                found[:, :, k] = slopes[:, :, k] / self.relative_speed[which]
            elif name in SPEEDS:
                found[:, :, k] *= kernel.SPEED / self.speed[which]
            elif name == "impact.angle" and self.angle[which[0]] > 0:
                found[:, :, k] = slopes[:, :, k] / self.angle[which]
        return found

    def reference(self) -> np.ndarray:
        """Values of the parameters, (collisions, parameters)."""
        first = dict(zip(self.kind.entries, references(self.scene, self.kind, 1.0, 0.0).tolist(), strict=True))
        columns = {"impact.speed": self.speed, "impact.angle": self.angle, RELATIVE: self.relative_speed}
        columns["impact.stokes"] = self.speed * self.scene.stokes_per_speed
        return np.column_stack([columns.get(name, np.full(self.speed.size, first.get(name, 0.0))) for name in self.wrt])


def gradients_many(
    scene: Scene | str | FilePath,
    *,
    stokes: Any = None,
    speed: Any = None,
    angle: Any = None,
    wrt: Sequence[str] | str | None = None,
    of: Sequence[str] | str = ("restitution",),
    relative_speed: Any = None,
    rtol: float = RTOL,
    hold: str | None = None,
    engine: str | None = None,
) -> xarray.Dataset:
    """Derivatives of many collisions of one scene, through their events.

    Arguments:
        scene: a Scene, a path or a preset's name.
        stokes, speed, relative_speed: as for `collide_many`; default the scene's.
        angle: impact angles in rad, 1-D or a single number; default the scene's.
        wrt: parameters by dotted name; None for every numeric entry of the scene, and speed, Stokes number and angle.
        of: results by name, as for `sensitivities`.
        rtol: relative tolerance, 1e-13..1e-3.
        hold: quantity held when another parameter varies, as for `sensitivities`.
        engine: "taylor" (default), or "rosenbrock" (also where the kernel lacks a result, or
            there is no C compiler) or "cvodes", which take them one after another.

    Returns:
        Dataset: value (quantity, collision); gradient and elasticity (quantity, collision, parameter), SI; outcome and
        reason (collision). A stick has restitution 0 with gradient 0, and NaN for undefined results. Where no
        derivative exists (see `sensitivities`) there is NaN, and `reason` names the boundary.

    Raises:
        InputError: an invalid name, length or value.

    Example:
        >>> import numpy as np
        >>> found = gradients_many("granulation", stokes=np.array([0.02, 0.03]), angle=1.3, wrt="liquid.viscosity")
        >>> found.gradient.sel(quantity="restitution", parameter="liquid.viscosity").shape
        (2,)
    """
    names, by = check_quantities(of), check_engine(engine)
    request = validated_batch(
        scene, {"stokes": stokes, "speed": speed, "relative_speed": relative_speed, "angle": angle}, {}, rtol,
        "rosenbrock", (),
    )  # fmt: skip
    loaded = request.scene
    held = held_quantity(loaded, hold) if relative_speed is None or hold is not None else "relative_speed"
    warn(loaded)
    velocity = request.speed if request.speed is not None else np.asarray(request.stokes) / loaded.stokes_per_speed
    asked = _Asked(
        loaded, np.asarray(velocity), request.angle, kind_of(loaded, held), check_wrt(loaded, wrt), names, request.rtol
    )
    left = np.arange(request.size)
    oblique = set(sideways(loaded, request.angle, {}).tolist())
    if by is None:
        by = gradient_engine(loaded, names, kernel.KNOWN, oblique)
    if by == "taylor" and kernel.offers(loaded, names, oblique):
        left = _by_kernel(asked)
    for k in left:
        _alone(asked, int(k), held, by)
    return _dataset(asked, held)


def _by_kernel(asked: _Asked) -> np.ndarray:
    """Compute collisions by the kernel; returns the indices of those left to CasADi."""
    moves = sideways(asked.scene, asked.angle, {})
    turns = any(DIFFERENTIATED[name].odd for name in asked.of) and bool({*asked.wrt} & {*SIDEWAYS})
    parts, left = [], [np.flatnonzero(~moves) if turns else np.zeros(0, int)]
    for which in (np.flatnonzero(asked.angle > 0), np.flatnonzero((asked.angle == 0) & (moves | (not turns)))):
        parts += [which[k : k + _STRETCH] for k in range(0, which.size, _STRETCH)]
    if len(parts) > 1:
        with ThreadPoolExecutor(usable_cores()) as pool:  # the kernel releases the interpreter's lock
            left += pool.map(lambda part: _stretch(asked, part), parts)
    else:
        left += [_stretch(asked, part) for part in parts]
    return np.sort(np.concatenate(left))


def _stretch(asked: _Asked, which: np.ndarray) -> np.ndarray:
    # for few parameters forward tangents cost no more
    back = asked.of == kernel.BACKWARD and len(asked.wrt) > kernel.DIRECTIONS

    def run_part(part: np.ndarray, rtol: float, budget: int, backward: bool) -> kernel.Along | None:
        order = (order_backward if backward else order_for)(asked.rtol)
        return kernel.gradients_by_kernel(
            asked.impacts(part), asked.kind, asked.wrt, asked.of, rtol, order, budget, backward
        )

    found = run_part(which, asked.rtol, _SOON, back)
    if found is None:
        return which
    answers, measures = found.run.answers, found.run.near
    late = np.flatnonzero(answers["status"] > LAST_ANSWER)
    if back and late.size:  # forward tangents of long trajectories, as these also limit the step
        held = run_part(which[late], asked.rtol, _SOON, False)
        if held is None:
            return which
        answers[late], measures[late] = held.run.answers, held.run.near
        found.value[:, late], found.first[:, late] = held.value, held.first
    near, least = measures[:, 0], limit(asked.rtol)
    far = (answers["outcome"] > 0) & (near >= NEAR)
    _keep(asked, which, found, far)
    # long creeping collisions mostly stick, so they are first computed without derivatives
    slow = np.flatnonzero(answers["status"] > LAST_ANSWER)
    if slow.size:
        plain = _without(asked, which[slow], asked.rtol)
        answers[slow], measures[slow] = plain.answers, plain.near
    # nearer than NEAR to a boundary errors are amplified, so these are repeated with tolerances smaller by decades
    told = np.isin(measures[:, 1], tuple(DISTANCES)) & (measures[:, 2] > LOOK * least)  # no distance to compute
    close = (answers["outcome"] > 0) & ~far & ((near > LOOK * least) | (told & (near >= least)))
    decades = np.maximum(np.ceil(np.log10(NEAR / np.where(close, near, NEAR))), 0.0)
    for decade in np.unique(decades[close]):
        part = which[close & (decades == decade)]
        sharper = min(asked.rtol, max(asked.rtol * 10.0**-decade, SHARPEST))
        for backward in (True, False) if back else (False,):
            again = run_part(part, sharper, _LONG, backward)
            if again is not None:
                _keep(asked, part, again, again.run.answers["outcome"] > 0)
                part = part[again.run.answers["status"] > LAST_ANSWER]
            if not part.size:
                break
    stuck = which[_sticks(asked, which, answers, found.run.by_energy)]
    asked.outcome[stuck], asked.reason[stuck], asked.engine[stuck] = 0, STICK, "taylor"
    if "restitution" in asked.of:
        place = asked.of.index("restitution")
        asked.value[place, stuck], asked.gradient[place, stuck] = 0.0, 0.0
    for k in np.flatnonzero((answers["outcome"] > 0) & told & (near < least)):
        asked.reason[which[k]] = str(refused(Near(*_boundary(measures[k])), least))
    return np.asarray(which[(asked.outcome[which] == FAILED) & (asked.reason[which] == "")])


def _boundary(measures: np.ndarray) -> tuple[str, float, str]:
    name, of = DISTANCES[int(measures[1])]
    return name, float(measures[0]), of


def _without(asked: _Asked, which: np.ndarray, rtol: float, factor: float = 1.0) -> Carried:
    """The collisions without derivatives, by the same kernel."""
    oblique = bool(asked.angle[which[0]] > 0)
    found = run_tangent(asked.impacts(which, factor), oblique, rtol, "rotation" in asked.of, (), order_for(asked.rtol))
    assert found is not None  # the kernel is available
    return found


def _keep(asked: _Asked, which: np.ndarray, found: kernel.Along, part: np.ndarray) -> None:
    into = which[part]
    if into.size:
        asked.outcome[into] = found.run.answers["outcome"][part]
        asked.value[:, into] = found.value[:, part]
        slopes = asked.per_unit(found.first[:, part], into, found.units)
        slopes[np.isnan(found.value[:, part])] = np.nan
        asked.gradient[:, into] = slopes
        asked.engine[into] = "taylor"


def _sticks(asked: _Asked, which: np.ndarray, answers: np.ndarray, by_energy: bool) -> np.ndarray:
    """Mask of sticks without a boundary nearby, tested as in `boundary_distance`."""
    stuck = (answers["outcome"] == OUTCOMES.index(STICKS)) & (answers["status"] <= LAST_ANSWER)
    sure = stuck & (answers["status"] == Status.PROVED_AT_TOUCH) & by_energy
    look = np.flatnonzero(stuck & ~sure)
    least = limit(asked.rtol)
    for factor in (1 - least, 1 + least):
        if look.size:
            aside = _without(asked, which[look], min(asked.rtol, 1e-10), factor).answers
            stays = (aside["outcome"] == OUTCOMES.index(STICKS)) & (aside["status"] <= LAST_ANSWER)
            stuck[look[~stays]] = False
            look = look[stays]
    return np.asarray(stuck)


def _alone(asked: _Asked, k: int, hold: str, engine: str) -> None:
    speed, angle = float(asked.speed[k]), float(asked.angle[k])
    method = "adjoint" if engine != "taylor" and len(asked.of) < len(asked.wrt) else "forward"
    try:
        found = sensitivities(
            asked.scene, asked.of, asked.wrt, speed=speed, angle=angle, method=method, rtol=asked.rtol, engine=engine,
            hold=hold,
        )  # fmt: skip
    except WetDoubletError as error:
        asked.reason[k] = str(error)
        return
    asked.outcome[k] = OUTCOMES.index(found.outcome)
    asked.reason[k] = STICK if found.outcome == "stick" else ""
    asked.engine[k] = found.engine
    for place, name in enumerate(asked.of):
        value, row = found.value[name], found.gradient[name]
        asked.value[place, k] = np.nan if value is None else value
        asked.gradient[place, k] = [np.nan if slope is None else slope for slope in row.values()]


def _dataset(asked: _Asked, hold: str) -> xarray.Dataset:
    register()
    reference = asked.reference()
    with np.errstate(divide="ignore", invalid="ignore"):
        elasticity = asked.gradient * reference / asked.value[:, :, None]
    elasticity[~np.isfinite(elasticity) | (reference == 0)] = np.nan
    along, over = ("collision",), ("quantity", "collision", "parameter")
    stokes = asked.speed * asked.scene.stokes_per_speed
    variables: dict[str, Column] = {
        "value": (("quantity", "collision"), asked.value, {"long_name": "results, SI"}),
        "gradient": (over, asked.gradient, {"long_name": "derivatives by the parameters, SI"}),
        "elasticity": (over, elasticity, {"units": "1", "long_name": "d ln y/d ln p"}),
        "outcome": (along, asked.outcome, outcome_attributes()),
        "reason": (along, asked.reason.astype(str), {"long_name": "why there is no derivative"}),
        "engine": (along, asked.engine.astype(str), {"long_name": "what computed it"}),
    }
    coordinates: dict[str, Column] = {
        "units": (("quantity",), np.array([DIFFERENTIATED[name].unit for name in asked.of]), {}),
        "reference": (("collision", "parameter"), reference, {}),
        "speed": (along, asked.speed, {"units": "m/s", "long_name": "normal approach speed"}),
        "stokes": (along, stokes, {"units": "1", "long_name": "Stokes number"}),
        "angle": (along, asked.angle, {"units": "rad", "long_name": "impact angle"}),
    }
    attributes = {"scene": asked.scene.to_toml(), "rtol": asked.rtol, "hold": hold}
    return labelled(variables, coordinates, attributes, {"quantity": asked.of, "parameter": asked.wrt})
