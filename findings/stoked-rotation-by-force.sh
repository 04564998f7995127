#!/usr/bin/env bash
# stoked 1.0.0: how a force on one sphere turns another
#
# Guess: the neighbour of a dragged sphere turns with the liquid, at half the vorticity of the dragged one's flow,
#   F x r / (8 pi mu r^3): of two spheres that settle side by side the inner sides go down.
# What happens: every such rotation has the sign reversed: the outer sides go down. What the same two spheres do to each
#   other's velocity, by forces and by torques, and to each other's rotation by torques is right.
# Why: in the matrix of mobilities the block from forces to rotations is the transpose of that from torques to
#   velocities. Here they differ in sign as well, and the matrix is not symmetric.
# Why it matters here: which way spheres of a pair turn in the liquid decides which sides meet, and is what a tracked
#   mark on them is compared with. No positions betray it: only orientations are wrong.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'stoked==1.0.0' 'numpy==2.4.6' 'scipy==1.17.1' \
    'matplotlib==3.11.2' 'numpy-quaternion==2024.0.13'
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from stoked import drag_sphere, stokesian_dynamics

RADIUS, VISCOSITY, FORCE = 1e-6, 1e-3, np.array([0.0, 0.0, -1e-14])  # m, Pa s, N: one sphere is pulled down
TORQUE = RADIUS * np.array([0.0, 1e-14, 0.0])


def motion(distance, forces, torques):
    """Velocities and angular velocities of spheres at the origin and at `distance` on the x axis."""
    spheres = stokesian_dynamics(
        temperature=0,
        dt=1e-9,
        position=[[0, 0, 0], [distance, 0, 0]],
        drag=drag_sphere(RADIUS, VISCOSITY),
        force=lambda time, position, orientation: np.array(forces, dtype=float),
        torque=lambda time, position, orientation: np.array(torques, dtype=float),
    )
    spheres.step()
    return spheres.velocity, spheres.angular_velocity


print("stoked", version("stoked"))
print("of the second sphere, / theory:")
print("distance / radius   velocity by force   rotation by force   velocity by torque   rotation by torque")
none = np.zeros(3)
for ratio in (3, 5, 10, 30):
    r = np.array([ratio * RADIUS, 0, 0])
    kernel = 1 / (8 * np.pi * VISCOSITY * (ratio * RADIUS) ** 3)  # of point forces and torques
    velocity, rotation = motion(r[0], [FORCE, none], [none, none])
    by_force = velocity[1, 2] / (kernel * r[0] ** 2 * FORCE[2]), rotation[1, 1] / (kernel * np.cross(FORCE, r)[1])
    velocity, rotation = motion(r[0], [none, none], [TORQUE, none])
    by_torque = velocity[1, 2] / (kernel * np.cross(TORQUE, r)[2]), rotation[1, 1] / (-kernel / 2 * TORQUE[1])
    print(f"{ratio:17d} {by_force[0]:19.4f} {by_force[1]:19.4f} {by_torque[0]:20.4f} {by_torque[1]:20.4f}")
    assert np.allclose((by_force[0], *by_torque), 1), "changed: what is right"
    assert np.isclose(by_force[1], -1), "changed: rotation by a force"

_, rotation = motion(5 * RADIUS, [FORCE, FORCE], [none, none])
print("settling side by side: angular velocities about y of the left and right sphere", rotation[:, 1], "rad/s")
assert rotation[1, 1] > 0 > rotation[0, 1], "changed: settling pair"  # the right one's outer side, at +x, moves to -z
PY
