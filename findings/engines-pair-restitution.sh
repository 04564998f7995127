#!/usr/bin/env bash
# pymunk 7.3.1 (Chipmunk), rapier3d 0.36.1, Box2D 2.3.10 and pyb2d3 0.11.1 (Box2D 3): the restitution of a pair
#
# Guess: two balls of a material with restitution 0.5 rebound with 0.5; a ball of 0.9 on a ball of 0.5 gives the
#   same number in each rigid-body engine, somewhere between the two.
# What happens: the restitution is an attribute of a *body*, and each engine has a rule of its own for the pair.
#   Chipmunk multiplies (0.5 on 0.5 is 0.25), Rapier takes the mean, Box2D the greater. 0.9 on 0.5 is 0.45, 0.70 and
#   0.90.
# Why: impact restitution belongs to a pair of materials; engines that keep one number a body must invent the
#   pair's.
# Why it matters here: a wet restitution that was computed for the pair and is given to both bodies is right in
#   Box2D and Rapier and is squared in pymunk (give its square root there).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check \
    'pymunk==7.3.1' 'rapier3d==0.36.1' 'Box2D==2.3.10' 'pyb2d3==0.11.1' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import Box2D
import pyb2d3
import pymunk
import rapier3d

RADIUS, GAP, SPEED, STEP, STEPS = 1.0, 0.1, 2.0, 1e-3, 200  # the balls touch after 50 steps


def chipmunk(*restitutions):
    space, balls = pymunk.Space(), []
    for place, restitution in zip((0.0, 2 * RADIUS + GAP), restitutions):
        body = pymunk.Body(1.0, pymunk.moment_for_circle(1.0, 0, RADIUS))
        body.position = (place, 0)
        shape = pymunk.Circle(body, RADIUS)
        shape.elasticity = restitution
        space.add(body, shape)
        balls.append(body)
    balls[0].velocity = (SPEED, 0)
    for _ in range(STEPS):
        space.step(STEP)
    return (balls[1].velocity.x - balls[0].velocity.x) / SPEED


def rapier(*restitutions):
    world, balls = rapier3d.PhysicsWorld(gravity=(0, 0, 0)), []
    world.integration_parameters.dt = STEP
    for place, speed, restitution in zip((0.0, 2 * RADIUS + GAP), (SPEED, 0.0), restitutions):
        body = rapier3d.RigidBody.dynamic(translation=(place, 0, 0), linvel=(speed, 0, 0))
        ball = rapier3d.Collider.ball(RADIUS, restitution=restitution, friction=0.0)
        balls.append(world.add_body(body, colliders=[ball]))
    for _ in range(STEPS):
        world.step()
    first, second = (world.rigid_bodies[ball].linvel.x for ball in balls)
    return (second - first) / SPEED


def box2d(*restitutions):
    world, balls = Box2D.b2World(gravity=(0, 0)), []
    for place, restitution in zip((0.0, 2 * RADIUS + GAP), restitutions):
        disc = Box2D.b2FixtureDef(
            shape=Box2D.b2CircleShape(radius=RADIUS), density=1, restitution=restitution, friction=0
        )
        balls.append(world.CreateDynamicBody(position=(place, 0), fixtures=disc))
    balls[0].linearVelocity = (SPEED, 0)
    for _ in range(STEPS):
        world.Step(STEP, 20, 20)
    return (balls[1].linearVelocity[0] - balls[0].linearVelocity[0]) / SPEED


def box2d_3(*restitutions):
    world, balls = pyb2d3.World(gravity=(0, 0)), []
    for place, speed, restitution in zip((0.0, 2 * RADIUS + GAP), (SPEED, 0.0), restitutions):
        body = world.create_dynamic_body(position=(place, 0), linear_velocity=(speed, 0))
        material = pyb2d3.surface_material(restitution=restitution, friction=0)
        body.create_shape(pyb2d3.shape_def(density=1, material=material), pyb2d3.circle((0, 0), RADIUS))
        balls.append(body)
    for _ in range(STEPS):
        world.step(STEP, 4)
    return (balls[1].linear_velocity[0] - balls[0].linear_velocity[0]) / SPEED


engines = {
    f"pymunk {version('pymunk')}": (chipmunk, lambda a, b: a * b),
    f"rapier3d {version('rapier3d')}": (rapier, lambda a, b: (a + b) / 2),
    f"Box2D {version('Box2D')}": (box2d, max),
    f"pyb2d3 {version('pyb2d3')}": (box2d_3, max),
}
pairs = ((1.0, 1.0), (0.5, 0.5), (0.9, 0.5))
print("head-on at 2 m/s".ljust(18), *(f"{a} on {b}".rjust(11) for a, b in pairs))
for name, (engine, rule) in engines.items():
    reached = [engine(*pair) for pair in pairs]
    print(name.ljust(18), *(f"{value:11.4f}" for value in reached))
    for pair, value in zip(pairs, reached):
        assert abs(value - rule(*pair)) < 1e-4, f"changed: {name}, {pair}"
PY
