"""Errors of sensitivities on the twelve collisions, as the table of docs/engineering/sensitivity-figures.md.

python -m tests.benchmarks.sensitivity_accuracy     (a minute)
"""

from __future__ import annotations

import json
from pathlib import Path

from wetdoublet.solvers import ComputationError, sensitivities

from ..helpers.sensitive import CASES, apart

HERE = Path(__file__).parents[1]
OF = "restitution"


def main() -> None:
    """Compute and print."""
    reference = json.loads((HERE / "data" / "sensitivities.json").read_text())
    print("| collision | events | forward | adjoint | forward - adjoint | cvodes 1e-10 | cvodes 3e-12 |")  # noqa: T201 # below
    print("|---|---|--:|--:|--:|--:|--:|")  # noqa: T201 # what a script is for
    for case in CASES:
        row = reference[case.name][OF]
        runs = {
            (engine, method, rtol): _row(case.scene, engine, method, rtol, tuple(row))
            for engine, method, rtol in (
                ("rosenbrock", "forward", 1e-10),
                ("rosenbrock", "adjoint", 1e-10),
                ("cvodes", "forward", 1e-10),
                ("cvodes", "adjoint", 1e-10),
                ("cvodes", "adjoint", 3e-12),
            )
        }
        forward, adjoint = runs["rosenbrock", "forward", 1e-10], runs["rosenbrock", "adjoint", 1e-10]
        cvodes = max(_apart(runs["cvodes", method, 1e-10], row) for method in ("forward", "adjoint"))
        figures = (
            _apart(forward, row),
            _apart(adjoint, row),
            _apart(forward, adjoint or {}),
            cvodes,
            _apart(runs["cvodes", "adjoint", 3e-12], row),
        )
        shown = " | ".join(f"{value:.0e}" for value in figures)
        print(f"| {case.name} | {', '.join(case.kinds)} | {shown} |")  # noqa: T201 # as above


def _row(scene, engine, method, rtol, names):  # type: ignore[no-untyped-def]  # a script
    try:
        found = sensitivities(scene, [OF], names, method=method, engine=engine, rtol=rtol)
    except ComputationError:
        return None
    return dict(found.elasticity[OF])


def _apart(one, other):  # type: ignore[no-untyped-def]  # a script
    return float("nan") if one is None else apart(one, other)


if __name__ == "__main__":
    main()
