"""Elasticities of the twelve collisions of `tests/helpers/sensitive.py` by extrapolated differences, as a data file.

python -m tests.benchmarks.sensitivity_reference > tests/data/sensitivities.json     (some three minutes)

Central differences of collisions at rtol 1e-13 with steps of 0.4, 0.2 and 0.1 %, extrapolated twice: nothing of the
code that differentiates takes part. Parameters that are zero, and quantities that are, have no elasticity.
"""

import json
import math
import sys

from wetdoublet.solvers import collide

from ..helpers.sensitive import CASES, differences

OF = ("restitution", "rotation", "contact_time", "smallest_gap", "final_spin", "final_rotation_rate")


def main() -> None:
    """Compute and print."""
    found = {}
    for case in CASES:
        one = collide(case.scene, rtol=1e-13, engine="rosenbrock", ledger=False)
        values = [getattr(one, name) for name in OF]
        names = tuple(
            name
            for name, value in case.scene.entries.items()
            if isinstance(value, float) and value and not name.startswith("impact.")
        )
        names += ("impact.speed", "impact.angle") if one.angle else ("impact.speed",)
        slopes = differences(case.scene, OF, names)
        found[case.name] = {
            of: {name: float(slopes[name][k] / values[k]) for name in names}
            for k, of in enumerate(OF)
            if values[k] and math.isfinite(values[k])
        }
        sys.stderr.write(f"{case.name}\n")
    print(json.dumps(found, indent=1))  # noqa: T201 # what a script is for


if __name__ == "__main__":
    main()
