"""Films of the toolkit's own trajectories: two centres in pixels, with noise, drift of the pair and gravity."""

import math

import numpy as np
from wetdoublet.solvers import Collision, Scene

GRAVITY = np.array([0.0, -9.81])


def filmed(
    scene: Scene, one: Collision, rate: float, pixel: float, noise: float, random: np.random.Generator, frames: int = 25
) -> dict[str, np.ndarray]:
    """Positions of both centres at frames before, during and after a collision; `noise` in pixels, for each coordinate.

    The line of centres has a random direction and the collision a random sense; the first frame comes at a random time.
    """
    track = one.trajectory
    reach = 2 * scene.particles.reduced_radius * (1 + scene.radius_ratio)
    contact = float(track.time[-1])
    time = (np.arange(-frames, frames + math.ceil(contact * rate)) + random.random()) / rate
    polar = np.interp(time, track.time, track.rotation), reach + np.interp(time, track.time, track.gap)
    relative = np.stack([polar[1] * np.cos(polar[0]), polar[1] * np.sin(polar[0])], axis=1)
    start = reach + float(track.gap[0])
    tangential = start * float(track.rotation_rate[0])
    before, after = time < 0, time > contact
    relative[before] = np.array([start, 0.0]) + time[before, None] * np.array([-one.speed, tangential])
    if one.outcome != "stick":
        angle, end = one.rotation, reach + float(track.gap[-1])
        normal, along = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        velocity = one.restitution * one.speed * normal + end * one.final_rotation_rate * along
        relative[after] = end * normal + (time[after, None] - contact) * velocity
    turn, sense = random.uniform(0, 2 * math.pi), random.choice([-1.0, 1.0])
    axes = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn) * sense, math.cos(turn) * sense]])
    middle = random.normal(size=2) * one.speed * time[:, None] + GRAVITY * time[:, None] ** 2 / 2 + 5 * reach
    both = np.concatenate([middle - relative @ axes / 2, middle + relative @ axes / 2], axis=1) / pixel
    both += noise * random.standard_normal(both.shape)
    return {"frame": np.arange(time.size), **dict(zip(("x1", "y1", "x2", "y2"), both.T, strict=True))}
