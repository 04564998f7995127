"""The Stokes numbers between which the outcomes of a scene may change, from closed forms."""

import math
from collections.abc import Collection

from ...generated.automaton import MOST_OBLIQUE
from ..model.dimensionless import nondimensionalise
from ..scene.groups import scaled
from ..scene.scene import Scene

STOKES = (1e-4, 100.0)  # least range of Stokes numbers that is searched
_ROOM = 3.0  # factor beyond the closed forms, which are exact head-on only
_FARTHEST = 12  # most decades from St 1; collisions beyond it are not worth their time
_SOFTEST = 1e-3  # dry restitution below which rebounds no longer matter
_CLEAR = 1.1  # factor of the Stokes number beyond which the rotation does not reverse the approach within rounding
_SHALLOW = 0.5  # of the film: a straight line that comes no nearer meets criteria near initial contact only


def stokes_range(scene: Scene, angles: Collection[float]) -> tuple[float, float]:
    """Lowest and highest Stokes number of a search at angles (rad): `STOKES`, or more where the scene asks for it.

    Where spins reverse the slowest approaches within rounding of the film thickness, it begins above them.

    Head-on, a rebound at the roughness escapes the film from St = (1 + 1/e) ln(x0/x_b) on, and attraction at a speed
    whose energy exceeds its work. Faster than a criterion is met at initial contact, nothing else changes.
    """
    a, m, x0 = scene.reduced_radius, scene.reduced_mass, scene.liquid.film_thickness
    tension = 0.0 if scene.bridge is None else 4 * math.pi * a * scene.bridge.surface_tension
    hamaker = 0.0 if scene.attraction is None else scene.attraction.hamaker
    rebound, contact = max(scene.particles.dry_restitution, _SOFTEST), scene.particles.roughness
    work = tension * scene.rupture_gap + (hamaker * a / (6 * contact) if contact else 0.0)
    first = scene.stokes_of(_at_contact(scene))
    lows, highs = [first], [scene.stokes_of(math.sqrt(2 * work / m) / rebound)]
    film = (1 + 1 / rebound) * math.log(x0 / contact) if contact else math.inf
    pull = tension + hamaker * a / (6 * x0 * x0)
    for angle in angles:
        grazes = math.sin(angle) > _depth(scene, _SHALLOW * x0) / _depth(scene, x0)
        highs.append(first if grazes else min(first, film))
        if pull and scene.turns(angle) and angle > 0 and not scene.wall:
            lows.append(scene.stokes_of(math.sqrt(pull * a / m) / math.tan(angle)))
    low = max(math.floor(math.log10(min(*lows, 1.0) / _ROOM)), -_FARTHEST)
    high = min(math.ceil(math.log10(max(1.0, *(value for value in highs if value < math.inf)) * _ROOM)), _FARTHEST)
    lowest, highest = min(10.0**low, STOKES[0]), max(10.0**high, STOKES[1])
    return lowest * max([1.0, *(_reversing(scene, lowest, angle) for angle in angles)]), highest


def _reversing(scene: Scene, stokes: float, angle: float) -> float:
    """Factor of a Stokes number below which the rotation reverses the approach within rounding, and nothing is decided.

    So slow an impact turns by its spins alone: the centrifugal force over m v0^2/x0 is proportional to St^-2.
    """
    groups = nondimensionalise(scene, float(scene.speed_of(stokes)), angle).groups
    force = groups["obliquity"] ** 2 * groups["aspect"] / 16
    return _CLEAR * math.sqrt(force / MOST_OBLIQUE)


def _at_contact(scene: Scene) -> float:
    """The least normal speed (m/s) at which a rebound criterion is met at initial contact; inf without one."""
    speeds = [math.inf]
    if scene.liquid.glass_transition_pressure is not None:
        speeds.append(scaled("glass_number", scene, 1.0))
    if scene.particles.youngs_modulus is not None:
        speeds.append(scaled("elastic_gap", scene, 1.0) ** -2.5)  # the gap grows with the speed to the power of 2/5
    return min(speeds)


def _depth(scene: Scene, gap: float) -> float:
    """Distance of the centres at a gap, m; of a wall no length compares with it."""
    ratio = scene.radius_ratio
    return 1.0 if ratio is None else 2 * scene.particles.reduced_radius * (1 + ratio) + gap
