"""A differential equation up to the first of some guards, in double precision: what independent references share.

Scipy's DOP853 where it is not stiff, collocation where it is. A guard is crossed where it rises through zero, which is
located by integrating again from the beginning of the step, not on an interpolant, so that its error is rounding's.
"""

import math
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import ode

from . import collocation

RTOL = 1e-13
STIFF = 2000  # steps after which DOP853 gives way to collocation
STEPS = 20_000
COLLOCATIONS = 1000
FAR = 1e30

State = list[float]
Rates = Callable[[float, Sequence[float]], State]
Guard = Callable[[Sequence[float], Sequence[float]], tuple[float, float]]
"""Value and time derivative, from a state and its rates; an event is where the value rises through zero."""


class Unfinished(ArithmeticError):
    """The integration came to no end."""


@dataclass(frozen=True)
class Arrival:
    """Where it stopped: at a guard (its name), where `done` holds or after the longest time (None), at time `t`."""

    t: float
    y: State
    guard: str | None


@dataclass(frozen=True)
class Flow:
    """Rates (autonomous), the size of each component, and when to give up.

    Scipy's DOP853 has one absolute tolerance for all components, so it is given each over its size.
    """

    rates: Rates
    sizes: Sequence[float]
    longest: float

    def until(
        self, t: float, y: State, guards: Mapping[str, Guard], done: Callable[[float, Sequence[float]], bool]
    ) -> Arrival:
        """Integrate from (t, y) to the first guard, or to the end of a step at which `done` holds."""
        watch = _Watch(self, guards, done, t, y)
        if not watch.run_explicit():
            watch.run_stiff()
        return watch.arrival()

    def state_after(self, y: State, h: float, *, stiff: bool = False) -> State:
        """The state a time `h` later, of the order of a step."""
        if h == 0.0:
            return list(y)
        if stiff:
            *_, (_, z) = self.stiff_steps(y, h, h)
            return self.unscaled(z)
        solver = self.explicit()
        solver.set_initial_value(self.scaled(y), 0.0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            found = solver.integrate(h)
        if not solver.successful():
            raise Unfinished(f"{h} s from {y}")
        return self.unscaled(found)

    def scaled_rates(self) -> Callable[[float, np.ndarray], State]:
        sizes, rates = tuple(self.sizes), self.rates

        def scaled(t: float, z: np.ndarray) -> State:
            try:
                slopes = rates(t, [each * size for each, size in zip(z.tolist(), sizes)])
            except (ArithmeticError, ValueError):  # a trial step out of the domain: rejected for its error
                return [FAR] * len(sizes)
            return [each / size for each, size in zip(slopes, sizes)]

        return scaled

    def explicit(self) -> ode:
        """DOP853, of scaled states."""
        return ode(self.scaled_rates()).set_integrator("dop853", rtol=RTOL, atol=1e-2 * RTOL, nsteps=STEPS)

    def stiff_steps(self, y: State, first: float, most: float) -> Iterator[tuple[float, np.ndarray]]:
        """Collocation's steps, of scaled states."""
        rates = self.scaled_rates()
        return collocation.steps(lambda z: np.array(rates(0.0, z)), np.array(self.scaled(y)), first, most)

    def scaled(self, y: Sequence[float]) -> State:
        return [each / size for each, size in zip(y, self.sizes, strict=True)]

    def unscaled(self, z: np.ndarray) -> State:
        return [each * size for each, size in zip(z.tolist(), self.sizes, strict=True)]


class _Watch:
    """Looks at every step for guards that were crossed in it."""

    def __init__(
        self,
        flow: Flow,
        guards: Mapping[str, Guard],
        done: Callable[[float, Sequence[float]], bool],
        t: float,
        y: State,
    ) -> None:
        self.flow, self.guards, self.done = flow, guards, done
        self.t, self.y = t, list(y)
        self.values = self._values(self.y)
        self.found: Arrival | None = None
        self.stiff, self.step = False, 0.0

    def _values(self, y: Sequence[float]) -> dict[str, tuple[float, float]]:
        slopes = self.flow.rates(0.0, y)
        return {name: guard(y, slopes) for name, guard in self.guards.items()}

    def run_explicit(self) -> bool:
        """Whether DOP853 came to an end.

        It is stopped where a guard needs a look, since it cannot run inside itself.
        """
        count, last = 0, (self.t, self.y)

        def step(t: float, z: np.ndarray) -> int:
            nonlocal count, last
            count, y = count + 1, self.flow.unscaled(z)
            last = (t, y)
            return -1 if self._take(t, y, only_past=True) or count >= STIFF else 0

        while self.found is None and count < STIFF:
            solver = self.flow.explicit()
            solver.set_solout(step)
            solver.set_initial_value(self.flow.scaled(self.y), self.t)
            with warnings.catch_warnings():  # what stops it is looked at below
                warnings.simplefilter("ignore", UserWarning)
                solver.integrate(self.t + self.flow.longest)
            self._take(*last)
            if not solver.successful():
                break
        return self.found is not None

    def run_stiff(self) -> None:
        """Collocation, step by step, from where it is."""
        begin, self.stiff = self.t, True
        for k, (t, z) in enumerate(self.flow.stiff_steps(self.y, 0.1 * self.step, self.flow.longest)):
            if self._take(begin + t, self.flow.unscaled(z)):
                return
            if k > COLLOCATIONS:
                raise Unfinished(f"{COLLOCATIONS} steps")

    def _take(self, t: float, y: State, *, only_past: bool = False) -> bool:
        """Take the step to (t, y); whether it was the last.

        Arguments:
            only_past: leave the step alone, and answer true, if something may have happened in it.
        """
        if t == self.t:
            return False
        h, after = t - self.t, self._values(y)
        suspects = [name for name in after if self._suspect(self.values[name], after[name])]
        if only_past and (suspects or self.done(t, y)):
            return True
        crossed: dict[str, float] = {}
        for name in suspects:
            reach = h if after[name][0] >= 0.0 else self._dip(name, h, after[name])
            if reach is not None:
                crossed[name] = self._located(name, reach)
        if crossed:
            first = min(crossed, key=lambda name: crossed[name])
            self.found = Arrival(
                self.t + crossed[first], self.flow.state_after(self.y, crossed[first], stiff=self.stiff), first
            )
        elif self.done(t, y):
            self.found = Arrival(t, y, None)
        self.t, self.y, self.values, self.step = t, y, after, h
        return self.found is not None

    @staticmethod
    def _suspect(before: tuple[float, float], after: tuple[float, float]) -> bool:
        """Whether a guard that was not positive is, or may have been in between."""
        return before[0] <= 0.0 and (after[0] >= 0.0 or before[1] > 0.0 > after[1])

    def _dip(self, name: str, h: float, after: tuple[float, float]) -> float | None:
        """Time within a step of a guard's maximum, if it is positive there while it is negative at both ends."""
        top = self._root(lambda at: -self._guard(name, at)[1], h, -self.values[name][1], -after[1])
        return top if self._guard(name, top)[0] >= 0.0 else None

    def _guard(self, name: str, h: float) -> tuple[float, float]:
        y = self.flow.state_after(self.y, h, stiff=self.stiff)
        return self.guards[name](y, self.flow.rates(0.0, y))

    def _located(self, name: str, h: float) -> float:
        """Time within the step at which the guard rises through zero, by Newton's method within a bracket."""
        low, high = 0.0, h
        value, slope = self._guard(name, high)
        at = high
        for _ in range(60):
            if value >= 0.0:
                high = at
            else:
                low = at
            ahead = at - value / slope if slope > 0.0 else math.nan
            if not low <= ahead <= high:
                ahead = (low + high) / 2
            if abs(ahead - at) <= 2e-16 * h or high - low <= 2e-16 * h:
                return ahead
            at = ahead
            value, slope = self._guard(name, at)
        return at

    @staticmethod
    def _root(function: Callable[[float], float], h: float, first: float, last: float) -> float:
        """Root of a function that changes sign between 0 and h, to 1e-6 of h (regula falsi, Illinois)."""
        low, high = 0.0, h
        for _ in range(60):
            at = high - last * (high - low) / (last - first)
            value = function(at)
            if abs(high - low) < 1e-6 * h or value == 0.0:
                return at
            if (value > 0.0) == (last > 0.0):
                if abs(at - high) < 1e-6 * h:
                    return at
                high, last, first = at, value, first / 2
            else:
                if abs(at - low) < 1e-6 * h:
                    return at
                low, first, last = at, value, last / 2
        return at

    def arrival(self) -> Arrival:
        return self.found or Arrival(self.t, self.y, None)
