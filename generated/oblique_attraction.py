# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 730a5500fe2286f0ce9b5e7b62d95dff9d104d1a596f4c06647a4b063cfd22fb
"""Oblique doublet with another attraction.

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
- adhesion [1]: van der Waals force at initial contact over the film's, A/(36 pi mu v0 x0 a)
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass, shear, arm, attraction.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .head_on import rebound_loss
from .oblique import (
    angular_momentum, energies, outputs, rebound, resting_rates, restitution_ceiling, rigid_rotation, start,
    surface_slip, turning_rate,
)


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity", "orbital_momentum", "spin")
GROUPS = (
    "stokes", "aspect", "obliquity", "initial_turning", "initial_spin", "adhesion", "glass_number",
    "elastic_gap", "rough_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "shear", "arm", "attraction")
FUNCTIONS = (
    "right_hand_side", "resting_rates", "turning_rate", "inward_force", "events", "rebound", "start",
    "energies", "energy_rates", "rebound_loss", "angular_momentum", "outputs", "surface_slip",
    "effective_potential", "rigid_rotation", "restitution_ceiling",
)
REGIONAL = ("right_hand_side", "resting_rates", "energy_rates")
DIGEST = "730a5500fe2286f0ce9b5e7b62d95dff9d104d1a596f4c06647a4b063cfd22fb"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 33
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    adhesion = groups["adhesion"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    slip = orbital_rate - spin
    shear_force = 4*aspect*shear*slip*laws.shear.log_factor(gap, aspect)/(3*stokes)
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    lever = laws.arm.lever(distance)
    return {
        "gap": normal_velocity,
        "normal_velocity": centrifugal_force - attraction_force - film_force,
        "orbital_momentum": -distance*shear_force,
        "spin": 5*lever*shear_force/16,
    }


def inward_force(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Sum of the normal forces except the film's, over m v0^2/x0: positive inward.

    Total operations: 14
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    adhesion = groups["adhesion"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "inward_force": attraction_force - centrifugal_force,
    }


def events(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Event functions, each positive before its event: rebound criteria while closing, `turning` the normal
    velocity (negative while closing), `release` in resting contact.

    Total operations: 22
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    adhesion = groups["adhesion"]
    glass_number = groups["glass_number"]
    elastic_gap = groups["elastic_gap"]
    rough_gap = groups["rough_gap"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "turning": normal_velocity,
        "glass": glass_number - laws.glass.pressure(gap, -normal_velocity),
        "elastic": gap - elastic_gap,
        "rough": gap - rough_gap,
        "rupture": 1 - gap,
        "tangential_edge": laws.shear.edge(aspect) - gap,
        "release": attraction_force - centrifugal_force,
    }


def energy_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 30
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    adhesion = groups["adhesion"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    slip = orbital_rate - spin
    shear_force = 4*aspect*shear*slip*laws.shear.log_factor(gap, aspect)/(3*stokes)
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    lever = laws.arm.lever(distance)
    return {
        "normal_lubrication": film_force*normal_velocity,
        "attraction": attraction_force*normal_velocity,
        "tangential_lubrication": obliquity**2*shear_force*(distance*orbital_rate - 2*lever*spin)/16,
    }


def effective_potential(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of
    the least energy along the gap, capillary work included.

    Total operations: 25
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    adhesion = groups["adhesion"]
    distance = aspect*gap + 4
    momentum = orbital_momentum + 6.4*spin
    inertia_ratio = distance**2 + 6.4
    attraction_force = adhesion*laws.attraction.force(gap)/stokes
    return {
        "energy": momentum**2*obliquity**2/(32*inertia_ratio),
        "slope": attraction_force - aspect*distance*momentum**2*obliquity**2/(16*inertia_ratio**2),
    }
