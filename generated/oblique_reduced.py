# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 c611586f35bcc10135e6fb71d1601fb3cd7b34600b04c5754661e9c9c5af465a
"""Oblique doublet with a film only, spin eliminated through the conserved angular momentum.

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
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass, shear.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .head_on import energy_rates, rebound_loss
from .oblique import events, inward_force, restitution_ceiling, turning_rate


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity", "orbital_momentum")
GROUPS = (
    "stokes", "aspect", "obliquity", "initial_turning", "initial_spin", "glass_number", "elastic_gap",
    "rough_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "shear")
FUNCTIONS = (
    "right_hand_side", "resting_rates", "turning_rate", "inward_force", "events", "rebound", "start",
    "energies", "energy_rates", "rebound_loss", "outputs", "surface_slip", "effective_potential",
    "rigid_rotation", "restitution_ceiling",
)
REGIONAL = ("right_hand_side", "resting_rates", "energy_rates")
DIGEST = "c611586f35bcc10135e6fb71d1601fb3cd7b34600b04c5754661e9c9c5af465a"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 36
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    momentum = 6.4*initial_spin + initial_turning*(aspect + 4)**2
    spin = 5*momentum/32 - 5*orbital_momentum/32
    slip = orbital_rate - spin
    shear_force = 4*aspect*shear*slip*laws.shear.log_factor(gap, aspect)/(3*stokes)
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    return {
        "gap": normal_velocity,
        "normal_velocity": centrifugal_force - film_force,
        "orbital_momentum": -distance*shear_force,
    }


def resting_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0 in resting contact: the gap is held, the rotation goes on.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 25
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    momentum = 6.4*initial_spin + initial_turning*(aspect + 4)**2
    spin = 5*momentum/32 - 5*orbital_momentum/32
    slip = orbital_rate - spin
    shear_force = 4*aspect*shear*slip*laws.shear.log_factor(gap, aspect)/(3*stokes)
    return {
        "gap": 0,
        "normal_velocity": 0,
        "orbital_momentum": -distance*shear_force,
    }


def rebound(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State just after a rebound: u -> -e_dry u; the other states are continuous.

    Total operations: 2
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    dry_restitution = groups["dry_restitution"]
    return {
        "gap": gap,
        "normal_velocity": -dry_restitution*normal_velocity,
        "orbital_momentum": orbital_momentum,
    }


def start(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State at initial contact.

    Total operations: 4
    """
    aspect = groups["aspect"]
    initial_turning = groups["initial_turning"]
    return {
        "gap": 1,
        "normal_velocity": -1,
        "orbital_momentum": initial_turning*(aspect + 4)**2,
    }


def energies(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Energies of the state over m v0^2.

    Total operations: 29
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    momentum = 6.4*initial_spin + initial_turning*(aspect + 4)**2
    spin = 5*momentum/32 - 5*orbital_momentum/32
    return {
        "kinetic": distance**2*obliquity**2*orbital_rate**2/32 + normal_velocity**2/2 + 0.2*obliquity**2*spin**2,
    }


def outputs(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Results for a separated doublet: restitutions, and rates over their scale.

    Total operations: 19
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    aspect = groups["aspect"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    momentum = 6.4*initial_spin + initial_turning*(aspect + 4)**2
    spin = 5*momentum/32 - 5*orbital_momentum/32
    return {
        "restitution": normal_velocity,
        "tangential_restitution": distance*orbital_rate/(initial_turning*(aspect + 4)),
        "final_rotation_rate": orbital_rate,
        "final_spin": spin,
    }


def surface_slip(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Relative velocity of the surfaces at the contact, at the lever arm of the shear, over a Omega.

    Total operations: 17
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    aspect = groups["aspect"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    momentum = 6.4*initial_spin + initial_turning*(aspect + 4)**2
    spin = 5*momentum/32 - 5*orbital_momentum/32
    slip = orbital_rate - spin
    return {
        "surface_slip": distance*slip,
    }


def effective_potential(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of
    the least energy along the gap, capillary work included.

    Total operations: 25
    """
    gap = state["gap"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    distance = aspect*gap + 4
    momentum = 6.4*initial_spin + initial_turning*(aspect + 4)**2
    inertia_ratio = distance**2 + 6.4
    return {
        "energy": momentum**2*obliquity**2/(32*inertia_ratio),
        "slope": -aspect*distance*momentum**2*obliquity**2/(16*inertia_ratio**2),
    }


def rigid_rotation(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """The state with this least energy: no normal velocity, rigid rotation.

    Total operations: 14
    """
    gap = state["gap"]
    aspect = groups["aspect"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    distance = aspect*gap + 4
    momentum = 6.4*initial_spin + initial_turning*(aspect + 4)**2
    inertia_ratio = distance**2 + 6.4
    return {
        "gap": gap,
        "normal_velocity": 0,
        "orbital_momentum": distance**2*momentum/inertia_ratio,
    }
