"""Collisions of two spheres, or of a sphere and a wall, that move and spin in any direction."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...engines.settings import FEW, RTOL, check_engine, check_rtol
from ...errors import InputError
from ...host.arguments import check_flag
from ...host.pictures import register
from ...host.workers import usable_cores
from ...model.validity import sentences, warn
from ...results import attributes, outcome_attributes
from ...scene.groups import si_values
from ...scene.origin import provenance
from ...scene.scene import Scene
from .beside_wall import beside_wall
from .by_kernel import by_kernel
from .by_replay import pairs_by_replay
from .ends import FAILED, GREW, Ends, Motions, after, gains_energy, named
from .pairs import AXES, Bodies, Pairs, checked, dot, length

if TYPE_CHECKING:
    import xarray

_FURTHEST = 1e100  # products and quotients of several groups then stay within a double's range


def _vector(unit: str, meaning: str, *dims: str) -> tuple[tuple[str, ...], dict[str, Any]]:
    return (*dims, "axis"), {"units": unit, "long_name": meaning}


NUMBERS: dict[str, dict[str, Any]] = {
    "restitution": attributes("restitution"),
    "slip_restitution": attributes("slip_restitution"),
    "time": {"units": "s", "long_name": "time from initial contact to separation; of a stick 0"},
    "gap": {"units": "m", "long_name": "gap at that time"},
    "until": attributes("until"),
}
VECTORS = {
    "position": _vector("m", "from the first centre to the second, or to the wall's surface"),
    "normal": _vector("1", "direction of the position"),
    "velocities": _vector("m/s", "velocities of the centres; the second beside a wall is the wall's", "particle"),
    "spins": _vector("rad/s", "angular velocities", "particle"),
    "centre_velocity": _vector("m/s", "velocity of the centre of mass, or of the wall"),
    "angular_velocity": _vector("rad/s", "rigid rotation of a doublet that sticks"),
}


def collide_pair(
    scene: Scene | str | Path,
    normal: Any,
    velocities: Any,
    spins: Any,
    *,
    rtol: float = RTOL,
    engine: str | None = None,
    ledger: bool = False,
) -> xarray.Dataset:
    """Collisions of two spheres, or of a sphere and a wall, with any velocities and spins.

    The spheres are the scene's, at the distance at which its film begins. Its [impact] is not used.

    Arguments:
        scene: a Scene, a path or a preset's name; without strings, beside a wall without friction, with the lever arm
            at mid-gap.
        normal: (..., 3), from the first sphere to the second, or to the wall; of any length but zero.
        velocities: (..., 2, 3), m/s. Beside a wall (..., 1, 3), or (..., 2, 3) with the wall's velocity.
        spins: (..., 2, 3), angular velocities in rad/s. Beside a wall (..., 1, 3). Velocities too may carry units.
        rtol: relative tolerance, 1e-13..1e-3.
        engine: "taylor" (default), or "rosenbrock" or "cvodes", which integrate the phases that taylor has found.
        ledger: also the energy ledger, which takes longer.

    Leading shapes are broadcast against each other. Vectors are in the laboratory's axes.

    Returns:
        Dataset over dim_0, dim_1, ..., with vectors over `axis` and `particle`: outcome (int8: 0 stick, 1
        stick-rotate-separate, 2 bounce, -1 failed; bounce covers a pair that stuck and that twist throws off seconds
        later, its roughness met), certified, restitution, slip_restitution, time (s, to separation),
        gap, position, normal, velocities, spins, centre_velocity, angular_velocity, until (s, where the integration of
        a stick stopped), and reason (of a failure, else ""). What is undefined is NaN. A stick is given at initial
        contact (time 0, the normal and gap of that moment) as the rigid motion that has its momentum and angular
        momentum, so that it depends neither on tolerance nor on rounding. Components of the spins along the line of
        centres (twist) have no friction to leading logarithm, and stay as they are; the angular velocity has their mean
        by inertia. Beside a wall a stick moves with the wall, and only its twist is left.
        The attribute `validity` has the sentences of `Collision.validity`, for all pairs together.
        With `ledger` also energy.initial, .final (kinetic energies of both particles, with all spins, relative to their
        centre of mass or to the wall), .normal_lubrication, .tangential_lubrication, .capillary, .attraction,
        .dry_contact, .dry_friction, .own_events, .own_terms (each where the scene has it) and .residual, J; of a
        stick up to `until`, where its motion is not yet rigid.

    Raises:
        InputError: an invalid shape or scene. A collision that fails, as of a pair that does not approach, raises
            nothing; it is marked.

    Example:
        >>> from wetdoublet.solvers import collide_pair
        >>> velocities, spins = [[0.1, 0, 3.0], [0, 0, 0]], [[0, 0, 0], [0, 1000, 200]]  # m/s, rad/s
        >>> found = collide_pair("granulation", [0, 0, 1], velocities, spins, engine="rosenbrock")
        >>> int(found.outcome), found.velocities.shape
        (2, (2, 3))
    """
    loaded = Scene.load(scene)
    rtol, asked = check_rtol(rtol), check_engine(engine)
    ledger = check_flag(ledger, "ledger")
    check_scene(loaded)
    pairs = checked(loaded, normal, velocities, spins)
    ends, refused = Ends.blank(pairs.size), refusals(pairs)
    sound = np.ones(pairs.size, bool)
    for k, why in refused.items():
        ends.reason[k], sound[k] = why, False
    chosen = asked or ""
    if sound.any():
        warn(loaded)
        chosen = asked or "taylor"
        which = np.flatnonzero(sound)
        ends.put(which, _ends(pairs.subset(which), chosen, rtol, ledger))
    until = ends.put_at_contact(pairs)
    with np.errstate(invalid="ignore"):
        motions = after(pairs, ends)
    attrs = provenance(loaded, rtol=rtol, engine=chosen, validity=_validity(pairs, ends, motions))
    return _dataset(pairs, ends, until, motions, attrs, ledger)


def check_scene(scene: Scene) -> None:
    """InputError for a scene that has no collisions in space."""
    if scene.pendulum is not None:
        raise InputError("pendulum", "strings", "a scene without [pendulum]", "hold the spheres in one plane")
    if scene.particles.friction is not None and scene.wall:
        problem = "couples the directions along a wall, which are computed one by one"
        raise InputError("particles.friction", scene.particles.friction, "a scene without friction", problem)
    terms, events = (None, ()) if scene.package is None else (scene.package.terms, scene.package.events)
    if (terms is not None and terms.rotates) or any(event.rotates for event in events):
        accepted = "a model with events and terms of x, u and t alone"
        raise InputError("model", "terms or events of a rotation", accepted, "are of collisions in a plane")
    if not scene.wall and not scene.law_has("arm", "balanced"):
        problem = "does not conserve the angular momentum of a pair in space"
        raise InputError("model.arm", scene.model.arm, ", ".join(scene.laws_with("arm", "balanced")), problem)


def refusals(pairs: Pairs) -> dict[int, str]:
    """Why rows cannot be computed: a normal or other numbers that cannot be, or a pair that does not approach."""
    numbers = np.concatenate([pairs.velocities, pairs.spins], axis=1).reshape(pairs.size, 12)
    finite = np.isfinite(numbers).all(axis=1)
    with np.errstate(all="ignore"):
        approaches = pairs.opening < 0
        stokes = -pairs.opening * pairs.scene.stokes_per_speed
        surfaces = float(pairs.scene.material["reduced_radius"]) * np.max(np.abs(pairs.spins), axis=(1, 2))
        near = (stokes >= 1 / _FURTHEST) & (stokes <= _FURTHEST) & (surfaces <= -_FURTHEST * pairs.opening)
    reasons: dict[int, str] = {}
    for k in np.flatnonzero(~(finite & approaches & near)).tolist():
        if not 0.5 < np.abs(pairs.normal[k]).max() <= 1.0:  # of a unit vector at least 1/sqrt(3)
            given = ", ".join(f"{number:g}" for number in pairs.normal[k])
            error = InputError("normal", f"({given})", "a finite vector that is not zero", "has no direction")
        elif finite[k] and approaches[k]:
            error = InputError(
                "velocities, spins",
                f"{-pairs.opening[k]:g} m/s along normal, spins up to {np.abs(pairs.spins[k]).max():g} rad/s",
                f"Stokes numbers from {1 / _FURTHEST:g} to {_FURTHEST:g}, surfaces up to {_FURTHEST:g} times as fast",
                "are too far off",
            )
        elif finite[k]:
            error = InputError(
                "velocities",
                f"{pairs.opening[k]:.6g} m/s along normal",
                "the second, or the wall, against the first with a negative component along normal",
                "do not approach",
            )
        else:
            bad = float(numbers[k][~np.isfinite(numbers[k])][0])
            error = InputError("velocities, spins", bad, "finite numbers", "is not finite")
        reasons[k] = str(error)
    return reasons


def _ends(pairs: Pairs, engine: str, rtol: float, ledger: bool) -> Ends:
    """Ends of pairs that approach."""
    threads = usable_cores() if pairs.size > FEW else 1
    if pairs.scene.wall:
        ends = beside_wall(pairs, engine, rtol, threads, ledger)
    elif engine == "taylor":
        ends = by_kernel(pairs, rtol, threads, ledger)
    else:
        ends = pairs_by_replay(pairs, engine, rtol, ledger)
    grown = gains_energy(pairs, ends, rtol)
    ends.outcome[grown], ends.reason[grown] = FAILED, GREW
    return ends


def _validity(pairs: Pairs, ends: Ends, motions: Motions) -> list[str]:
    """Where the collisions leave the model's range; beside a wall without what its smallest gap decides."""
    which = np.flatnonzero(ends.outcome != FAILED)
    if not which.size:
        return []
    some = pairs.subset(which)
    before, after = (velocities[:, 1] - velocities[:, 0] for velocities in (some.velocities, motions.velocities[which]))
    bent = np.arctan2(length(np.cross(before, after)), dot(before, after)[:, 0])
    table: dict[str, Any] = si_values(some.scene, None, None)
    touching = np.inf if some.scene.wall else sum(Bodies.of(some.scene).radius)
    sliding = length(some.sliding) / (1 + table["film_thickness"] / touching)  # the planar angle's, of touching spheres
    angle = np.arctan2(sliding, -some.opening)
    course = {
        "rotation": np.pi - np.arctan2(length(some.sliding), -some.opening) + bent,
        "tangential_restitution": 0.0,
        "restitution": 1.0,
        "smallest_gap": np.nan,
        "contact_time": ends.time[which],  # 0 of a stick
    }
    table |= {"speed": -some.opening, "angle": angle}
    return sentences(some.scene, table | course | {"outcome": ends.outcome[which]})


def _dataset(
    pairs: Pairs, ends: Ends, until: np.ndarray, motions: Motions, attrs: dict[str, Any], ledger: bool
) -> xarray.Dataset:
    import xarray as xr

    register()
    dims = tuple(f"dim_{k}" for k in range(len(pairs.shape)))
    failed, separated = ends.outcome == FAILED, ends.outcome > 0
    with np.errstate(all="ignore"):
        restitution = np.where(separated, ends.opening / -pairs.opening, np.where(failed, np.nan, 0.0))
    for column in (ends.time, ends.gap):
        column[failed] = np.nan
    columns = {"restitution": restitution, "slip_restitution": ends.slip, "until": until} | vars(ends) | vars(motions)
    columns |= {"normal": motions.position / np.linalg.norm(motions.position, axis=1, keepdims=True)}
    variables: dict[str, Any] = {
        "outcome": (dims, ends.outcome, outcome_attributes()),
        "certified": (dims, ends.certified, {"long_name": "the stick is proved"}),
        "reason": (dims, ends.reason.astype(str), {"long_name": "why it failed"}),
    }
    variables |= {name: (dims, columns[name], about) for name, about in NUMBERS.items()}
    if ledger:
        terms = named(pairs.scene, ends.energy)
        variables |= {f"energy.{key}": (dims, column, attributes(f"energy.{key}")) for key, column in terms.items()}
    for name, (more, about) in VECTORS.items():
        values = np.where(failed.reshape(-1, *[1] * len(more)), np.nan, columns[name])
        variables[name] = (*dims, *more), values, about
    shaped = {
        name: (own, values.reshape((*pairs.shape, *values.shape[1:])), notes)
        for name, (own, values, notes) in variables.items()
    }
    return xr.Dataset(shaped, {"axis": list(AXES)}, attrs)
