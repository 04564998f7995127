"""Test vectors of an exported law in space: pairs, and what `collide_pair` says of them."""

from __future__ import annotations

import numpy as np

from ...errors import ComputationError
from ...scene.scene import Scene
from ...space.collide_pair import collide_pair
from ...space.pairs import Bodies
from .space import AFTER, PAIR

_CANDIDATES, _WANTED = 96, 12
_SEED = 17


def pair_table(scene: Scene, rtol: float, tolerance: float) -> list[str]:
    """Lines of vectors.h: pairs of all outcomes that occur, away from boundaries, one in four of them in a plane."""
    given = _pairs(scene)
    normal, velocities, spins = given["normal"], given["velocities"], given["spins"][:, : 1 if scene.wall else 2]
    found, other = (
        collide_pair(scene, normal, velocities, spins, rtol=each, engine="taylor") for each in (rtol, rtol / 3)
    )
    rows = {name: found[name].values for name in found.data_vars}
    sound = (rows["outcome"] == other.outcome.values) & (rows["outcome"] >= 0)
    for name in ("time", "restitution", "velocities", "spins"):
        one, two = (np.nan_to_num(each[name].values.reshape(_CANDIDATES, -1)) for each in (found, other))
        sound &= np.abs(one - two).max(axis=1) <= 0.1 * tolerance * np.abs(one).max(axis=1)
    chosen = [k for outcome in range(3) for k in np.flatnonzero(sound & (rows["outcome"] == outcome))[:_WANTED]]
    if not chosen:
        raise ComputationError("no pair in space could be computed for the test vectors")
    lines = ["static const struct {", "    law_pair pair;", "    law_pair_after expected;", "} pair_vectors[] = {"]
    for k in chosen:
        before = ", ".join(_braced(given[name][k]) for _, name, _, _ in PAIR)
        numbers = {"status": 0} | {name: values[k] for name, values in rows.items()}
        after = ", ".join(
            str(int(numbers[name])) if kind == "int" else _braced(np.asarray(numbers[name], float))
            for kind, name, _, _ in AFTER
        )
        lines.append(f"    {{{{{before}}},\n     {{{after}}}}},")
    return [*lines, "};", ""]


def _pairs(scene: Scene) -> dict[str, np.ndarray]:
    draw = np.random.default_rng(_SEED)
    normal = _directions(draw, (_CANDIDATES,))
    speed = 10 ** draw.uniform(-1.5, 1.5, _CANDIDATES)[:, None] / scene.stokes_per_speed
    radius = float(scene.material["reduced_radius"]) if scene.wall else min(Bodies.of(scene).radius)
    drift = speed * draw.normal(size=(_CANDIDATES, 3))
    across = np.cross(normal, _directions(draw, (_CANDIDATES,)))
    relative = speed * (draw.uniform(0, 3, (_CANDIDATES, 1)) * across - normal)
    spins = speed[:, None] / radius * draw.uniform(0, 1, (_CANDIDATES, 2, 1)) * _directions(draw, (_CANDIDATES, 2))
    planar = np.arange(_CANDIDATES) % 4 == 0
    axis = np.cross(normal, across)[:, None]
    spins[planar] = np.sum(spins * axis, axis=-1, keepdims=True)[planar] * axis[planar]
    if scene.wall:
        spins[:, 1] = 0.0
    return {"normal": normal, "velocities": np.stack([drift, drift + relative], axis=1), "spins": spins}


def _directions(draw: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    found = draw.normal(size=(*shape, 3))
    return np.asarray(found / np.linalg.norm(found, axis=-1, keepdims=True))


def _braced(numbers: np.ndarray) -> str:
    """Numbers of any shape as C's initialisers."""
    if numbers.ndim == 0:
        return "NAN" if np.isnan(numbers) else repr(float(numbers))
    return f"{{{', '.join(_braced(np.asarray(each)) for each in numbers)}}}"
