# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 49ee3bbf352eb6230e127b85e604ded4d7583755d29b99b61b2376382420af10
"""Oblique doublet with another attraction, spin eliminated through the conserved angular momentum.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- normal_velocity [v0]: normal velocity over impact speed, negative on approach
- orbital_momentum [a^2 Omega]: orbital angular momentum r^2 omega over a^2 Omega

Groups:
- stokes [1]: Stokes number m v0/(6 pi mu a^2)
- aspect [1]: film thickness over reduced radius, x0/a
- obliquity [1]: largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0
- initial_turning [1]: tan(theta0)/T, 1 without spins
- initial_spin [Omega]: spin at initial contact over Omega
- adhesion [1]: van der Waals force at initial contact over the film's, A/(36 pi mu v0 x0 a)
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass, shear, attraction.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .head_on import rebound_loss
from .head_on_attraction import energy_rates
from .oblique import restitution_ceiling, turning_rate
from .oblique_attraction import events, inward_force
from .oblique_reduced import energies, outputs, rebound, resting_rates, rigid_rotation, start, surface_slip


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity", "orbital_momentum")
GROUPS = (
    "stokes", "aspect", "obliquity", "initial_turning", "initial_spin", "adhesion", "glass_number",
    "elastic_gap", "rough_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "shear", "attraction")
FUNCTIONS = (
    "right_hand_side", "resting_rates", "turning_rate", "inward_force", "events", "rebound", "start",
    "energies", "energy_rates", "rebound_loss", "outputs", "surface_slip", "effective_potential",
    "rigid_rotation", "restitution_ceiling",
)
REGIONAL = ("right_hand_side", "resting_rates", "energy_rates")
DIGEST = "49ee3bbf352eb6230e127b85e604ded4d7583755d29b99b61b2376382420af10"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 40
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    adhesion = groups["adhesion"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    momentum = 6.4*initial_spin + initial_turning*(aspect + 4)**2
    spin = 5*momentum/32 - 5*orbital_momentum/32
    slip = orbital_rate - spin
    shear_force = 4*aspect*shear*slip*laws.shear.log_factor(gap, aspect)/(3*stokes)
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "gap": normal_velocity,
        "normal_velocity": centrifugal_force - attraction_force - film_force,
        "orbital_momentum": -distance*shear_force,
    }


def effective_potential(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of
    the least energy along the gap, capillary work included.

    Total operations: 28
    """
    gap = state["gap"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    adhesion = groups["adhesion"]
    distance = aspect*gap + 4
    momentum = 6.4*initial_spin + initial_turning*(aspect + 4)**2
    inertia_ratio = distance**2 + 6.4
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "energy": momentum**2*obliquity**2/(32*inertia_ratio),
        "slope": attraction_force - aspect*distance*momentum**2*obliquity**2/(16*inertia_ratio**2),
    }
