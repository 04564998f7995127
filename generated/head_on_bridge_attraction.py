# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 92d19310ee834292a10323a1e38e930c3aa34e3da0a9e790e510df0d1df884d3
"""Head-on doublet with a liquid bridge and another attraction.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- normal_velocity [v0]: normal velocity over impact speed, negative on approach

Groups:
- stokes [1]: Stokes number m v0/(6 pi mu a^2)
- aspect [1]: film thickness over reduced radius, x0/a
- capillary [1]: capillary number 3 mu a v0/(sigma x0)
- volume [1]: bridge volume over R^3 (constant)
- contact_angle [rad]: contact angle of the liquid on the sphere
- adhesion [1]: van der Waals force at initial contact over the film's, A/(36 pi mu v0 x0 a)
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- rupture_gap [x0]: rupture distance over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass, bridge, attraction.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .head_on import energies, outputs, rebound, rebound_loss, restitution_ceiling, rigid_rotation, start
from .head_on_bridge import events


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity")
GROUPS = (
    "stokes", "aspect", "capillary", "volume", "contact_angle", "adhesion", "glass_number", "elastic_gap",
    "rough_gap", "rupture_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "bridge", "attraction")
FUNCTIONS = (
    "right_hand_side", "inward_force", "events", "rebound", "start", "energies", "energy_rates",
    "rebound_loss", "outputs", "effective_potential", "rigid_rotation", "restitution_ceiling",
)
REGIONAL = ("right_hand_side", "energy_rates")
DIGEST = "92d19310ee834292a10323a1e38e930c3aa34e3da0a9e790e510df0d1df884d3"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 15
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    adhesion = groups["adhesion"]
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "gap": normal_velocity,
        "normal_velocity": -attraction_force - bridge_force - film_force,
    }


def inward_force(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Sum of the normal forces except the film's, over m v0^2/x0: positive inward.

    Total operations: 9
    """
    gap = state["gap"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    adhesion = groups["adhesion"]
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "inward_force": attraction_force + bridge_force,
    }


def energy_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 15
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    adhesion = groups["adhesion"]
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "normal_lubrication": film_force*normal_velocity,
        "capillary": bridge_force*normal_velocity,
        "attraction": attraction_force*normal_velocity,
    }


def effective_potential(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of
    the least energy along the gap, capillary work included.

    Total operations: 9
    """
    gap = state["gap"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    adhesion = groups["adhesion"]
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "energy": 0,
        "slope": attraction_force + bridge_force,
    }
