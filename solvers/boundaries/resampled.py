"""States inside the phases of a located trajectory, integrated again."""

from collections.abc import Callable, Iterator

import numpy as np

from ..engines.casadi.integrators import IntegrationFailed, Tolerance, plain
from ..engines.casadi.locate import EventSequence, PhaseRun
from ..model.phases import Flow


def resampled(
    path: EventSequence,
    tolerance: Tolerance,
    grid: tuple[float, ...],
    wanted: Callable[[PhaseRun], bool],
    extras: tuple[str, ...] = (),
    lenient: bool = False,
) -> Iterator[tuple[PhaseRun, np.ndarray, np.ndarray | None, np.ndarray]]:
    """Yield for each phase the state before it, states inside it as columns, and the state after it.

    Arguments:
        grid: parts of a phase's duration.
        wanted: selects the phases to integrate; the states inside the others are None.
        lenient: None also where an integration fails, instead of an error.

    Raises:
        IntegrationFailed: an integration failed and `lenient` is False.
    """
    model = path.model
    size = len(model.state) + len(extras)
    before = np.append(model.start(path.p), np.zeros(len(extras)))
    for step, end in zip(path.steps, path.ends, strict=True):
        inside = None
        if step.duration > 0 and wanted(step):
            integrate = plain(Flow(model.choice, step.phase.region, extras), "rosenbrock", tolerance, grid)
            try:
                inside = integrate(before, path.p, step.duration)
            except IntegrationFailed:
                if not lenient:
                    raise
        yield step, before, inside, end[:size]
        before = end[:size]
