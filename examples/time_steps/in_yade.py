"""Wet spheres in YADE by the exported force, beside the law over a map of speeds and angles.

    python in_yade.py "yade -n -x"      this Python has `wetdoublet`

`Forces` is what a script for YADE takes: `PyRunner(command="forces()", iterPeriod=1)` between ForceResetter and
NewtonIntegrator asks the law for every pair within reach, one after the other, and adds forces and torques.
Its histories are no part of YADE's world: `save` and `load` of Forces take the place of YADE's own.
"""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from beside import arrival, main
from law import Force, History, Law, Motion


class Forces:
    """The law as a force in YADE, of spheres of the law's own size."""

    def __init__(self, world: Any, law: Law) -> None:
        self.world, self.law = world, law
        self.ended: dict[tuple[int, int], Any] = {}
        self.pairs: dict[tuple[int, int], History] = {}

    def save(self, path: str) -> None:
        """Save the world as YADE does, and the contacts in a file beside it, with the step that they belong to."""
        self.world.save(path)
        contacts = [(*pair, bytes(history).hex()) for pair, history in self.pairs.items() if history.joined]
        Path(f"{path}.contacts").write_text(json.dumps({"step": self.world.iter, "contacts": contacts}))

    def load(self, path: str) -> None:
        """Load a world that was saved with its contacts; ValueError if they are those of another step."""
        contacts = json.loads(Path(f"{path}.contacts").read_text())
        self.world.load(path)
        if contacts["step"] != self.world.iter:
            raise ValueError(f"{path} is of step {self.world.iter}, its contacts are of step {contacts['step']}")
        rows = contacts["contacts"]
        self.pairs = {(first, other): History.from_buffer_copy(bytes.fromhex(words)) for first, other, words in rows}

    def __call__(self) -> None:
        """Positions of now, velocities of half a step before, as YADE has them here."""
        dt, motion, force, reach = self.world.dt, Motion(), Force(), self.law.contact_distance()
        states = {body.id: body.state for body in self.world.bodies}
        v = {k: np.array(state.vel) for k, state in states.items()}
        spin = {k: np.array(state.angVel) for k, state in states.items()}
        for other in sorted(states):
            for first in range(other):
                history = self.pairs.setdefault((first, other), History())
                apart, moving = np.array(states[other].pos - states[first].pos), v[other] - v[first]
                if not history.joined and np.linalg.norm(apart) > reach + dt * np.linalg.norm(moving):
                    continue
                motion.position[:], motion.velocity[:] = apart, moving
                motion.spins[0][:], motion.spins[1][:] = spin[first], spin[other]
                self.law.force(motion, dt, history, force)
                if force.outcome >= 0:
                    self.ended[first, other] = (force.outcome, force.restitution)
                for k, sign, turning in ((first, -1.0, force.torques[0]), (other, 1.0, force.torques[1])):
                    push, turn = sign * np.array(force.force), np.array(turning)
                    self.world.forces.addF(k, tuple(push))
                    self.world.forces.addT(k, tuple(turn))
                    v[k] += dt / states[k].mass * push
                    spin[k] += dt / states[k].inertia[0] * turn


def in_yade(job: dict[str, Any]) -> list[dict[str, Any]]:
    """The collisions of a job."""
    import builtins

    import yade
    from yade.utils import sphere
    from yade.wrapper import ForceResetter, FrictMat, NewtonIntegrator, PyRunner

    law, rows, world = Law(Path(job["folder"]), job["name"]), [], yade.Omega()
    radius, mass = 2 * law.material.reduced_radius, 2 * law.material.reduced_mass
    for speed, angle, dt in job["collisions"]:
        apart, v = arrival(law, speed, angle, dt)
        world.reset()
        world.materials.append(FrictMat(density=mass / (4 / 3 * np.pi * radius**3)))
        for place, velocity in ((0 * v, -0.5 * v), (apart, 0.5 * v)):
            ball = sphere(tuple(place), radius, material=world.materials[0])
            world.bodies.append(ball)
            ball.state.vel = tuple(velocity)
        vars(builtins)["forces"] = forces = Forces(world, law)
        runner = PyRunner(command="import builtins; builtins.forces()", iterPeriod=1)
        world.engines = [ForceResetter(), runner, NewtonIntegrator(damping=0)]
        world.dt = dt
        balls = [body.state for body in world.bodies]

        def sums(balls: Any = balls) -> np.ndarray:
            momentum = sum(body.mass * np.array(body.vel) for body in balls)
            turning = sum(body.inertia[0] * np.array(body.angVel) for body in balls)
            turning = turning + sum(body.mass * np.cross(body.pos, body.vel) for body in balls)
            return np.concatenate([momentum, turning])

        first = sums()
        for _ in range(job["steps"]):
            world.step()
            if forces.ended:
                break
        outcome, restitution = forces.ended.get((0, 1), (0, 0.0))
        off = np.abs(sums() - first) / (mass * np.linalg.norm(v) * np.repeat([1.0, 2 * radius], 3))
        rows.append({"outcome": outcome, "restitution": restitution, "off": float(off.max())})
    return rows


if __name__ == "__main__":
    sys.exit(main(in_yade, __file__))
