"""Cache of the located trajectories of one case."""

from __future__ import annotations

import time
from typing import Any

from ...engines.casadi.locate import EventLocator, EventSequence
from ...errors import ComputationError
from ...model.model import Model


class LocatedTrajectories:
    """Trajectories used by several engines and the audit, located once; event location is deterministic."""

    def __init__(self) -> None:
        self._known: dict[Any, tuple[EventLocator, ComputationError | None, float]] = {}
        self.spared = 0.0  # s of CPU time saved by the cache

    def forget(self) -> None:
        """Clear the cache for a new case."""
        self._known.clear()

    def find(self, model: Model, groups: dict[str, float], rtol: float, extras: tuple[str, ...]) -> EventSequence:
        """The located trajectory, as `locate` returns it."""
        return self._located(model, groups, rtol, extras).path

    def handed_out(self, model: Model, groups: dict[str, float], rtol: float) -> EventLocator:
        """Remove and return a located trajectory, which the caller may continue."""
        located = self._located(model, groups, rtol)
        self.forget()
        return located

    def _located(
        self, model: Model, groups: dict[str, float], rtol: float, extras: tuple[str, ...] = ()
    ) -> EventLocator:
        key = model.choice, tuple(groups.items()), rtol, extras
        if key in self._known:
            self.spared += self._known[key][2]
        else:
            start, located, failure = time.process_time(), EventLocator(model, groups, rtol, extras), None
            try:
                located.run()
            except ComputationError as error:
                failure = error
            self._known[key] = located, failure, time.process_time() - start
        located, failure, _ = self._known[key]
        if failure is not None:
            raise failure
        return located
