"""Forces for time steps beside the law's collisions: 2,000 random impacts at several steps, and the cost of a step.

    python -m tests.benchmarks.contact_forces     measures and prints (the table is in docs/how-to/forces.md)

The impacts are those of the tests: speeds over three decades, any direction, spins in any direction. A step is a part
of the contact time of each impact, and begins at a random phase. CPU time, in a loop in C.
"""

import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.solvers import Scene

from ..helpers.exported_law import Law, written
from ..helpers.host_of_forces import Host
from ..solvers.export.test_forces import durations
from ..solvers.export.test_law_in_space import OWN, arrivals
from .law_in_c import FLAGS
from .measured.digits import of_rows

COUNT, STEPS = 2000, (20, 100, 500)
SCENES = {"granulation": Scene.load("granulation"), "unequal": OWN, "film alone": Scene.load("granulation-dry-bridge")}


def measured(name: str, scene: Scene, folder: Path) -> list[dict[str, Any]]:
    """A row for each step of a scene."""
    written(scene, folder)
    law = Law(scene, folder, *FLAGS)
    host, pairs = Host(scene, law, folder, *FLAGS), arrivals(scene, COUNT, seed=3)
    found, times = durations(scene, law, pairs)
    rows = []
    for steps in STEPS:
        start = time.process_time()
        flown = host.fly(pairs, times / steps, 8 * steps)
        spent = time.process_time() - start
        row: dict[str, Any] = {"scene": name, "steps": steps}
        row["other"] = int(np.count_nonzero(flown["outcome"] != found["outcome"]))
        for outcome, word in ((2, "bounce"), (1, "separate")):
            chosen = (found["outcome"] == outcome) & (flown["outcome"] > 0)
            errors = np.abs(flown["restitution"] - found["restitution"])[chosen]
            for key, part in (("median", 0.5), ("99 %", 0.99), ("largest", 1.0)):
                row[f"{word} {key}"] = float(np.quantile(errors, part))
        row["angular_momentum"] = float(flown["angular_momentum"].max())
        row["ns"] = spent / float(flown["steps"].sum()) * 1e9
        rows.append(row)
    return rows


def section(measurements: list[dict[str, Any]]) -> str:
    """The table."""
    rows = []
    for row in measurements:
        cells = {"2,000 random impacts": row["scene"], "step over contact time": f"1/{row['steps']}"}
        cells |= {"other outcomes": str(row["other"])}
        for word, said in (("bounce", "bounces"), ("separate", "stick-rotate-separate")):
            cells |= {f"error of e_n, {said}: {key}": row[f"{word} {key}"] for key in ("median", "99 %", "largest")}
        rows.append({**cells, "CPU ns a step": row["ns"]})
    said = (
        "The law as a force over the steps of a host beside its collisions; absolute errors. The angular momentum is "
        f"kept to {max(row['angular_momentum'] for row in measurements):.0e} of its size."
    )
    return "\n\n".join([of_rows(rows), said])


def main() -> None:
    """Measure all scenes."""
    rows = []
    for name, scene in SCENES.items():
        with tempfile.TemporaryDirectory() as folder:
            rows += measured(name, scene, Path(folder))
    sys.stdout.write(section(rows) + "\n")


if __name__ == "__main__":
    main()
