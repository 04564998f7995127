# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 de6daef125dd7ea2f65f69c13d393df6e958d5ae294d4113eea61b7d054f82cc
"""Oblique doublet with pendulum strings.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- normal_velocity [v0]: normal velocity over impact speed, negative on approach
- orbital_momentum [a^2 Omega]: orbital angular momentum r^2 omega over a^2 Omega
- spin [Omega]: spin of each sphere over its scale Omega
- rotation [rad]: angle turned by the line of centres

Groups:
- stokes [1]: Stokes number m v0/(6 pi mu a^2)
- aspect [1]: film thickness over reduced radius, x0/a
- obliquity [1]: largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0
- initial_turning [1]: tan(theta0)/T, 1 without spins
- initial_spin [Omega]: spin at initial contact over Omega
- weight [1]: gravity over impact deceleration, g x0/v0^2
- string_ratio [1]: string length over reduced radius
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass, shear, arm, strings.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from casadi import pi, sin
from .head_on import rebound_loss
from .oblique import angular_momentum, energy_rates, outputs, surface_slip, turning_rate


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity", "orbital_momentum", "spin", "rotation")
GROUPS = (
    "stokes", "aspect", "obliquity", "initial_turning", "initial_spin", "weight", "string_ratio",
    "glass_number", "elastic_gap", "rough_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "shear", "arm", "strings")
FUNCTIONS = (
    "right_hand_side", "resting_rates", "turning_rate", "inward_force", "events", "rebound", "start",
    "energies", "energy_rates", "rebound_loss", "angular_momentum", "outputs", "surface_slip",
)
REGIONAL = ("right_hand_side", "resting_rates", "energy_rates")
DIGEST = "de6daef125dd7ea2f65f69c13d393df6e958d5ae294d4113eea61b7d054f82cc"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 59
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    rotation = state["rotation"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    slip = orbital_rate - spin
    shear_force = 4*aspect*shear*slip*laws.shear.log_factor(gap, aspect)/(3*stokes)
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    offset_squared = aspect**2*gap**2/4 + 4*distance*sin(rotation/2)**2
    string_pull = (
        weight*(aspect*gap + 8*sin(rotation/2)**2)*laws.strings.stiffness(string_ratio, offset_squared)
    )
    string_sideways = 16*weight*laws.strings.stiffness(string_ratio, offset_squared)*sin(rotation)/obliquity
    lever = laws.arm.lever(distance)
    return {
        "gap": normal_velocity,
        "normal_velocity": centrifugal_force - film_force - string_pull,
        "orbital_momentum": -distance*(shear_force + string_sideways),
        "spin": 5*lever*shear_force/16,
        "rotation": aspect*obliquity*orbital_rate/4,
    }


def resting_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0 in resting contact: the gap is held, the rotation goes on.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 38
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    rotation = state["rotation"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    slip = orbital_rate - spin
    shear_force = 4*aspect*shear*slip*laws.shear.log_factor(gap, aspect)/(3*stokes)
    offset_squared = aspect**2*gap**2/4 + 4*distance*sin(rotation/2)**2
    string_sideways = 16*weight*laws.strings.stiffness(string_ratio, offset_squared)*sin(rotation)/obliquity
    lever = laws.arm.lever(distance)
    return {
        "gap": 0,
        "normal_velocity": 0,
        "orbital_momentum": -distance*(shear_force + string_sideways),
        "spin": 5*lever*shear_force/16,
        "rotation": aspect*obliquity*orbital_rate/4,
    }


def inward_force(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Sum of the normal forces except the film's, over m v0^2/x0: positive inward.

    Total operations: 30
    """
    gap = state["gap"]
    orbital_momentum = state["orbital_momentum"]
    rotation = state["rotation"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    offset_squared = aspect**2*gap**2/4 + 4*distance*sin(rotation/2)**2
    string_pull = (
        weight*(aspect*gap + 8*sin(rotation/2)**2)*laws.strings.stiffness(string_ratio, offset_squared)
    )
    return {
        "inward_force": string_pull - centrifugal_force,
    }


def events(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Event functions, each positive before its event: rebound criteria while closing, `turning` the normal
    velocity (negative while closing), `release` in resting contact.

    Total operations: 39
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    rotation = state["rotation"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    glass_number = groups["glass_number"]
    elastic_gap = groups["elastic_gap"]
    rough_gap = groups["rough_gap"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    offset_squared = aspect**2*gap**2/4 + 4*distance*sin(rotation/2)**2
    string_pull = (
        weight*(aspect*gap + 8*sin(rotation/2)**2)*laws.strings.stiffness(string_ratio, offset_squared)
    )
    return {
        "turning": normal_velocity,
        "glass": glass_number - laws.glass.pressure(gap, -normal_velocity),
        "elastic": gap - elastic_gap,
        "rough": gap - rough_gap,
        "rupture": 1 - gap,
        "tangential_edge": laws.shear.edge(aspect) - gap,
        "release": string_pull - centrifugal_force,
        "half_turn": pi - rotation,
        "unwinding": orbital_momentum,
    }


def rebound(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State just after a rebound: u -> -e_dry u; the other states are continuous.

    Total operations: 2
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    rotation = state["rotation"]
    dry_restitution = groups["dry_restitution"]
    return {
        "gap": gap,
        "normal_velocity": -dry_restitution*normal_velocity,
        "orbital_momentum": orbital_momentum,
        "spin": spin,
        "rotation": rotation,
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
        "rotation": 0,
    }


def energies(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Energies of the state over m v0^2.

    Total operations: 32
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    spin = state["spin"]
    rotation = state["rotation"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    offset_squared = aspect**2*gap**2/4 + 4*distance*sin(rotation/2)**2
    return {
        "kinetic": distance**2*obliquity**2*orbital_rate**2/32 + normal_velocity**2/2 + 0.2*obliquity**2*spin**2,
        "strings": 4*weight*laws.strings.rise(string_ratio, offset_squared)/aspect,
    }
