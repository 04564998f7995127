"""`gradients_many()`: derivatives of many collisions of one scene, by the Taylor kernel, or one after another."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import LAST_ANSWER, OUTCOMES
from ...generated.automaton import STICK as STICKS
from ..engines.settings import KERNEL_STEPS, RTOL, check_engine, check_rtol
from ..engines.taylor.call import KernelImpacts
from ..engines.taylor.orders import order_backward, order_for
from ..engines.taylor.tangent import CHATTERS, DISTANCES, Carried, run_tangent
from ..errors import WetDoubletError
from ..formatting.labelled import Column, labelled
from ..host.pictures import register
from ..host.workers import usable_cores
from ..many import impacts as many
from ..many.arguments import checked_columns, of_one_length
from ..model.validity import warn
from ..results import DEFINITIONS, FAILED, attributes, check_differentiated, outcome_attributes
from ..scene.held import held_quantity
from ..scene.origin import provenance
from ..scene.scene import Scene
from . import by_kernel as kernel
from .boundary_distance import Near, limit, refused
from .parameters import SIDEWAYS, check_wrt, elasticities, kind_of, references
from .problem import NEAR, SHARPEST, Problem
from .sensitivities import derivatives

if TYPE_CHECKING:
    import xarray

COMPUTED = 30.0  # multiple of the limit: below it a measure that is no distance calls for one
_SOON = 1000  # steps within which most separating collisions end
_LONG = 2 * KERNEL_STEPS  # steps for creeping collisions (runtime/implicit.h)
_HINTED = 2  # decades by which the tolerance is smaller where the distance to a boundary is only known to be allowed
_STRETCH = 4096  # collisions in a block for a thread
STICK = "a stick: its restitution is 0, and nothing else of it is defined"


@dataclass(frozen=True, kw_only=True)
class _Gradients(KernelImpacts):
    """Impacts, what of them is requested, and the results so far, which are filled in; NaN where not computed."""

    hold: str
    wrt: tuple[str, ...]
    of: tuple[str, ...]
    rtol: float
    outcome: np.ndarray
    value: np.ndarray
    gradient: np.ndarray
    reason: np.ndarray
    engine: np.ndarray

    def fill(self, which: Any, outcome: Any, engine: str, reason: Any, value: Any, gradient: Any) -> None:
        """Fill in the results of collisions `which`."""
        self.outcome[which], self.engine[which], self.reason[which] = outcome, engine, reason
        self.value[:, which], self.gradient[:, which] = value, gradient


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
        engine: "taylor" (default), or "rosenbrock" (also where the kernel lacks a result) or
            "cvodes", which take them one after another.

    Returns:
        Dataset: value (quantity, collision); gradient and elasticity (quantity, collision, parameter), SI; outcome and
        reason (collision). A stick has restitution 0 with gradient 0, and NaN for undefined results. Where no
        derivative exists (see `sensitivities`) there is NaN, and `reason` names the boundary.

    Raises:
        InputError: an invalid name, length or value.

    Example:
        >>> import numpy as np
        >>> from wetdoublet import gradients_many
        >>> found = gradients_many("granulation", stokes=np.array([0.02, 0.03]), angle=1.3, wrt="liquid.viscosity")
        >>> found.gradient.sel(quantity="restitution", parameter="liquid.viscosity").shape
        (2,)
    """
    names, by = check_differentiated(of), check_engine(engine)
    impact = {"stokes": stokes, "speed": speed, "relative_speed": relative_speed, "angle": angle}
    loaded, columns, _ = checked_columns(scene, impact, {})
    batch = many.Impacts.listed(loaded, of_one_length(columns), check_rtol(rtol))
    held = held_quantity(loaded, hold) if relative_speed is None or hold is not None else "relative_speed"
    warn(loaded)
    velocity = batch.speed if batch.speed is not None else np.asarray(batch.stokes) / loaded.stokes_per_speed
    size, parameters = batch.size, check_wrt(loaded, wrt)
    request = _Gradients(
        loaded, np.asarray(velocity), batch.angle, hold=held, wrt=parameters, of=names, rtol=batch.rtol,
        outcome=np.full(size, FAILED, np.int8),
        value=np.full((len(names), size), np.nan),
        gradient=np.full((len(names), size, len(parameters)), np.nan),
        reason=np.full(size, "", object),
        engine=np.full(size, "", object),
    )  # fmt: skip
    rest = np.arange(size)
    oblique = set(request.oblique.tolist())
    offered = by in (None, "taylor") and kernel.offers(loaded, names, oblique)
    if offered:
        rest = _by_kernel(request)
    for k in rest:
        _alone(request, int(k), by or ("taylor" if offered else "rosenbrock"))
    return _dataset(request)


def _by_kernel(request: _Gradients) -> np.ndarray:
    """Compute collisions by the kernel; returns the indices of those left to CasADi."""
    moves = request.oblique
    turns = any(DEFINITIONS[name].odd for name in request.of) and bool({*request.wrt} & {*SIDEWAYS})
    blocks, rest = [], [np.flatnonzero(~moves) if turns else np.zeros(0, int)]
    for which in (np.flatnonzero(request.angle > 0), np.flatnonzero((request.angle == 0) & (moves | (not turns)))):
        blocks += [which[k : k + _STRETCH] for k in range(0, which.size, _STRETCH)]
    if len(blocks) > 1:
        with ThreadPoolExecutor(usable_cores()) as pool:  # the kernel releases the interpreter's lock
            rest += pool.map(lambda block: _stretch(request, block), blocks)
    else:
        rest += [_stretch(request, block) for block in blocks]
    return np.sort(np.concatenate(rest))


def _stretch(request: _Gradients, which: np.ndarray) -> np.ndarray:
    kind = kind_of(request.scene, request.hold)
    # for few parameters forward tangents cost no more
    back = request.of == kernel.BACKWARD and len(request.wrt) > kernel.DIRECTIONS

    def run_block(block: np.ndarray, rtol: float, budget: int, backward: bool, nearest: float = 0.0) -> kernel.Along:
        order = (order_backward if backward else order_for)(request.rtol)
        return kernel.gradients_by_kernel(
            request.subset(block), kind, request.wrt, request.of, rtol, order, budget, backward, nearest
        )

    answered = run_block(which, request.rtol, _SOON, back, NEAR)  # what is nearer is repeated
    run, value, first = answered
    answers, measures = run.answers, run.near
    failures = np.flatnonzero(answers["status"] > LAST_ANSWER)
    if back and failures.size:  # forward tangents of long trajectories, as these also limit the step
        again, value[:, failures], first[:, failures] = run_block(which[failures], request.rtol, _SOON, False)
        answers[failures], measures[failures] = again.answers, again.near
    near, least = measures[:, 0], limit(request.rtol)
    far = (answers["outcome"] > 0) & (near >= NEAR)
    _keep(request, which, answered, far)
    # long creeping collisions mostly stick, so they are first computed without derivatives
    slow = np.flatnonzero(answers["status"] > LAST_ANSWER)
    if slow.size:
        plain = _without(request, which[slow], request.rtol)
        answers[slow], measures[slow] = plain.answers, plain.near
    # nearer than NEAR to a boundary errors are amplified, so these are repeated with tolerances smaller by decades
    is_clear = np.isin(measures[:, 1], tuple(DISTANCES)) & (measures[:, 2] > COMPUTED * least)  # no distance to compute
    separated = (answers["outcome"] > 0) & ~far & (measures[:, 1] != CHATTERS)
    close = separated & ((near > COMPUTED * least) | (is_clear & (near >= least)))
    refusable = np.isin(measures[:, 1], tuple(DISTANCES)) & (near < least)
    hinted = _alike_beside(request, which, answers, np.flatnonzero(separated & ~close & ~refusable))
    close[hinted] = True
    decades = np.maximum(np.ceil(np.log10(NEAR / np.where(close, np.maximum(near, SHARPEST), NEAR))), 0.0)
    decades[hinted] += _HINTED
    for decade in np.unique(decades[close]):
        block = which[close & (decades == decade)]
        sharper = min(request.rtol, max(request.rtol * 10.0**-decade, SHARPEST))
        for backward in (True, False) if back else (False,):
            if block.size:
                closer = run_block(block, sharper, _LONG, backward)
                _keep(request, block, closer, closer[0].answers["outcome"] > 0)
                block = block[closer[0].answers["status"] > LAST_ANSWER]
    sticks = (answers["outcome"] == OUTCOMES.index(STICKS)) & (answers["status"] <= LAST_ANSWER)
    stuck = which[_alike_beside(request, which, answers, np.flatnonzero(sticks))]
    at_rest = np.where([name == "restitution" for name in request.of], 0.0, np.nan)[:, None]
    request.fill(stuck, 0, "taylor", STICK, at_rest, at_rest[:, :, None])
    for k in np.flatnonzero((answers["outcome"] > 0) & is_clear & (near < least)):
        name, of = DISTANCES[int(measures[k, 1])]
        request.reason[which[k]] = str(refused(Near(name, float(measures[k, 0]), of), least))
    return np.asarray(which[(request.outcome[which] == FAILED) & (request.reason[which] == "")])


def _without(request: _Gradients, which: np.ndarray, rtol: float, factor: float = 1.0) -> Carried:
    """The collisions without derivatives, by the same kernel."""
    block, oblique = request.subset(which), bool(request.angle[which[0]] > 0)
    faster, order = replace(block, speed=block.speed * factor), order_for(request.rtol)
    return run_tangent(faster, oblique, rtol, "rotation" in request.of, (), order)


def _keep(request: _Gradients, which: np.ndarray, answered: kernel.Along, mask: np.ndarray) -> None:
    run, value, first = answered
    slopes = np.where(np.isnan(value)[:, :, None], np.nan, first)
    request.fill(which[mask], run.answers["outcome"][mask], "taylor", "", value[:, mask], slopes[:, mask])


def _alike_beside(request: _Gradients, which: np.ndarray, answers: np.ndarray, checked: np.ndarray) -> np.ndarray:
    """Those of `checked` that go the same way up to the limit on both sides, so that no boundary is between."""
    least = limit(request.rtol)
    for factor in (1 - least, 1 + least):
        if checked.size:
            aside = _without(request, which[checked], min(request.rtol, 1e-10), factor).answers
            here, alike = answers[checked], aside["status"] <= LAST_ANSWER
            alike &= aside["outcome"] == here["outcome"]
            for name in ("reversal", "events"):  # of a stick only the outcome counts
                alike &= (aside[name] == here[name]) | (here["outcome"] == OUTCOMES.index(STICKS))
            checked = checked[alike]
    return checked


def _alone(request: _Gradients, k: int, engine: str) -> None:
    # an adjoint sweep costs less for many parameters, but may fail where tangents do not
    methods = ("adjoint", "forward") if engine != "taylor" and len(request.of) < len(request.wrt) else ("forward",)
    try:
        scene = request.scene.with_impact(speed=float(request.speed[k]), angle=float(request.angle[k]))
        problem = Problem.of(scene, *scene.need_impact(), request.wrt, request.hold)
    except WetDoubletError as error:
        request.reason[k] = str(error)
        return
    for method in methods:
        try:
            row = derivatives(problem, request.of, method, request.rtol, engine)
        except WetDoubletError as error:
            request.reason[k] = str(error)
            continue
        reason = STICK if row.outcome == STICKS else ""
        request.fill(k, OUTCOMES.index(row.outcome), row.engine, reason, row.value, row.gradient)
        return


def _dataset(request: _Gradients) -> xarray.Dataset:
    register()
    reference = references(request.scene, request.wrt, request.speed, request.angle).T
    along, over = ("collision",), ("quantity", "collision", "parameter")
    stokes = request.speed * request.scene.stokes_per_speed
    variables: dict[str, Column] = {
        "value": (("quantity", "collision"), request.value, {"long_name": "results, SI"}),
        "gradient": (over, request.gradient, {"long_name": "derivatives by the parameters, SI"}),
        "elasticity": (
            over, elasticities(request.value, request.gradient, reference),
            {"units": "1", "long_name": "d ln y/d ln p"},
        ),
        "outcome": (along, request.outcome, outcome_attributes()),
        "reason": (along, request.reason.astype(str), {"long_name": "why there is no derivative"}),
        "engine": (along, request.engine.astype(str), {"long_name": "what computed it"}),
    }  # fmt: skip
    coordinates: dict[str, Column] = {
        "units": (("quantity",), np.array([DEFINITIONS[name].unit for name in request.of]), {}),
        "reference": (("collision", "parameter"), reference, {}),
        **{name: (along, values, attributes(name)) for name, values in
           (("speed", request.speed), ("stokes", stokes), ("angle", request.angle))},
    }  # fmt: skip
    attrs = provenance(request.scene, rtol=request.rtol, hold=request.hold)
    return labelled(variables, coordinates, attrs, {"quantity": request.of, "parameter": request.wrt})
