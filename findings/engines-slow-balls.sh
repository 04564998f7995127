#!/usr/bin/env bash
# Box2D 2.3.10, pyb2d3 0.11.1 (Box2D 3) and rapier3d 0.36.1: slow balls neither rebound nor fly on
#
# Guess: without gravity and friction a ball flies on at its speed, and restitution 0.9 is 0.9 at every speed.
# What happens: in both Box2D a closing speed up to 1 m/s ends in a perfectly inelastic impact, whatever the
#   restitution. And a ball in free flight stops for good half a second later if it is slow: below 0.01 m/s (Box2D
#   2), 0.05 m/s (Box2D 3); in Rapier a ball of 0.02 m/s stops so too and never reaches its partner. Momentum is
#   gone, and nothing says so.
# Why: engines for games let slow bodies "sleep", and drop small rebounds so that piles come to rest. The limits are
#   lengths and times of a game: metres and seconds. `can_sleep=False` (Rapier), `allowSleep`/`enable_sleep` and the
#   threshold of the world turn it off.
# Why it matters here: oblique impacts of coated grains are studied at 0.01 to 1 m/s, exactly below these limits:
#   what looks like a stick is the engine's.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check \
    'rapier3d==0.36.1' 'Box2D==2.3.10' 'pyb2d3==0.11.1' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import Box2D
import pyb2d3
import rapier3d

RADIUS, STEP = 0.5, 0.01
PLACES = (0.0, 2 * RADIUS + 0.1)


def box2d(speed, seconds, places=PLACES):
    world, balls = Box2D.b2World(gravity=(0, 0)), []
    for place in places:
        disc = Box2D.b2FixtureDef(shape=Box2D.b2CircleShape(radius=RADIUS), density=1, restitution=0.9, friction=0)
        balls.append(world.CreateDynamicBody(position=(place, 0), fixtures=disc))
    balls[0].linearVelocity = (speed, 0)
    for _ in range(round(seconds / STEP)):
        world.Step(STEP, 20, 20)
    return [ball.linearVelocity[0] for ball in balls]


def box2d_3(speed, seconds, places=PLACES):
    world, balls = pyb2d3.World(gravity=(0, 0)), []
    for place in places:
        body = world.create_dynamic_body(position=(place, 0), linear_velocity=(0.0 if balls else speed, 0))
        material = pyb2d3.surface_material(restitution=0.9, friction=0)
        body.create_shape(pyb2d3.shape_def(density=1, material=material), pyb2d3.circle((0, 0), RADIUS))
        balls.append(body)
    for _ in range(round(seconds / STEP)):
        world.step(STEP, 4)
    return [ball.linear_velocity[0] for ball in balls]


def rapier(speed, seconds, places=PLACES, can_sleep=True):
    world, balls = rapier3d.PhysicsWorld(gravity=(0, 0, 0)), []
    world.integration_parameters.dt = STEP
    for place in places:
        velocity = (0.0 if balls else speed, 0, 0)
        body = rapier3d.RigidBody.dynamic(translation=(place, 0, 0), linvel=velocity, can_sleep=can_sleep)
        ball = rapier3d.Collider.ball(RADIUS, restitution=0.9, friction=0.0)
        balls.append(world.add_body(body, colliders=[ball]))
    for _ in range(round(seconds / STEP)):
        world.step()
    return [world.rigid_bodies[ball].linvel.x for ball in balls]


def restitution(engine, speed, seconds, **options):
    first, second = engine(speed, seconds, **options)
    return (second - first) / speed


print("restitution reached, 0.9 given to both balls")
for name, engine in (("Box2D", box2d), ("pyb2d3", box2d_3)):
    slow, fast = restitution(engine, 0.9, 0.3), restitution(engine, 1.1, 0.3)
    print(f"  {name} {version(name)}: {slow:.3f} at 0.9 m/s, {fast:.3f} at 1.1 m/s")
    assert abs(slow) < 1e-4 and abs(fast - 0.9) < 1e-4, f"changed: rebound of {name}"
asleep, awake = restitution(rapier, 0.02, 8.0), restitution(rapier, 0.02, 8.0, can_sleep=False)
print(f"  rapier3d {version('rapier3d')}: {asleep:.3f} at 0.02 m/s, {awake:.3f} with can_sleep=False")
assert asleep == 0 and abs(awake - 0.9) < 1e-4, "changed: rebound of rapier3d"

print("speed of a ball alone, one second later")
for name, engine, speed in (("Box2D", box2d, 0.009), ("pyb2d3", box2d_3, 0.04), ("rapier3d", rapier, 0.02)):
    (later,) = engine(speed, 1.0, places=(0.0,))
    (faster,) = engine(50 * speed, 1.0, places=(0.0,))
    print(f"  {name}: {speed} m/s becomes {later:.3g} m/s, {50 * speed:.3g} m/s becomes {faster:.3g} m/s")
    assert later == 0 and abs(faster - 50 * speed) < 1e-4, f"changed: free flight of {name}"
PY
