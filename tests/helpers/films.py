"""Films of the toolkit's own trajectories: two centres in pixels, with noise, drift of the pair and gravity."""

import math
import warnings
from typing import Any

import numpy as np
import pandas as pd
from wetdoublet.solvers import Collision, Scene, collide, tracks

PLACES = ("x1", "y1", "x2", "y2")
RATE, PIXEL = 1.5e5, 2e-6
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


def bounce(rate: float = RATE, seed: int = 1) -> dict[str, np.ndarray]:
    """A bounce of 0.818 m/s on `lactose-pvp` that moves by 4.2 px per frame at the usual rate, tracked to 0.2 px."""
    scene = Scene.load("lactose-pvp")
    one = collide(scene, stokes=12, angle=math.radians(40), trajectory=True)
    return filmed(scene, one, rate, PIXEL, 0.2, np.random.default_rng(seed), frames=round(25 * rate / RATE))


def read(source: object, **settings: object) -> Any:
    """What its film is read as."""
    return tracks(source, "lactose-pvp", **{"rate": RATE, "scale": PIXEL} | settings)


def drawn(scene: Scene, random: np.random.Generator, *, stick: bool, noise: float | None = None) -> dict[str, object]:
    """A film of two discs that meet, of random rate, size, noise, speeds, rotation and length; no law is solved.

    Returns:
        `film` in pixels; `rate`, `scale`; `speed`, `angle`, `restitution` as they were drawn; `step`, the motion of the
        approach per frame over the noise; `contact`, the frames that are neither before nor after it.
    """
    solids = 2 * scene.particles.reduced_radius * (1 + scene.radius_ratio)
    touch, apart = solids + scene.liquid.film_thickness, solids + scene.rupture_gap
    size, per_diameter = math.exp(random.uniform(*np.log([12, 300]))), math.exp(random.uniform(*np.log([8, 80])))
    pixel, rate, angle = solids / size, 10 ** random.uniform(2, 5.5), random.uniform(0, 1.2)
    speed = rate * solids / per_diameter * math.cos(angle)  # normal
    noise = noise if noise is not None else math.exp(random.uniform(*np.log([0.02, 0.5])))
    frames = [int(each) for each in random.integers(0.5 * per_diameter + 6, 2 * per_diameter + 12, 2)]
    contact = random.uniform(0.3, 1.5) * solids / speed
    time = (np.arange(-frames[0], frames[1] + math.ceil(contact * rate)) + random.random()) / rate
    sideways, e_n, e_t = speed * math.tan(angle) * touch / solids, random.uniform(0.1, 1.3), random.uniform(0.5, 1)
    turn = random.uniform(0.2, 1.2) * contact * sideways / touch
    share = np.clip(time / contact, 0, 1)
    deep = touch - 0.7 * scene.liquid.film_thickness * np.sin(np.pi * np.minimum(share, 0.5))
    polar = turn * share, deep if stick else np.maximum(deep, touch + (apart - touch) * (2 * share - 1))
    relative = np.stack([polar[1] * np.cos(polar[0]), polar[1] * np.sin(polar[0])], axis=1)
    before, after = time < 0, time > contact
    relative[before] = [touch, 0] + time[before, None] * np.array([-speed, sideways])
    if not stick:
        normal, along = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
        velocity = e_n * speed * normal + e_t * sideways * along
        relative[after] = apart * normal + (time[after, None] - contact) * velocity
    direction, drift = random.uniform(0, 2 * math.pi), random.normal(size=2) * speed * time[:, None]
    axes = np.array([[math.cos(direction), math.sin(direction)], [-math.sin(direction), math.cos(direction)]])
    middle = drift + GRAVITY * time[:, None] ** 2 / 2
    both = np.concatenate([middle - relative @ axes / 2, middle + relative @ axes / 2], axis=1) / pixel
    both += noise * random.standard_normal(both.shape)
    film = {"frame": np.arange(time.size), **dict(zip(("x1", "y1", "x2", "y2"), both.T, strict=True))}
    step = speed / math.cos(angle) / rate / pixel / (math.sqrt(2) * noise)
    return {
        "film": film, "rate": rate, "scale": pixel, "speed": speed, "angle": angle, "step": step,
        "restitution": 0.0 if stick else e_n, "contact": np.flatnonzero(~before & ~after),
    }  # fmt: skip


def long_table(film: dict[str, np.ndarray]) -> pd.DataFrame:
    """The film with a row for each particle, 0 and 1, and frame."""
    parts = [
        pd.DataFrame(
            {"y": film[f"y{k + 1}"], "x": film[f"x{k + 1}"], "frame": film["frame"].astype(float), "particle": k}
        )
        for k in (0, 1)
    ]
    return pd.concat(parts).sort_values(["frame", "particle"], ignore_index=True)


def lossy(film: dict[str, np.ndarray], lost: object) -> dict[str, np.ndarray]:
    """The film without some frames, whose numbers are not counted."""
    rest = {name: np.delete(values, lost) for name, values in film.items()}
    return rest | {"frame": np.arange(rest["frame"].size)}


def pushed(
    film: dict[str, np.ndarray], diameter: float, most: float = 3.5 / 24, reach: float = 0.4
) -> dict[str, np.ndarray]:
    """The film of a tracker that pushes near discs apart, as the preprocessing of trackpy does.

    Arguments:
        diameter: px.
        most: displacement of the distance at contact, over the diameter.
        reach: gap from which there is none, over the diameter.
    """
    relative = np.stack([film["x2"] - film["x1"], film["y2"] - film["y1"]])
    distance = np.hypot(*relative)
    far = np.clip(1 - (distance / diameter - 1) / reach, 0, 1)
    x, y = most * diameter * far**1.4 * relative / distance / 2
    return film | {"x1": film["x1"] - x, "y1": film["y1"] - y, "x2": film["x2"] + x, "y2": film["y2"] + y}


def rendered(film: dict[str, np.ndarray], radius: float, random: np.random.Generator, grey: float = 8.0) -> np.ndarray:
    """Pictures (frames, height, width) of two bright discs on a dark ground, in 256 greys with a noise of `grey`."""
    places = np.stack([[film["x1"], film["y1"]], [film["x2"], film["y2"]]])
    places = places - places.min(axis=(0, 2))[:, None] + 3 * radius
    width, height = np.ceil(places.max(axis=(0, 2)) + 3 * radius).astype(int)
    y, x = np.mgrid[:height, :width]
    pictures = np.empty((places.shape[2], height, width), np.uint8)
    for k, (one, two) in enumerate(places.transpose(2, 0, 1)):
        discs = [np.clip(radius + 0.5 - np.hypot(x - place[0], y - place[1]), 0, 1) for place in (one, two)]
        noisy = 20 + 180 * np.minimum(sum(discs), 1) + grey * random.standard_normal((height, width))
        pictures[k] = np.clip(np.rint(noisy), 0, 255)
    return pictures


def tracked(
    pictures: np.ndarray, mask: int, ground: int = 60, reach: float = 10, memory: int = 3, **settings: object
) -> pd.DataFrame:
    """What trackpy makes of pictures.

    Arguments:
        mask: its `diameter`.
        ground: grey that is subtracted first.
        reach: its `search_range`.
    """
    import trackpy

    trackpy.quiet()
    dark = np.maximum(pictures.astype(int) - ground, 0).astype(np.uint8)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of an empty picture, and of what pandas will do without
        found = [trackpy.locate(one, mask, **settings).assign(frame=k) for k, one in enumerate(dark)]
        return trackpy.link(pd.concat(found), reach, memory=memory)
