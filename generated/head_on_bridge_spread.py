# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 e17832a8b9d2a2fe1720dd71b78c10cc2d1b90130e38967ab272f1de5354c4be
"""Head-on doublet with a liquid bridge, a film whose rim follows the bridge's volume.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- normal_velocity [v0]: normal velocity over impact speed, negative on approach

Groups:
- stokes [1]: Stokes number m v0/(6 pi mu a^2)
- aspect [1]: film thickness over reduced radius, x0/a
- capillary [1]: capillary number 3 mu a v0/(sigma x0)
- volume [1]: bridge volume over R^3 (constant)
- contact_angle [rad]: contact angle of the liquid on the sphere
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- rupture_gap [x0]: rupture distance over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass, bridge.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .head_on import energies, outputs, rebound, rebound_loss, restitution_ceiling, rigid_rotation, start
from .head_on_bridge import effective_potential, inward_force


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity")
GROUPS = (
    "stokes", "aspect", "capillary", "volume", "contact_angle", "glass_number", "elastic_gap", "rough_gap",
    "rupture_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "bridge")
FUNCTIONS = (
    "right_hand_side", "inward_force", "events", "rebound", "start", "energies", "energy_rates",
    "rebound_loss", "outputs", "effective_potential", "rigid_rotation", "restitution_ceiling",
)
REGIONAL = ("right_hand_side", "energy_rates")
DIGEST = "e17832a8b9d2a2fe1720dd71b78c10cc2d1b90130e38967ab272f1de5354c4be"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 11
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    film_force = film*normal_velocity*laws.film.resistance(gap, aspect, volume)/stokes
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    return {
        "gap": normal_velocity,
        "normal_velocity": -bridge_force - film_force,
    }


def events(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Event functions, each positive before its event: rebound criteria while closing, `turning` the normal
    velocity (negative while closing), `release` in resting contact.

    Total operations: 6
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    glass_number = groups["glass_number"]
    elastic_gap = groups["elastic_gap"]
    rough_gap = groups["rough_gap"]
    rupture_gap = groups["rupture_gap"]
    return {
        "turning": normal_velocity,
        "glass": glass_number - laws.glass.pressure(gap, -normal_velocity),
        "elastic": gap - elastic_gap,
        "rough": gap - rough_gap,
        "rupture": rupture_gap - gap,
    }


def energy_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 11
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    film_force = film*normal_velocity*laws.film.resistance(gap, aspect, volume)/stokes
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    return {
        "normal_lubrication": film_force*normal_velocity,
        "capillary": bridge_force*normal_velocity,
    }
