"""Findings on e_n > 1 on a grid of impacts: the budget of e_n^2 - 1, the ceiling of e_n^2, and where e_n > 1.

Here the energy of rotation is that of the rates at separation of equal spheres, so that the sum is a check.
"""

import math
from collections.abc import Iterator
from itertools import groupby

import numpy as np

from ..collision.collide import collide
from ..collision.result import Collision
from ..errors import WetDoubletError
from ..scene.scene import Scene
from .conserved import RESIDUAL, agreement, worst_of
from .report import Finding, bounded, note
from .sample import WHOLE, Collide, Extent, Sample, place, stokes_of, where

_DECADES = (-1.0, 1.6)  # relative to the scene's Stokes number
_RTOL = 1e-10
_BESIDE = 24  # collisions of the grid that CVODES computes as well
_LEFT_OUT = ("rigid_rotation", "slip", "residual")  # terms of a budget: rotation, here from the rates, and the ledger's


def grid(scene: Scene, extent: Extent = WHOLE, collide: Collide = collide) -> Sample:
    """Collisions over the relevant angles and Stokes numbers of a scene, angle by angle."""
    data = Sample(scene)
    for angle in np.radians(extent.grid_angles).tolist():
        for stokes in (stokes_of(scene) * np.logspace(*_DECADES, extent.grid_points)).tolist():
            try:
                run = collide(scene, stokes=stokes, angle=angle, rtol=_RTOL)
                data.impacts.append({run.engine: run})
            except WetDoubletError as failure:
                data.failures.append(f"{place(stokes, angle)}: {failure}")
    return data


def beside_cvodes(data: Sample) -> Iterator[Finding]:
    """Finding on the engine of a grid: some of its collisions beside CVODES."""
    picked = np.unique(np.linspace(0, len(data.all) - 1, min(_BESIDE, len(data.all))).round().astype(int))
    runs = [data.all[k] for k in picked]
    others = [collide(data.scene, stokes=run.stokes, angle=run.angle, rtol=_RTOL, engine="cvodes") for run in runs]
    if runs:
        yield agreement(f"{runs[0].engine} = cvodes, on the grid", list(zip(runs, others, strict=True)))


def argument(data: Sample) -> Iterator[Finding]:
    """Findings on the budget of a grid."""
    if data.failures:
        about = tuple(f"  {text}" for text in data.failures[:3])
        statement, figure = "every point of the grid", f"{len(data.failures)} are not"
        yield Finding("", "e_n^2 - 1: completed", statement, figure, "", False, "", about)
    parted = [run for run in data.all if run.budget]
    if not parted:
        yield note("e_n > 1", "the region where e_n > 1", "no doublet separates")
        return
    statement = "e_n^2 - 1 = rotation released - film - shear - bridge - solids - strings, over the largest of them"
    if data.scene.partner is not None:
        yield note("e_n^2 - 1: identity", statement, "its terms are those of equal spheres")
        return
    figure_of = {id(run): abs(_excess(run)) / _size(run) for run in parted}
    error, run = worst_of(parted, lambda run: figure_of[id(run)])
    # the ledger's residual, bounded relative to the whole initial energy, not to v0^2 alone
    bound = RESIDUAL * (1 + first_rotation(run)) / _size(run)
    rounding = max(abs(_excess(run) - dict(run.budget or ())["residual"]) / _size(run) for run in parted)
    about_all = f"  {len(parted)} points that separate; with the ledger's residual in it: {rounding:.0e}"
    yield bounded("e_n^2 - 1: identity", statement, error, bound, where(run), about_all)
    if data.scene.pendulum is None and data.scene.law_has("arm", "balanced"):
        error, run = worst_of(parted, lambda run: run.restitution**2 - ceiling(run))
        statement = "e_n^2 <= 1 + [E_rot(0) - L^2/(2 I(x_f)) - W_c]/(m v0^2/2): the largest of left less right"
        largest = max(1 + first_rotation(run) for run in data.all)
        yield bounded("e_n^2: ceiling", statement, error, RESIDUAL * largest, where(run))
    else:
        why = "with strings or an arm of one's own there is no closed form"
        yield note("e_n^2: ceiling", "e_n^2 <= its closed-form ceiling", why)
    yield _region(data, max(parted, key=lambda run: run.restitution))


def _region(data: Sample, best: Collision) -> Finding:
    """Finding on angles and Stokes numbers with e_n > 1, and the largest e_n."""
    lines, degrees, numbers = [], [], list[float]()
    for angle, runs in groupby(data.all, key=lambda run: run.angle):
        ranges = [[*above] for gains, above in groupby(runs, key=lambda run: run.restitution > 1) if gains]
        if ranges:
            degrees.append(math.degrees(angle))
            numbers += [run.stokes for above in ranges for run in above]
            spans = ", ".join(f"{above[0].stokes:.3g}..{above[-1].stokes:.3g}" for above in ranges)
            most = max(run.restitution for above in ranges for run in above)
            lines.append(f"  {degrees[-1]:4.0f} deg: e_n > 1 for St {spans} (up to {most:.3f})")
    largest = f"largest {best.restitution:.4g} ({place(best.stokes, best.angle)})"
    at = (
        f"at {degrees[0]:.0f}..{degrees[-1]:.0f} deg, St {min(numbers):.3g}..{max(numbers):.3g}" if lines else "nowhere"
    )
    ends = f"{data.all[0].stokes:.3g}..{data.all[-1].stokes:.3g}"
    statement = f"where more energy of rotation is released than is lost, on a grid of St {ends}"
    return note("e_n > 1", statement, f"{at}; {largest}", about=tuple(lines))


def _excess(run: Collision) -> float:
    """e_n^2 - 1 less its terms but for the ledger's residual, rotation from the rates at separation."""
    taken = math.fsum(share for name, share in run.budget or () if name not in _LEFT_OUT)
    return run.restitution**2 - 1 - _released(run) - taken


def _size(run: Collision) -> float:
    """The largest term, at least m v0^2/2."""
    return max(1.0, abs(_released(run)))


def _released(run: Collision) -> float:
    """Rotational energy at initial contact minus that at separation, from the rates, independent of the ledger."""
    assert run.final_gap is not None
    a, spin = run.scene.particles.reduced_radius, run.final_spin or 0.0
    spins = spin, spin if run.final_spin_partner is None else run.final_spin_partner
    last = ((4 * a + run.final_gap) * (run.final_rotation_rate or 0.0)) ** 2 + _spun(spins, a)
    return first_rotation(run) - last / run.speed**2


def first_rotation(run: Collision) -> float:
    """Rotational energy of equal spheres at initial contact, over m v0^2/2."""
    a = run.scene.particles.reduced_radius
    sideways = (4 * a + run.scene.liquid.film_thickness) * math.tan(run.angle) / (4 * a)
    return sideways**2 + _spun(_first_spins(run.scene), a) / run.speed**2


def _first_spins(scene: Scene) -> tuple[float, float]:
    """Spins of both spheres at initial contact, rad/s."""
    return scene.material["impact_spin"], scene.material.get("impact_partner_spin", 0.0)


def _spun(spins: tuple[float, float], a: float) -> float:
    """Energy of both spins over m/2: the inertia of either equal sphere is (16/5) m a^2."""
    return 3.2 * a**2 * (spins[0] ** 2 + spins[1] ** 2)


def ceiling(run: Collision) -> float:
    """Upper limit of e_n^2 of equal spheres if only the bridge dissipates energy, without strings."""
    assert run.energy is not None
    scene, a = run.scene, run.scene.particles.reduced_radius
    first, last = 4 + scene.liquid.film_thickness / a, 4 + (run.final_gap or 0.0) / a  # distances over a
    momentum = first**2 * math.tan(run.angle) / 4 + 3.2 * a * sum(_first_spins(scene)) / run.speed  # L/(m a v0)
    released = first_rotation(run) - momentum**2 / (last**2 + 6.4)
    return 1 + released - 2 * run.energy.capillary / (scene.particles.reduced_mass * run.speed**2)
