"""Prints the table of solvers/engines/taylor/runtime/damped_sum.h: `python tests/benchmarks/damping.py` (needs scipy).

For each order, the three factors that keep |R(z)| <= 0.6 from z = 2.5 up to the largest z that allows it, by linear
programming; the largest z by bisection.
"""

import math

import numpy as np
from scipy.optimize import linprog

FACTORS, AMPLIFICATION, FROM = 3, 0.6, 2.5


def factors(order: int, reach: float) -> tuple[float, list[float]]:
    """The least largest |R| on [FROM, reach], and the factors that attain it."""
    z = reach * (1 - np.cos(np.linspace(0, np.pi, 600))) / 2
    z = z[z > FROM]
    kept = order - FACTORS
    damped = range(kept + 1, order + 1)
    series = sum((-z) ** k / math.factorial(k) for k in range(kept + 1))
    terms = np.array([(-z / reach) ** k for k in damped]).T  # scaled, so that the program is well conditioned
    below = -np.ones((z.size, 1))
    found = linprog(
        [0.0] * FACTORS + [1.0],
        A_ub=np.vstack([np.hstack([terms, below]), np.hstack([-terms, below])]),
        b_ub=np.concatenate([-series, series]),
        bounds=[(None, None)] * FACTORS + [(0, None)],
        method="highs",
    )
    return found.x[-1], [found.x[j] * math.factorial(k) / reach**k for j, k in enumerate(damped)]


def farthest(order: int) -> float:
    """The largest z with |R| <= AMPLIFICATION."""
    low, high = 3.0, 30.0
    while high - low > 1e-3:
        middle = (low + high) / 2
        low, high = (middle, high) if factors(order, middle)[0] <= AMPLIFICATION else (low, middle)
    return low


def main() -> None:
    """The rows, as C."""
    for order in range(8, 17):
        reach = farthest(order)
        row = ", ".join(f"{factor:.7g}" for factor in factors(order, reach)[1])
        print(f"    {{{row}}}, /* {order}: {reach:.1f} */")  # noqa: T201 # a script


if __name__ == "__main__":
    main()
