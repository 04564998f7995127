# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 c088de719a09c15ea49adf26122d21780496a0dda7c232755f5595ef60c2538f
"""Oblique unequal doublet with a film only.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- normal_velocity [v0]: normal velocity over impact speed, negative on approach
- orbital_momentum [a^2 Omega]: orbital angular momentum r^2 omega over a^2 Omega
- spin [Omega]: spin of each sphere over its scale Omega
- partner_spin [Omega]: spin of the partner over Omega

Groups:
- stokes [1]: Stokes number m v0/(6 pi mu a^2)
- aspect [1]: film thickness over reduced radius, x0/a
- obliquity [1]: largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0
- initial_turning [1]: tan(theta0)/T, 1 without spins
- initial_spin [Omega]: spin at initial contact over Omega
- initial_partner_spin [Omega]: spin of the partner at initial contact over Omega
- radius_ratio [1]: radius of the partner over that of the sphere
- mass_ratio [1]: mass of the partner over that of the sphere
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass, shear, arm.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from casadi import fabs
from .head_on import rebound_loss


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity", "orbital_momentum", "spin", "partner_spin")
GROUPS = (
    "stokes", "aspect", "obliquity", "initial_turning", "initial_spin", "initial_partner_spin",
    "radius_ratio", "mass_ratio", "glass_number", "elastic_gap", "rough_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "shear", "arm")
FUNCTIONS = (
    "right_hand_side", "resting_rates", "turning_rate", "inward_force", "events", "rebound", "start",
    "energies", "energy_rates", "rebound_loss", "angular_momentum", "outputs", "surface_slip",
    "effective_potential", "rigid_rotation",
)
REGIONAL = ("right_hand_side", "resting_rates", "energy_rates")
DIGEST = "c088de719a09c15ea49adf26122d21780496a0dda7c232755f5595ef60c2538f"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 73
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    partner_spin = state["partner_spin"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    radius_ratio = groups["radius_ratio"]
    mass_ratio = groups["mass_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    distance = aspect*gap + centres
    orbital_rate = orbital_momentum/distance**2
    radius = (radius_ratio + 1)/radius_ratio
    partner_radius = radius_ratio + 1
    spin_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2/(mass_ratio*radius_ratio**2)
    partner_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2
    slip = orbital_rate - spin
    partner_slip = orbital_rate - partner_spin
    drag = aspect*shear*laws.shear.log_factor(gap, aspect)/(3*stokes)
    lever = laws.arm.lever(4*distance/centres)/2
    torque = 0.4*drag*lever*radius*(partner_radius*partner_slip + 4*radius*slip)
    partner_torque = 0.4*drag*lever*partner_radius*(4*partner_radius*partner_slip + radius*slip)
    shear_force = (partner_torque + torque)/(centres*lever)
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    return {
        "gap": normal_velocity,
        "normal_velocity": aspect*distance*obliquity**2*orbital_rate**2/centres**2 - film_force,
        "orbital_momentum": -distance*shear_force,
        "spin": torque/spin_inertia,
        "partner_spin": partner_torque/partner_inertia,
    }


def resting_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0 in resting contact: the gap is held, the rotation goes on.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 61
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    partner_spin = state["partner_spin"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    radius_ratio = groups["radius_ratio"]
    mass_ratio = groups["mass_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    distance = aspect*gap + centres
    orbital_rate = orbital_momentum/distance**2
    radius = (radius_ratio + 1)/radius_ratio
    partner_radius = radius_ratio + 1
    spin_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2/(mass_ratio*radius_ratio**2)
    partner_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2
    slip = orbital_rate - spin
    partner_slip = orbital_rate - partner_spin
    drag = aspect*shear*laws.shear.log_factor(gap, aspect)/(3*stokes)
    lever = laws.arm.lever(4*distance/centres)/2
    torque = 0.4*drag*lever*radius*(partner_radius*partner_slip + 4*radius*slip)
    partner_torque = 0.4*drag*lever*partner_radius*(4*partner_radius*partner_slip + radius*slip)
    shear_force = (partner_torque + torque)/(centres*lever)
    return {
        "gap": 0,
        "normal_velocity": 0,
        "orbital_momentum": -distance*shear_force,
        "spin": torque/spin_inertia,
        "partner_spin": partner_torque/partner_inertia,
    }


def turning_rate(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Angular velocity of the line of centres, rad per x0/v0 (without strings, the angle is no state).

    Total operations: 10
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    radius_ratio = groups["radius_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    distance = aspect*gap + centres
    orbital_rate = orbital_momentum/distance**2
    return {
        "rotation": aspect*obliquity*orbital_rate/centres,
    }


def inward_force(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Sum of the normal forces except the film's, over m v0^2/x0: positive inward.

    Total operations: 15
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    radius_ratio = groups["radius_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    distance = aspect*gap + centres
    orbital_rate = orbital_momentum/distance**2
    return {
        "inward_force": -aspect*distance*obliquity**2*orbital_rate**2/centres**2,
    }


def events(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Event functions, each positive before its event: rebound criteria while closing, `turning` the normal
    velocity (negative while closing), `release` in resting contact.

    Total operations: 23
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    radius_ratio = groups["radius_ratio"]
    glass_number = groups["glass_number"]
    elastic_gap = groups["elastic_gap"]
    rough_gap = groups["rough_gap"]
    centres = (radius_ratio + 1)**2/radius_ratio
    distance = aspect*gap + centres
    orbital_rate = orbital_momentum/distance**2
    return {
        "turning": normal_velocity,
        "glass": glass_number - laws.glass.pressure(gap, -normal_velocity),
        "elastic": gap - elastic_gap,
        "rough": gap - rough_gap,
        "rupture": 1 - gap,
        "tangential_edge": laws.shear.edge(aspect) - gap,
        "release": -aspect*distance*obliquity**2*orbital_rate**2/centres**2,
    }


def rebound(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State just after a rebound: u -> -e_dry u; the other states are continuous.

    Total operations: 2
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    partner_spin = state["partner_spin"]
    dry_restitution = groups["dry_restitution"]
    return {
        "gap": gap,
        "normal_velocity": -dry_restitution*normal_velocity,
        "orbital_momentum": orbital_momentum,
        "spin": spin,
        "partner_spin": partner_spin,
    }


def start(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State at initial contact.

    Total operations: 7
    """
    aspect = groups["aspect"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    initial_partner_spin = groups["initial_partner_spin"]
    radius_ratio = groups["radius_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    return {
        "gap": 1,
        "normal_velocity": -1,
        "orbital_momentum": initial_turning*(aspect + centres)**2,
        "spin": initial_spin,
        "partner_spin": initial_partner_spin,
    }


def energies(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Energies of the state over m v0^2.

    Total operations: 49
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    partner_spin = state["partner_spin"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    radius_ratio = groups["radius_ratio"]
    mass_ratio = groups["mass_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    distance = aspect*gap + centres
    orbital_rate = orbital_momentum/distance**2
    spin_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2/(mass_ratio*radius_ratio**2)
    partner_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2
    return {
        "kinetic": normal_velocity**2/2 + distance**2*obliquity**2*orbital_rate**2/(2*centres**2) + obliquity**2*partner_inertia*partner_spin**2/(2*centres**2) + obliquity**2*spin**2*spin_inertia/(2*centres**2),
    }


def energy_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 60
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    partner_spin = state["partner_spin"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    radius_ratio = groups["radius_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    distance = aspect*gap + centres
    orbital_rate = orbital_momentum/distance**2
    radius = (radius_ratio + 1)/radius_ratio
    partner_radius = radius_ratio + 1
    slip = orbital_rate - spin
    partner_slip = orbital_rate - partner_spin
    drag = aspect*shear*laws.shear.log_factor(gap, aspect)/(3*stokes)
    lever = laws.arm.lever(4*distance/centres)/2
    torque = 0.4*drag*lever*radius*(partner_radius*partner_slip + 4*radius*slip)
    partner_torque = 0.4*drag*lever*partner_radius*(4*partner_radius*partner_slip + radius*slip)
    shear_force = (partner_torque + torque)/(centres*lever)
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    return {
        "normal_lubrication": film_force*normal_velocity,
        "tangential_lubrication": obliquity**2*(distance**2*orbital_rate*shear_force - distance*(partner_spin*partner_torque + spin*torque))/(centres**2*distance),
    }


def angular_momentum(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """1 + the change of the angular momentum over its size at initial contact.

    Total operations: 41
    """
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    partner_spin = state["partner_spin"]
    aspect = groups["aspect"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    initial_partner_spin = groups["initial_partner_spin"]
    radius_ratio = groups["radius_ratio"]
    mass_ratio = groups["mass_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    spin_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2/(mass_ratio*radius_ratio**2)
    partner_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2
    momentum = orbital_momentum + partner_inertia*partner_spin + spin*spin_inertia
    return {
        "angular_momentum": 1 + (momentum - initial_partner_spin*partner_inertia - initial_spin*spin_inertia - initial_turning*(aspect + centres)**2)/(initial_turning*(aspect + centres)**2 + partner_inertia*fabs(initial_partner_spin) + spin_inertia*fabs(initial_spin)),
    }


def outputs(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Results for a separated doublet: restitutions, and rates over their scale.

    Total operations: 11
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    partner_spin = state["partner_spin"]
    aspect = groups["aspect"]
    initial_turning = groups["initial_turning"]
    radius_ratio = groups["radius_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    distance = aspect*gap + centres
    orbital_rate = orbital_momentum/distance**2
    return {
        "restitution": normal_velocity,
        "tangential_restitution": distance*orbital_rate/(initial_turning*(aspect + centres)),
        "final_rotation_rate": orbital_rate,
        "final_spin": spin,
        "final_spin_partner": partner_spin,
    }


def surface_slip(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Relative velocity of the surfaces at the contact, at the lever arm of the shear, over a Omega.

    Total operations: 20
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    partner_spin = state["partner_spin"]
    aspect = groups["aspect"]
    radius_ratio = groups["radius_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    distance = aspect*gap + centres
    orbital_rate = orbital_momentum/distance**2
    radius = (radius_ratio + 1)/radius_ratio
    partner_radius = radius_ratio + 1
    lever = laws.arm.lever(4*distance/centres)/2
    return {
        "surface_slip": distance*orbital_rate - lever*(partner_radius*partner_spin + radius*spin),
    }


def effective_potential(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of
    the least energy along the gap, capillary work included.

    Total operations: 44
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    partner_spin = state["partner_spin"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    radius_ratio = groups["radius_ratio"]
    mass_ratio = groups["mass_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    distance = aspect*gap + centres
    spin_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2/(mass_ratio*radius_ratio**2)
    partner_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2
    momentum = orbital_momentum + partner_inertia*partner_spin + spin*spin_inertia
    inertia_ratio = distance**2 + partner_inertia + spin_inertia
    return {
        "energy": momentum**2*obliquity**2/(2*centres**2*inertia_ratio),
        "slope": -aspect*distance*momentum**2*obliquity**2/(centres**2*inertia_ratio**2),
    }


def rigid_rotation(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """The state with this least energy: no normal velocity, rigid rotation.

    Total operations: 32
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    partner_spin = state["partner_spin"]
    aspect = groups["aspect"]
    radius_ratio = groups["radius_ratio"]
    mass_ratio = groups["mass_ratio"]
    centres = (radius_ratio + 1)**2/radius_ratio
    distance = aspect*gap + centres
    spin_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2/(mass_ratio*radius_ratio**2)
    partner_inertia = 0.4*(mass_ratio + 1)*(radius_ratio + 1)**2
    momentum = orbital_momentum + partner_inertia*partner_spin + spin*spin_inertia
    inertia_ratio = distance**2 + partner_inertia + spin_inertia
    return {
        "gap": gap,
        "normal_velocity": 0,
        "orbital_momentum": distance**2*momentum/inertia_ratio,
        "spin": momentum/inertia_ratio,
        "partner_spin": momentum/inertia_ratio,
    }
