"""Wet spheres in LAMMPS by the compiled pair style, beside the law over a map of speeds and angles.

    python plugin_in_lammps.py LAMMPS_PYTHON    a Python that has `lammps` and numpy; this one has `wetdoublet`

Each collision is stopped in the middle, written to a restart file and read again by another LAMMPS.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from beside import arrival, main
from law import Law
from plugin import built, started


def style(law: Law, dt: float) -> str:
    """The pair style and the integrator; bridges of these scenes hold to less than a radius."""
    return f"""
pair_style wet/{law.name} {2 * law.material.reduced_radius!r}
pair_coeff * *
comm_modify vel yes
fix moves all nve/sphere
timestep {dt!r}
compute wet all pair wet/{law.name}
thermo_style custom step c_wet[1] c_wet[2] c_wet[3] c_wet[4]
thermo 20
"""


def two_spheres(law: Law, position: np.ndarray, velocity: np.ndarray) -> str:
    """Two spheres in a box, with a relative position and velocity."""
    radius, mass = 2 * law.material.reduced_radius, 2 * law.material.reduced_mass
    words = [" ".join(map(repr, vector.tolist())) for vector in (position, -0.5 * velocity, 0.5 * velocity)]
    return f"""
boundary f f f
region all block {" ".join([f"{-50 * radius} {50 * radius}"] * 3)}
neighbor {radius!r} bin
create_box 1 all
create_atoms 1 single 0 0 0
create_atoms 1 single {words[0]}
set type 1 diameter {2 * radius!r} density {mass / (4 / 3 * np.pi * radius**3)!r}
group one id 1
group two id 2
velocity one set {words[1]}
velocity two set {words[2]}
"""


def state(host: Any) -> np.ndarray:
    """Positions, velocities and spins, by the order of the tags."""
    get = host.numpy.extract_atom
    order = np.argsort(get("id")[:2])
    return np.concatenate([get(name)[:2][order] for name in ("x", "v", "omega")], axis=1)


def collided(host: Any, steps: int) -> dict[str, Any]:
    """Run to the separation, for so many steps at most."""
    for _ in range(0, steps, 20):
        host.command("run 20 post no")
        contacts, separated, bounced, restitution = host.numpy.extract_compute("wet", 0, 1)[:4]
        if separated + bounced:
            return {"outcome": 2 if bounced else 1, "restitution": float(restitution)}
    return {"outcome": 0 if contacts else -1, "restitution": 0.0}


def in_lammps(job: dict[str, Any]) -> list[dict[str, Any]]:
    """The collisions of a job, each in a LAMMPS of its own, and again from a restart file."""
    folder, rows = Path(job["folder"]), []
    law, plugin = Law(folder, job["name"]), built(folder, job["name"])
    radius, mass = 2 * law.material.reduced_radius, 2 * law.material.reduced_mass

    def sums(host: Any) -> np.ndarray:
        x, v, spin = np.split(state(host), 3, axis=1)
        turning = 0.4 * mass * radius**2 * spin + mass * np.cross(x, v)
        return np.concatenate([mass * v.sum(axis=0), turning.sum(axis=0)])

    for speed, angle, dt in job["collisions"]:
        position, velocity = arrival(law, speed, angle, dt)
        host = started(plugin, two_spheres(law, position, velocity) + style(law, dt))
        first = sums(host)
        host.commands_string(f"run 10\nwrite_restart {folder / 'middle'}")
        row = collided(host, job["steps"])
        off = np.abs(sums(host) - first) / (mass * np.linalg.norm(velocity) * np.repeat([1.0, 2 * radius], 3))
        other = started(plugin, f"read_restart {folder / 'middle'}\n" + style(law, dt))
        if collided(other, job["steps"]) != row or np.any(state(other) != state(host)):
            raise RuntimeError("the collision from the restart file is another")
        rows.append({**row, "off": float(off.max())})
        host.close()
        other.close()
    return rows


if __name__ == "__main__":
    sys.exit(main(in_lammps, __file__))
