# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 3df67a51b229b7814eaddce727e39d6f2a7d76418779fd31394dde1f83f27043
"""Oblique doublet with a film only.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- normal_velocity [v0]: normal velocity over impact speed, negative on approach
- orbital_momentum [a^2 Omega]: orbital angular momentum r^2 omega over a^2 Omega
- spin [Omega]: spin of each sphere over its scale Omega

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

Law slots: film, glass, shear, arm.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from casadi import fabs
from .head_on import rebound_loss


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity", "orbital_momentum", "spin")
GROUPS = (
    "stokes", "aspect", "obliquity", "initial_turning", "initial_spin", "glass_number", "elastic_gap",
    "rough_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "shear", "arm")
FUNCTIONS = (
    "right_hand_side", "resting_rates", "turning_rate", "inward_force", "events", "rebound", "start",
    "energies", "energy_rates", "rebound_loss", "angular_momentum", "outputs", "surface_slip",
    "effective_potential", "rigid_rotation", "restitution_ceiling",
)
REGIONAL = ("right_hand_side", "resting_rates", "energy_rates")
DIGEST = "3df67a51b229b7814eaddce727e39d6f2a7d76418779fd31394dde1f83f27043"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 29
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    slip = orbital_rate - spin
    shear_force = 4*aspect*shear*slip*laws.shear.log_factor(gap, aspect)/(3*stokes)
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    lever = laws.arm.lever(distance)
    return {
        "gap": normal_velocity,
        "normal_velocity": centrifugal_force - film_force,
        "orbital_momentum": -distance*shear_force,
        "spin": 5*lever*shear_force/16,
    }


def resting_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0 in resting contact: the gap is held, the rotation goes on.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 18
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    slip = orbital_rate - spin
    shear_force = 4*aspect*shear*slip*laws.shear.log_factor(gap, aspect)/(3*stokes)
    lever = laws.arm.lever(distance)
    return {
        "gap": 0,
        "normal_velocity": 0,
        "orbital_momentum": -distance*shear_force,
        "spin": 5*lever*shear_force/16,
    }


def turning_rate(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Angular velocity of the line of centres, rad per x0/v0 (without strings, the angle is no state).

    Total operations: 7
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    return {
        "rotation": aspect*obliquity*orbital_rate/4,
    }


def inward_force(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Sum of the normal forces except the film's, over m v0^2/x0: positive inward.

    Total operations: 11
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    return {
        "inward_force": -centrifugal_force,
    }


def events(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Event functions, each positive before its event: rebound criteria while closing, `turning` the normal
    velocity (negative while closing), `release` in resting contact.

    Total operations: 19
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    glass_number = groups["glass_number"]
    elastic_gap = groups["elastic_gap"]
    rough_gap = groups["rough_gap"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    return {
        "turning": normal_velocity,
        "glass": glass_number - laws.glass.pressure(gap, -normal_velocity),
        "elastic": gap - elastic_gap,
        "rough": gap - rough_gap,
        "rupture": 1 - gap,
        "tangential_edge": laws.shear.edge(aspect) - gap,
        "release": -centrifugal_force,
    }


def rebound(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State just after a rebound: u -> -e_dry u; the other states are continuous.

    Total operations: 2
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    dry_restitution = groups["dry_restitution"]
    return {
        "gap": gap,
        "normal_velocity": -dry_restitution*normal_velocity,
        "orbital_momentum": orbital_momentum,
        "spin": spin,
    }


def start(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State at initial contact.

    Total operations: 4
    """
    aspect = groups["aspect"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    return {
        "gap": 1,
        "normal_velocity": -1,
        "orbital_momentum": initial_turning*(aspect + 4)**2,
        "spin": initial_spin,
    }


def energies(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Energies of the state over m v0^2.

    Total operations: 18
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    return {
        "kinetic": distance**2*obliquity**2*orbital_rate**2/32 + normal_velocity**2/2 + 0.2*obliquity**2*spin**2,
    }


def energy_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 26
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    slip = orbital_rate - spin
    shear_force = 4*aspect*shear*slip*laws.shear.log_factor(gap, aspect)/(3*stokes)
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    lever = laws.arm.lever(distance)
    return {
        "normal_lubrication": film_force*normal_velocity,
        "tangential_lubrication": obliquity**2*shear_force*(distance*orbital_rate - 2*lever*spin)/16,
    }


def angular_momentum(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """1 + the change of the angular momentum over its size at initial contact.

    Total operations: 19
    """
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    aspect = groups["aspect"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    momentum = orbital_momentum + 6.4*spin
    return {
        "angular_momentum": 1 + (momentum - 6.4*initial_spin - initial_turning*(aspect + 4)**2)/(initial_turning*(aspect + 4)**2 + 6.4*fabs(initial_spin)),
    }


def outputs(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Results for a separated doublet: restitutions, and rates over their scale.

    Total operations: 8
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    aspect = groups["aspect"]
    initial_turning = groups["initial_turning"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    return {
        "restitution": normal_velocity,
        "tangential_restitution": distance*orbital_rate/(initial_turning*(aspect + 4)),
        "final_rotation_rate": orbital_rate,
        "final_spin": spin,
    }


def surface_slip(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Relative velocity of the surfaces at the contact, at the lever arm of the shear, over a Omega.

    Total operations: 9
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    aspect = groups["aspect"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    lever = laws.arm.lever(distance)
    return {
        "surface_slip": distance*orbital_rate - 2*lever*spin,
    }


def effective_potential(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of
    the least energy along the gap, capillary work included.

    Total operations: 22
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    distance = aspect*gap + 4
    momentum = orbital_momentum + 6.4*spin
    inertia_ratio = distance**2 + 6.4
    return {
        "energy": momentum**2*obliquity**2/(32*inertia_ratio),
        "slope": -aspect*distance*momentum**2*obliquity**2/(16*inertia_ratio**2),
    }


def rigid_rotation(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """The state with this least energy: no normal velocity, rigid rotation.

    Total operations: 12
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    aspect = groups["aspect"]
    distance = aspect*gap + 4
    momentum = orbital_momentum + 6.4*spin
    inertia_ratio = distance**2 + 6.4
    return {
        "gap": gap,
        "normal_velocity": 0,
        "orbital_momentum": distance**2*momentum/inertia_ratio,
        "spin": momentum/inertia_ratio,
    }


def restitution_ceiling(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Upper bound of e_n^2 for separation at this gap, from the initial energy and angular momentum, without the
    work of attractions: 2 (W_c(x_f) - W_c(x0))/(m v0^2) is still to be subtracted.

    Total operations: 31
    """
    gap = state["gap"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    distance = aspect*gap + 4
    inertia_ratio = distance**2 + 6.4
    return {
        "squared": 0.4*initial_spin**2*obliquity**2 + initial_turning**2*obliquity**2*(aspect + 4)**2/16 + 1 - 0.0025*obliquity**2*(32*initial_spin + 5*initial_turning*(aspect + 4)**2)**2/inertia_ratio,
    }
