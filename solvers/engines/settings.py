"""Numerical settings of a run: relative tolerance, engine and step budget."""

from ..host.arguments import check_name
from ..scene.fields import Field, Range

CASADI_ENGINES = ("cvodes", "rosenbrock")  # plugins of CasADi's `integrator`
ENGINES = (*CASADI_ENGINES, "taylor")
RTOL = 1e-9  # default
# Most steps of one collision, about half a second on one core; in space a step takes longer. Beyond it a
# ComputationError says where the collision stands, or a status of the exported law that it is undecided.
KERNEL_STEPS, KERNEL_STEPS_IN_SPACE = 1_000_000, 300_000
ROSENBROCK_STEPS, ROSENBROCK_STEPS_IN_SPACE = 15_000, 5_000  # most of one phase at the default tolerance
SMALL = 10_000  # a map of up to this many collisions takes less time than the compiler, for a user's model
MOST = 10_000_000  # collisions of a map, at 130 bytes each, or values of a range; more are probably a typing error
MOST_STORED = 10**10  # the same for a map that is written to disk as it is computed
FEW = 100  # up to this many collisions, a second core does not pay
TOLERANCE = Field("rtol", "a relative tolerance", "1e-9", Range("from 1e-13 to 1e-3", 1e-13, 1e-3, False, False))
UNTIL = Field("until", "a time after initial contact", '"5 ms"', unit="s")  # to which a stick is followed on


def most_collisions(most: int) -> str:
    """What is accepted as the size of a map, in words."""
    return f"at most {most} collisions in all" + ("" if most > MOST else ", or more without a picture in a .zarr")


def casadi_steps(rtol: float, space: bool = False) -> int:
    """Most steps of a phase by CasADi's Rosenbrock.

    Below the default tolerance they are more in the ratio of the step lengths of Rosenbrock, of order 5.
    """
    most = ROSENBROCK_STEPS_IN_SPACE if space else ROSENBROCK_STEPS
    return round(most * max(1.0, float((RTOL / rtol) ** (1 / 5))))


def check_rtol(rtol: object) -> float:
    """Return the relative tolerance; InputError unless it is 1e-13 to 1e-3."""
    return TOLERANCE.number(rtol)


def check_engine(engine: object) -> str | None:
    """Return the engine, None for the default; InputError if it is unknown."""
    return None if engine is None else check_name(engine, ENGINES, "engine")
