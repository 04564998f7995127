"""Numerical settings of a run: relative tolerance, engine and step budget."""

import math
from dataclasses import dataclass

from ..host.arguments import check_name
from ..scene.schema import Field, Range

CASADI_ENGINES = ("cvodes", "rosenbrock")  # plugins of CasADi's `integrator`
ENGINES = (*CASADI_ENGINES, "taylor")
RTOL = 1e-9  # default
# Budget of one collision for all engines that try it, about a second on one core, in steps of the planar kernel. Beyond
# it a ComputationError says where the collision stands, or a status of the exported law that it is undecided.
STEPS = 300_000
STEPS_IN_SPACE = STEPS // 3  # the same time in steps of the kernel in space
ROSENBROCK, ROSENBROCK_IN_SPACE = 20, 30  # a step of CasADi's Rosenbrock, in steps of the planar kernel
CVODES = 1 / 8  # and one of CVODES, in those of Rosenbrock
CASADI_STEPS, CASADI_STEPS_IN_SPACE = STEPS // ROSENBROCK, STEPS // ROSENBROCK_IN_SPACE
KERNEL_STEPS, KERNEL_STEPS_IN_SPACE = STEPS // 2, STEPS_IN_SPACE // 2  # of the kernel, where CasADi has the other half
CHATTER_STEPS = STEPS // 8  # left to CasADi where it cannot follow as many rebounds as the kernel has
CALL, CALLS = 25, 3  # least number of steps that a CasADi call counts for; ratio of the numbers that it may take
FEW = 100  # up to this many collisions, a second core does not pay
TOLERANCE = Field(
    "rtol", "a relative tolerance", "1e-9", Range("from 1e-13 to 1e-3", 1e-13, 1e-3, low_open=False, high_open=False)
)
UNTIL = Field("until", "a time after initial contact", '"5 ms"', unit="s")  # to which a stick is followed on


def casadi_steps(rtol: float, space: bool = False, spent: int = 0) -> int:
    """Most steps of one collision by CasADi's Rosenbrock, after `spent` steps of the planar kernel.

    Below the default tolerance they are more in the ratio of the step lengths of Rosenbrock, of order 5.
    """
    most = (STEPS - spent) // (ROSENBROCK_IN_SPACE if space else ROSENBROCK)
    return round(most * max(1.0, float((RTOL / rtol) ** (1 / 5))))


def spent_by_kernel(steps: int, events: int) -> int:
    """Steps of a collision that count as spent once the kernel has given it up: most, where CasADi cannot follow it."""
    chatters = steps + events * CALL * ROSENBROCK > STEPS
    return STEPS - CHATTER_STEPS if chatters else steps


@dataclass
class Budget:
    """Steps of CasADi's Rosenbrock that a collision has, shared by all integrations that it takes."""

    most: int
    spent: int = 0

    @property
    def is_spent(self) -> bool:
        return self.most - self.spent < CALL

    @property
    def call(self) -> int:
        """Most steps of the next call; one of few numbers, as each needs an integrator of its own."""
        steps = CALL
        while steps * CALLS <= self.most - self.spent:
            steps *= CALLS
        return steps

    def spend(self, steps: float) -> None:
        """Count the steps of a call."""
        self.spent += max(math.ceil(steps), CALL)


def check_rtol(rtol: object, label: str = "rtol") -> float:
    """Return the relative tolerance; InputError naming `label` unless it is 1e-13 to 1e-3."""
    return TOLERANCE.number(rtol, label=label)


def check_engine(engine: object, label: str = "engine") -> str | None:
    """Return the engine, None for the default; InputError naming `label` if it is unknown."""
    return None if engine is None else check_name(engine, ENGINES, label)
