"""`design()`: where the next impacts should be to learn most about entries of a scene."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...generated.automaton import OUTCOMES, STICK
from ..engines.settings import check_rtol
from ..errors import InputError
from ..fitting.data_table import read_data
from ..fitting.fit import RTOL, fit
from ..fitting.free_entries import free_entries
from ..host.arguments import check_function, check_name, check_whole
from ..host.progress import Estimated, Progress
from ..model.validity import warn
from ..scene.scene import Scene
from .information import information
from .result import Design
from .search import search, worth
from .window import Scatter, Window, check_over

_SPACING = 20  # candidates to begin with, to either side
_MOST = 1000
_AT_ONCE = 64  # impacts that are evaluated together
_MORE, _PER_IMPACT = 600, 50  # assumed candidates of the refinement, and of each distinct impact; rather too many
_OTHERS = 0.1  # weight of all entries beside the one that matters
_NOTHING = 1e-9  # information of an impact on an entry, in the variable of the search, that is none


def design(
    scene: Scene | str | Path,
    free: Sequence[str] | str,
    over: Mapping[str, Any],
    n: int = 9,
    *,
    target: str | None = None,
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
            and one value in place of two ends.
        n: number of impacts.
        target: the entry of `free` that matters; the others are then estimated little more than that needs. Default all
            alike (D-optimal).
        data: impacts measured before, as of `fit`; they are fitted first, and what they tell counts.
        prior: what is known of free entries, as of `fit`.
        speed_sd: scatter of the speed, relative ("2 %"); angle_sd: of the angle. Default: the data's, or `fit`'s.
        restitution_sd: standard deviation of the measured restitution; "none" if only outcomes are recorded. Default
            the data's, or 0.02.
        rtol: relative tolerance of the collisions.
        progress: called with (impacts evaluated, impacts in all); the second is an estimate, which may grow, and is
            reached at the end. A fit of `data` before is not counted.

    Returns:
        Design: the impacts, what they will tell, and how they compare with an even grid.

    Raises:
        InputError: a wrong argument, or an entry on which nothing in the window depends.
        ComputationError: the scene's collisions are not differentiated by a compiled kernel.

    Example:
        >>> from wetdoublet.solvers import design
        >>> found = design("granulation", ["liquid.viscosity"], {"stokes": (0.05, 0.3), "angle": 0.0}, 4)
        >>> bool(found.against_grid["liquid.viscosity"] < 0.7)
        True
    """
    rtol = check_rtol(rtol)
    check_function(progress, "progress")
    loaded = Scene.load(scene)
    ends = check_over(over)
    size = check_whole(n, "n", 1, _MOST)
    table = None if data is None else read_data(data, loaded)
    default = Scatter() if table is None else Scatter.typical(table)
    window = Window(loaded, *ends, Scatter.checked(speed_sd, angle_sd, restitution_sd, default))
    if table is None:
        entries = free_entries(loaded, free, window.plan(np.zeros((1, 2))), prior, rtol)
        values, before = entries.values(entries.start), np.diag(entries.misfits(entries.start)[1] ** 2)
    else:
        fitted = fit(loaded, table, free, prior=prior, rtol=rtol)
        entries, window = fitted.free, replace(window, scene=fitted.scene)
        values, before = entries.values(fitted.best), fitted.objective.information(fitted.best)
    single = None if target is None else check_name(target, entries.names, "target")
    warn(window.scene)
    first, number = window.candidates(_SPACING, rtol), None if single is None else entries.names.index(single)
    work = Estimated(progress, len(first) + _MORE + _PER_IMPACT * min(size, entries.size + 2))
    work.start()

    def evaluate(points: np.ndarray) -> np.ndarray:
        """The information of impacts, in the variables of the search."""
        totals = []
        for block in np.array_split(points, -(-len(points) // _AT_ONCE)):
            totals.append(information(window.scene, entries.names, values, window.plan(block), rtol).total)
            work.add(len(block))
        return np.concatenate(totals) * np.outer(entries.rates(values), entries.rates(values))

    def criterion(total: np.ndarray) -> np.ndarray:
        """The range of the search keeps sums of information from being singular; beyond it nothing is known."""
        return worth(before + entries.vague + total, number, _OTHERS)

    choice = search(evaluate, criterion, size, first, 1 / (_SPACING - 1))
    most = np.einsum("cii->ci", choice.single).max(axis=0)  # information of an impact on each entry
    for name, information_of_one in zip(entries.names, most, strict=True):
        if single in (None, name) and information_of_one < _NOTHING:
            accepted = "entries that outcome or restitution depend on in this window"
            all_stick = set(window.outcomes(first, rtol).tolist()) == {OUTCOMES.index(STICK)}
            problem = "changes nothing that is observed in the window" + ", where all impacts stick" * all_stick
            raise InputError("free", name, accepted, problem)
    planned = Design.of(window, entries, values, before, choice, single, size, rtol, loaded)
    work.finish()
    return planned
