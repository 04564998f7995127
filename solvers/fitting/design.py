"""`design()`: where the next impacts should be to learn most about entries of a scene."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...generated.automaton import OUTCOMES, STICK
from ..engines.settings import check_rtol
from ..errors import InputError
from ..host.arguments import check_function, check_whole
from ..host.progress import Estimated, Progress
from ..model.validity import warn
from ..scene.scene import Scene
from .data_table import read_data
from .design_result import Design, Impact, expected
from .design_search import search
from .design_window import Window, scatter_of
from .fit import RTOL, fit
from .free_entries import COMBINED, IDENTIFIED, combinations, free_entries
from .information import information

_SPACING = 20  # candidates to begin with, to either side
_MOST = 1000
_AT_ONCE = 64  # impacts that are evaluated together
_MORE, _PER_IMPACT = 600, 50  # assumed candidates of the refinement, and of each distinct impact; rather too many
_NOTHING = 1e-9  # information of an impact on an entry, in the variable of the search, that is none


def design(
    scene: Scene | str | Path,
    free: Sequence[str] | str,
    over: Mapping[str, Any],
    n: int = 9,
    *,
    data: Any = None,
    prior: Mapping[str, str] | None = None,
    speed_sd: float | str | None = None,
    angle_sd: float | str | None = None,
    restitution_sd: float | str | None = None,
    rtol: float = RTOL,
    progress: Progress | None = None,
) -> Design:
    """Choose the impacts from whose outcomes and restitutions `fit` will learn most.

    Arguments:
        scene: a Scene, a path or a preset's name. The impacts are best for its values of the free entries, or for the
            estimates from `data`.
        free: entries that will be estimated, by dotted name.
        over: window of impacts, {"stokes": (0.02, 0.5), "angle": ("0 deg", "80 deg")}; also speed or relative_speed,
            and one value in place of two ends. Default the scene's impact.
        n: number of impacts.
        data: impacts measured before, as of `fit`; they are fitted first, and what they tell counts.
        prior: what is known of free entries, as of `fit`.
        speed_sd: scatter of the speed, relative ("2 %"); angle_sd: of the angle. Default: the data's, or `fit`'s.
        restitution_sd: standard deviation of the measured restitution; "none" if only outcomes are recorded. Default
            the data's, or 0.02.
        rtol: relative tolerance of the collisions.
        progress: called with (impacts evaluated, impacts in all); the second is an estimate, which may grow, and is
            reached at the end. A fit of `data` before is not counted.

    Returns:
        Design: the impacts, and what they will tell; the determinant of their information is largest (D-optimal).

    Raises:
        InputError: a wrong argument, or an entry on which nothing in the window depends.
        ComputationError: the scene's collisions are not differentiated by a compiled kernel.

    Example:
        >>> from wetdoublet.solvers import design
        >>> found = design("granulation", ["liquid.viscosity"], {"stokes": (0.05, 0.3), "angle": 0.0}, 4)
        >>> sum(impact.count for impact in found.impacts)
        4
    """
    rtol = check_rtol(rtol)
    check_function(progress, "progress")
    loaded = Scene.load(scene, free=free)
    size = check_whole(n, "n", 1, _MOST)
    table = None if data is None else read_data(data, loaded)
    scatter = scatter_of(table, speed=speed_sd, angle=angle_sd, restitution=restitution_sd)
    window = Window.of(loaded, over, scatter)
    if table is None:
        free_ones = free_entries(loaded, free, window.plan(np.zeros((1, 2))), prior, rtol)
        values, before = free_ones.values(free_ones.start), np.diag(free_ones.misfits(free_ones.start)[1] ** 2)
    else:
        fitted = fit(loaded, table, free, prior=prior, rtol=rtol)
        free_ones, window = fitted.free, replace(window, scene=fitted.scene)
        values, before = free_ones.values(fitted.best), fitted.objective.information(fitted.best)
    names, rates = free_ones.names, np.outer(*2 * [free_ones.rates(values)])
    warn(window.scene)
    first = window.candidates(_SPACING, rtol)
    work = Estimated(progress, len(first) + _MORE + _PER_IMPACT * min(size, len(names) + 2))
    work.start()

    def evaluate(points: np.ndarray) -> np.ndarray:
        """The information of impacts, in the variables of the search."""
        totals = []
        for block in np.array_split(points, -(-len(points) // _AT_ONCE)):
            totals.append(information(window.scene, names, values, window.plan(block), rtol)[0])
            work.add(len(block))
        return np.asarray(np.concatenate(totals) * rates)

    # the range of a fit's search keeps sums of information from being singular; beyond it nothing is known
    points, counts, single = search(evaluate, before + free_ones.vague, size, first, 1 / (_SPACING - 1))
    for k in np.flatnonzero(np.einsum("cii->ci", single).max(axis=0) < _NOTHING):
        accepted = "entries that outcome or restitution depend on in this window"
        all_stick = set(window.outcomes(first, rtol).tolist()) == {OUTCOMES.index(STICK)}
        problem = "changes nothing that is observed in the window" + ", where all impacts stick" * all_stick
        raise InputError("free", names[k], accepted, problem)
    plan = window.plan(points)
    told, probability = information(window.scene, names, values, plan, rtol)
    total = before + np.einsum("c,cij->ij", counts, told * rates)
    rows = zip(counts.tolist(), plan.normal_speed.tolist(), plan.angle.tolist(), probability.tolist())
    impacts = tuple(
        Impact(count, window.scene.stokes_of(speed), speed, speed / math.cos(angle), angle, dict(zip(OUTCOMES, share)))
        for count, speed, angle, share in rows
    )
    with_them = expected(free_ones, values, total)
    verdicts = [COMBINED if entry.low is entry.high else IDENTIFIED for entry in with_them.values()]
    work.finish()
    return Design(
        window, free_ones, values, impacts, with_them, expected(free_ones, values, before),
        combinations(free_ones, total, verdicts, "These impacts"), points, rtol, loaded,
    )  # fmt: skip
