# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 c718b77e0591ffafa8532f01ad54b35566bef442777464c9bad766fb45d08b2a
"""Head-on doublet with another attraction.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- normal_velocity [v0]: normal velocity over impact speed, negative on approach

Groups:
- stokes [1]: Stokes number m v0/(6 pi mu a^2)
- adhesion [1]: van der Waals force at initial contact over the film's, A/(36 pi mu v0 x0 a)
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass, attraction.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .head_on import (
    energies, events, outputs, rebound, rebound_loss, restitution_ceiling, rigid_rotation, start,
)


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity")
GROUPS = ("stokes", "adhesion", "glass_number", "elastic_gap", "rough_gap", "dry_restitution")
SLOTS = ("film", "glass", "attraction")
FUNCTIONS = (
    "right_hand_side", "inward_force", "events", "rebound", "start", "energies", "energy_rates",
    "rebound_loss", "outputs", "effective_potential", "rigid_rotation", "restitution_ceiling",
)
REGIONAL = ("right_hand_side", "energy_rates")
DIGEST = "c718b77e0591ffafa8532f01ad54b35566bef442777464c9bad766fb45d08b2a"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 9
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    stokes = groups["stokes"]
    adhesion = groups["adhesion"]
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "gap": normal_velocity,
        "normal_velocity": -attraction_force - film_force,
    }


def inward_force(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Sum of the normal forces except the film's, over m v0^2/x0: positive inward.

    Total operations: 3
    """
    gap = state["gap"]
    stokes = groups["stokes"]
    adhesion = groups["adhesion"]
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "inward_force": attraction_force,
    }


def energy_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 9
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    stokes = groups["stokes"]
    adhesion = groups["adhesion"]
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "normal_lubrication": film_force*normal_velocity,
        "attraction": attraction_force*normal_velocity,
    }


def effective_potential(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of
    the least energy along the gap, capillary work included.

    Total operations: 3
    """
    gap = state["gap"]
    stokes = groups["stokes"]
    adhesion = groups["adhesion"]
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "energy": 0,
        "slope": attraction_force,
    }
