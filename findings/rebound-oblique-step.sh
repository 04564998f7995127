#!/usr/bin/env bash
# rebound 5.2.2: oblique impacts of hard spheres that are found by `collision = "line"`
#
# Guess: with "line", which checks the paths within a step and not only the places at its end, an oblique rebound
#   does not depend on the step; "direct" is the cheap way that needs small ones.
# What happens: both give the same velocities, to the last digit, and these depend on the step. Here the struck
#   sphere should leave at -36.9 degrees; with steps of 0.37, 0.9 and 2.9 diameters of flight it leaves at -49, -72
#   and not at all. The last step carries the spheres through each other: "line" finds that (a resolver of one's own
#   is called), and the built-in "hardsphere" resolver does nothing.
# Why: the resolver takes the line of centres from the places at the *end* of the step, where the spheres overlap,
#   and returns if they separate there.
# Why it matters here: the direction behind an oblique impact, and what is lost in a gas of them, is the step's. Take
#   steps of a hundredth of a diameter and less (0.3 degrees here), whichever search is used.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'rebound==5.2.2' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math

import rebound

DIAMETER, RESTITUTION, OFFSET = 1.0, 0.5, 0.6


def struck(search, step, resolver="hardsphere"):
    """Velocity of a resting sphere after another came along x at unit speed, off centre."""
    simulation = rebound.Simulation()
    simulation.G = 0.0
    simulation.integrator, simulation.dt = "leapfrog", step
    simulation.collision, simulation.collision_resolve = search, resolver
    simulation.coefficient_of_restitution = lambda simulation, speed: RESTITUTION
    simulation.add(m=1.0, r=DIAMETER / 2)
    simulation.add(m=1.0, r=DIAMETER / 2, x=-2.0, y=OFFSET, vx=1.0)
    simulation.integrate(3.0)
    return simulation.particles[0].vx, simulation.particles[0].vy


def degrees(velocity):
    return math.degrees(math.atan2(velocity[1], velocity[0]))


along = math.sqrt(1 - OFFSET**2)  # cosine of the angle between the velocity and the line of centres
impulse = (1 + RESTITUTION) * along / 2
exact = impulse * along, -impulse * OFFSET
print("rebound", rebound.__version__)
print(f"struck sphere, exact:    velocity {exact[0]:8.5f} {exact[1]:8.5f}, {degrees(exact):6.1f} degrees")
reached = {}
for search in ("direct", "line"):
    for step in (0.01, 0.37, 0.9, 2.9):
        reached[search, step] = struck(search, step)
        x, y = reached[search, step]
        print(f"{search:6s} step {step:4g} diameters: velocity {x:8.5f} {y:8.5f}, {degrees((x, y)):6.1f} degrees")
passages = []


def note(simulation, collision):
    passages.append(simulation.contents.t)
    return 0


struck("line", 2.9, resolver=note)
print(f'a resolver of one\'s own is called by "line" with the step of 2.9: {bool(passages)}')
for step in (0.01, 0.37, 0.9, 2.9):
    assert math.dist(reached["line", step], reached["direct", step]) < 1e-6, "changed: the two searches differ"
for step, low, high in ((0.01, -37.4, -37.0), (0.37, -50, -48), (0.9, -72, -71)):
    assert low < degrees(reached["line", step]) < high, f"changed: step {step}"
assert reached["line", 2.9] == (0, 0) and passages, "changed: the passage"
PY
