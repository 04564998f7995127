"""The kernel's own trajectory held against the equations, step by step, where an engine cannot follow it as a whole.

Nearer to a separatrix than about 1e-9, every error grows to the size of the motion, so that no engine can repeat the
trajectory of another. Within one step it grows little: from where a step of the kernel begins, an engine of CasADi must
arrive where it ends. The next step begins there, or where the jump of the event in between leads; and on the kernel's
series no event may happen but the recorded one, at the end.
"""

import numpy as np

from ...model.key import ModelKey
from ...model.phases import Flow, Phase
from ..steps import Steps
from .integrators import IntegrationFailed, plain, tolerance_for
from .replay import Run, Stopped
from .sequence import EventSequence, PhaseRun
from .watch import POINTS, first_crossing, is_met

_APART = 1e2  # relative tolerances of the kernel by which two states may differ; of one near zero, those
_SCALE = 1e-3  # of a motion of this size


class Confirmation(Run):
    """A replay whose phases are the kernel's own steps, each confirmed by an engine.

    Arguments:
        steps: of the same collision as `path`, by a kernel with the states of the model `choice`.
    """

    def __init__(self, path: EventSequence, steps: Steps, choice: ModelKey, plugin: str, rtol: float) -> None:
        super().__init__(path, choice, (), plugin, tolerance_for(rtol, plugin, path.groups), rtol)
        self.steps = steps

    def integrate(self, k: int, step: PhaseRun) -> None:
        """Phase k by its steps, with the state at its end."""
        at, phase, flow = self.at, step.phase, Flow(self.choice, step.phase.region, (), self.path.edge_watched)
        inside = Steps(self.steps.rows[self.steps.rows["phase"] == k], self.steps.turned)
        first, engine = at.time, plain(flow, self.plugin, self.tolerance)
        for row in inside.rows:
            series, length = row["series"][: at.y.size], float(row["length"])
            start, end = series[:, 0].copy(), series @ length ** np.arange(series.shape[1])
            sizes = np.maximum(np.abs(start), np.abs(end))
            self._compare(
                "finds that a step of the kernel begins elsewhere than the last one led", at.y, start, sizes, phase
            )
            try:
                reached = engine(start, self.p, length)
            except IntegrationFailed as failure:
                raise Stopped(f"gave up ({failure})", phase, at.time, start) from None
            self._compare("does not agree with a step of the kernel", reached, end, sizes, phase)
            at.time, at.y = float(row["time"]) + length, end
        self._watch(step, flow, inside, first)

    def _compare(self, what: str, y: np.ndarray, other: np.ndarray, sizes: np.ndarray, phase: Phase) -> None:
        """Stopped if two states differ by more than the errors of kernel and engine, relative to these sizes."""
        if not (np.abs(y - other) <= _APART * self.rtol * np.maximum(sizes, _SCALE)).all():
            raise Stopped(what, phase, self.at.time, other)

    def _watch(self, step: PhaseRun, flow: Flow, inside: Steps, first: float) -> None:
        """Stopped if another event than the recorded one happens on the series of a phase, or that one does not."""

        def solution(parts: np.ndarray) -> np.ndarray:
            return inside.states(first + parts * step.duration)[: self.at.y.size]

        phase, rtol = step.phase, self.tolerance.relative
        parameters, states = np.append(self.p, float(phase.motion)), solution(POINTS)
        crossing = first_crossing(flow, parameters, step.duration, states, solution, rtol, step.event)
        if crossing is not None:
            time = first + crossing.fraction * step.duration
            raise Stopped(f"finds the event {crossing.event} inside a phase of the kernel", phase, time, self.at.y)
        if step.event is not None and not is_met(flow, parameters, states, step.event, self.rtol):
            raise Stopped(f"does not find the event {step.event} where the kernel does", phase, self.at.time, self.at.y)
