"""Budgets of e_n^2 - 1 (`collision/budget.py`) over angles and Stokes numbers, and the ceiling of e_n^2.

Here the energy of rotation is that of the rates at separation of equal spheres, so that the sum is a check.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...generated.automaton import OUTCOMES
from ..collision.collide import collide
from ..collision.result import Collision
from ..errors import WetDoubletError
from ..scene.origin import provenance
from ..scene.scene import Scene
from .sample import Collide

if TYPE_CHECKING:
    import xarray

LOSSES = {
    "normal_lubrication": "normal lubrication",
    "tangential_lubrication": "tangential lubrication",
    "capillary": "capillary work",
    "dry_contact": "dry contact",
    "strings": "strings",
}
TERMS = ("rotation_released", *LOSSES)


def restitution_budget(
    scene: Scene | str, *, stokes: Sequence[float], angle: Sequence[float], rtol: float = 1e-9
) -> xarray.Dataset:
    """The terms of e_n^2 - 1 over impact angle and Stokes number.

    Arguments:
        stokes: Stokes numbers.
        angle: impact angles, rad.

    Returns:
        Dataset over (angle, stokes): `outcome` (as in `collide_many`), `restitution`, `excess` = e_n^2 - 1, its terms
        `rotation_released` (from the rates at separation), `normal_lubrication`, `tangential_lubrication`,
        `capillary`, `dry_contact`, `strings` (losses, which are subtracted), `residual` (the ledger's, subtracted as
        well), `gap` (excess less all of them: rounding), `ceiling` (of e_n^2; midgap arm without
        strings). All are 2 E/(m v0^2); NaN for sticks and for what failed (`reason`).

    Raises:
        InputError: scene, angles or Stokes numbers are not acceptable.

    >>> budget = restitution_budget("granulation", stokes=[0.02], angle=[1.3])
    >>> bool(budget["excess"] > 0)
    True
    """
    return budgeted(Scene.load(scene), stokes, angle, rtol)


def budgeted(
    scene: Scene, stokes: Sequence[float], angle: Sequence[float], rtol: float, collide: Collide = collide
) -> xarray.Dataset:
    """The budget over impact angle (rad) and Stokes number, of collisions computed by `collide`."""
    import xarray as xr

    shape = (len(angle), len(stokes))
    names = ("restitution", "excess", *TERMS, "residual", "gap", "ceiling")
    values = {name: np.full(shape, np.nan) for name in names}
    outcome, reason = np.full(shape, -1, dtype=np.int8), np.full(shape, "", dtype=object)
    for j, theta in enumerate(angle):
        for k, number in enumerate(stokes):
            try:
                collision = collide(scene, stokes=float(number), angle=float(theta), rtol=rtol)
            except WetDoubletError as failure:
                reason[j, k] = str(failure)
                continue
            outcome[j, k] = OUTCOMES.index(collision.outcome)
            for name, value in terms(collision).items():
                values[name][j, k] = value
    data = {name: (("angle", "stokes"), array) for name, array in values.items()}
    coordinates = {"angle": ("angle", np.asarray(angle, float), {"units": "rad"}), "stokes": np.asarray(stokes, float)}
    return xr.Dataset(
        {"outcome": (("angle", "stokes"), outcome), **data, "reason": (("angle", "stokes"), reason)},
        coords=coordinates,
        attrs=provenance(scene, rtol=rtol, unit="m v0^2/2"),
    )


def terms(collision: Collision) -> dict[str, float]:
    """The terms of one collision, rotation from the rates at separation; for a stick only the restitution."""
    shares = dict(collision.budget or ())
    if not shares:
        return {"restitution": collision.restitution}
    budget = {
        "restitution": collision.restitution,
        "excess": collision.restitution**2 - 1,
        "rotation_released": _released(collision),
        "residual": -shares["residual"],
        "ceiling": ceiling(collision),
    } | {name: 0.0 - shares.get(name, 0.0) for name in LOSSES}
    budget["dry_contact"] -= shares.get("dry_friction", 0.0)  # all that the solids take
    more = sum(shares.get(name, 0.0) for name in ("attraction", "own_events"))
    lost = sum(budget[name] for name in LOSSES) + budget["residual"] - more
    return budget | {"gap": budget["excess"] - budget["rotation_released"] + lost}


def _released(collision: Collision) -> float:
    """Rotational energy at initial contact minus that at separation, from the rates, independent of the ledger."""
    assert collision.final_gap is not None
    a, spin = collision.scene.particles.reduced_radius, collision.final_spin or 0.0
    spins = spin, spin if collision.final_spin_partner is None else collision.final_spin_partner
    last = ((4 * a + collision.final_gap) * (collision.final_rotation_rate or 0.0)) ** 2 + _spun(spins, a)
    return first_rotation(collision.scene, collision.angle, collision.speed) - last / collision.speed**2


def first_rotation(scene: Scene, angle: float, speed: float) -> float:
    """Rotational energy of equal spheres at initial contact, over m v0^2/2."""
    a = scene.particles.reduced_radius
    sideways = (4 * a + scene.liquid.film_thickness) * math.tan(angle) / (4 * a)
    return sideways**2 + _spun(_first_spins(scene), a) / speed**2


def _first_spins(scene: Scene) -> tuple[float, float]:
    """Spins of both spheres at initial contact, rad/s; a wall has none."""
    return scene.material["impact_spin"], scene.material.get("impact_partner_spin", 0.0)


def _spun(spins: tuple[float, float], a: float) -> float:
    """Energy of both spins over m/2: the inertia of either equal sphere is (16/5) m a^2."""
    return 3.2 * a**2 * (spins[0] ** 2 + spins[1] ** 2)


def ceiling(impact: Collision) -> float:
    """Upper limit of e_n^2 if only the bridge dissipates energy; NaN for a lever arm of one's own and with strings."""
    scene = impact.scene
    if impact.energy is None or scene.pendulum is not None or not scene.law_has("arm", "balanced"):
        return math.nan
    a, m = scene.particles.reduced_radius, scene.particles.reduced_mass
    first, last = 4 + scene.liquid.film_thickness / a, 4 + (impact.final_gap or 0.0) / a  # distances over a
    momentum = first**2 * math.tan(impact.angle) / 4 + 3.2 * a * sum(_first_spins(scene)) / impact.speed  # L/(m a v0)
    released = first_rotation(scene, impact.angle, impact.speed) - momentum**2 / (last**2 + 6.4)
    return 1 + released - 2 * impact.energy.capillary / (m * impact.speed**2)
