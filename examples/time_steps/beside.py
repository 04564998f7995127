"""A host's collisions of two spheres beside the law over a map of speeds and angles, at 1/20 of the contact time.

The host runs in a Python of its own, which finds its job by FORCES_JOB and needs numpy alone.
"""

import json
import os
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from law import Law, exported

STOKES, ANGLES, STEPS = (0.08, 0.15, 0.3, 0.6, 1.2), (0.0, 20.0, 40.0, 55.0, 70.0), 20
Host = Callable[[dict[str, Any]], list[dict[str, Any]]]


def arrival(law: Law, speed: float, angle: float, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """Position and velocity of the second sphere relative to the first, 3.3 steps before initial contact."""
    centres = 4 * law.material.reduced_radius
    # the angle is by the turning of the line of centres: tangential velocity over R1 + R2 + x0, times R1 + R2
    v = speed * np.array([-1.0, np.tan(angle) * law.contact_distance() / centres, 0.0])
    return np.array([law.contact_distance(), 0.0, 0.0]) - 3.3 * dt * v, v


def main(host: Host, script: str) -> int:
    """In the host's Python its job; else export, collide by the law, run the host, compare."""
    if "FORCES_JOB" in os.environ:
        path = Path(os.environ["FORCES_JOB"])
        path.with_suffix(".out").write_text(json.dumps(host(json.loads(path.read_text()))))
        return 0
    from wetdoublet.solvers import Scene, collide

    scene, collisions, expected = Scene.load("granulation"), [], []
    for stokes in STOKES:
        for degrees in ANGLES:
            speed, angle = stokes / scene.stokes_per_speed, float(np.radians(degrees))
            result = collide(scene, speed=speed, angle=angle)
            film = float(scene.material["film_thickness"])
            time = 10 * film / speed if result.contact_time is None else result.contact_time
            collisions.append([speed, angle, time / STEPS])
            expected.append(result)
    with tempfile.TemporaryDirectory() as folder:
        exported(scene, Path(folder))
        job = Path(folder) / "job.json"
        given = {"folder": folder, "name": "granulation", "collisions": collisions, "steps": 60 * STEPS}
        job.write_text(json.dumps(given))
        environment = {**os.environ, "FORCES_JOB": str(job), "PYTHONPATH": str(Path(__file__).parent)}
        command = [*shlex.split(sys.argv[1]), script]
        subprocess.run(command, check=True, env=environment)
        rows = json.loads(job.with_suffix(".out").read_text())
    words = ("stick", "stick-rotate-separate", "bounce")
    print(f"{'St':>6} {'angle':>6}  {'law':24} {'host':24} difference of e_n")
    apart = [abs(collision.restitution - row["restitution"]) for collision, row in zip(expected, rows, strict=True)]
    places = [(stokes, degrees) for stokes in STOKES for degrees in ANGLES]
    for (stokes, degrees), collision, row, off in zip(places, expected, rows, apart, strict=True):
        print(f"{stokes:6g} {degrees:6g}  {collision.outcome:24} {words[row['outcome']]:24} {off:.1e}")
    print(f"largest difference {max(apart):.1e}; momenta off by {max(row['off'] for row in rows):.0e} of their size")
    return int(any(words[row["outcome"]] != collision.outcome for row, collision in zip(rows, expected, strict=True)))
