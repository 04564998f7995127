"""The kernel's own trajectory held against the equations, step by step, where an engine cannot follow it as a whole.

Nearer to a separatrix than about 1e-9, every error grows to the size of the motion, so that no engine can repeat the
trajectory of another. Within one step it grows little: from where a step of the kernel begins, an engine of CasADi must
arrive where it ends, and on its series no event may happen but the one recorded.
"""

import numpy as np

from ...model.key import ModelKey
from ...model.model import load
from ...model.phases import Flow
from ..steps import Steps
from .integrators import IntegrationFailed, plain, tolerance_for
from .replay import Stopped
from .sequence import EventSequence
from .watch import POINTS, first_crossing

_APART = 1e2  # relative tolerances of the kernel by which the ends of a step may differ; of a state near zero, those
_SCALE = 1e-3  # of a motion of this size


def confirm(path: EventSequence, steps: Steps, choice: ModelKey, plugin: str, rtol: float) -> None:
    """Hold the kernel's steps against an engine; Stopped where they do not agree.

    Arguments:
        steps: of the same collision as `path`, by a kernel with the states of the model `choice`.
    """
    model, tolerance = load(choice), tolerance_for(rtol, plugin, path.groups)
    p, size = model.group_values(path.groups), len(model.state)
    for k, phase_run in enumerate(path.steps):
        rows = steps.rows[steps.rows["phase"] == k]
        if not (phase_run.duration > 0 and rows.size):
            continue
        phase, part = phase_run.phase, Steps(rows, steps.turned)
        flow = Flow(choice, phase.region)
        for row in rows:
            start = row["series"][:size, 0].copy()
            end = row["series"][:size] @ row["length"] ** np.arange(row["series"].shape[1])
            try:
                reached = plain(flow, plugin, tolerance)(start, p, float(row["length"]))
            except IntegrationFailed as failure:
                raise Stopped(f"gave up ({failure})", phase, float(row["time"]), start) from None
            allowed = _APART * rtol * np.maximum(np.maximum(np.abs(start), np.abs(end)), _SCALE)
            if not (np.abs(reached - end) <= allowed).all():
                raise Stopped("does not agree with a step of the kernel", phase, float(row["time"]), start)
        first, duration = float(rows[0]["time"]), phase_run.duration

        def solution(
            parts: np.ndarray, part: Steps = part, first: float = first, duration: float = duration
        ) -> np.ndarray:
            return part.states(first + parts * duration)[:size]

        parameters, states = np.append(p, float(phase.motion)), solution(POINTS)
        crossing = first_crossing(
            flow, path.watch, parameters, duration, states, solution, tolerance.relative, phase_run.event
        )
        if crossing is not None:
            raise Stopped(
                f"finds the event {crossing.event} inside a phase of the kernel", phase,
                first + crossing.part * duration, states[:, -1],
            )  # fmt: skip
