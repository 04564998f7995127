# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 58fc0d1540d7345abe7da8eed61187f41c4cf9cff7fc21bf1bd49ee53838258e
"""Oblique sphere-wall doublet with a film only.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- normal_velocity [v0]: normal velocity over impact speed, negative on approach
- decay [1]: e-foldings of the slower mode of sliding and rolling beside a wall

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

from casadi import exp, sqrt
from .head_on import effective_potential, inward_force, rebound_loss


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity", "decay")
GROUPS = (
    "stokes", "aspect", "obliquity", "initial_turning", "initial_spin", "glass_number", "elastic_gap",
    "rough_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "shear")
FUNCTIONS = (
    "right_hand_side", "resting_rates", "inward_force", "events", "rebound", "start", "energies",
    "energy_rates", "rebound_loss", "outputs", "surface_slip", "effective_potential", "rigid_rotation",
    "escape_energy",
)
REGIONAL = ("right_hand_side", "resting_rates", "energy_rates")
DIGEST = "58fc0d1540d7345abe7da8eed61187f41c4cf9cff7fc21bf1bd49ee53838258e"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 14
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    return {
        "gap": normal_velocity,
        "normal_velocity": -film_force,
        "decay": aspect*shear*(14 - sqrt(46))*laws.shear.log_factor(gap, aspect)/(15*stokes),
    }


def resting_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0 in resting contact: the gap is held, the rotation goes on.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 9
    """
    gap = state["gap"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    return {
        "gap": 0,
        "normal_velocity": 0,
        "decay": aspect*shear*(14 - sqrt(46))*laws.shear.log_factor(gap, aspect)/(15*stokes),
    }


def events(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Event functions, each positive before its event: rebound criteria while closing, `turning` the normal
    velocity (negative while closing), `release` in resting contact.

    Total operations: 8
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    aspect = groups["aspect"]
    glass_number = groups["glass_number"]
    elastic_gap = groups["elastic_gap"]
    rough_gap = groups["rough_gap"]
    return {
        "turning": normal_velocity,
        "glass": glass_number - laws.glass.pressure(gap, -normal_velocity),
        "elastic": gap - elastic_gap,
        "rough": gap - rough_gap,
        "rupture": 1 - gap,
        "tangential_edge": laws.shear.edge(aspect) - gap,
    }


def rebound(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State just after a rebound: u -> -e_dry u; the other states are continuous.

    Total operations: 2
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    decay = state["decay"]
    dry_restitution = groups["dry_restitution"]
    return {
        "gap": gap,
        "normal_velocity": -dry_restitution*normal_velocity,
        "decay": decay,
    }


def start(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State at initial contact.

    Total operations: 1
    """
    return {
        "gap": 1,
        "normal_velocity": -1,
        "decay": 0,
    }


def energies(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Energies of the state over m v0^2.

    Total operations: 77
    """
    normal_velocity = state["normal_velocity"]
    decay = state["decay"]
    obliquity = groups["obliquity"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    slow_mode = exp(-decay)
    fast_mode = exp(decay*(-121/75 - 14*sqrt(46)/75))
    slide = (
        fast_mode*(initial_turning/2 - sqrt(46)*initial_spin/46 - 3*sqrt(46)*initial_turning/46)
        + slow_mode*(sqrt(46)*initial_spin/46 + 3*sqrt(46)*initial_turning/46 + initial_turning/2)
    )
    roll = (
        fast_mode*(3*sqrt(46)*initial_spin/46 + initial_spin/2 - 5*sqrt(46)*initial_turning/92)
        + slow_mode*(initial_spin/2 - 3*sqrt(46)*initial_spin/46 + 5*sqrt(46)*initial_turning/92)
    )
    return {
        "kinetic": normal_velocity**2/2 + obliquity**2*(0.2*roll**2 + slide**2/2),
    }


def energy_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 95
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    decay = state["decay"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    slow_mode = exp(-decay)
    fast_mode = exp(decay*(-121/75 - 14*sqrt(46)/75))
    slide = (
        fast_mode*(initial_turning/2 - sqrt(46)*initial_spin/46 - 3*sqrt(46)*initial_turning/46)
        + slow_mode*(sqrt(46)*initial_spin/46 + 3*sqrt(46)*initial_turning/46 + initial_turning/2)
    )
    roll = (
        fast_mode*(3*sqrt(46)*initial_spin/46 + initial_spin/2 - 5*sqrt(46)*initial_turning/92)
        + slow_mode*(initial_spin/2 - 3*sqrt(46)*initial_spin/46 + 5*sqrt(46)*initial_turning/92)
    )
    shear_force = 2*aspect*shear*(4*slide - roll)*laws.shear.log_factor(gap, aspect)/(15*stokes)
    torque = 2*aspect*shear*(slide - 4*roll)*laws.shear.log_factor(gap, aspect)/(15*stokes)
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    return {
        "normal_lubrication": film_force*normal_velocity,
        "tangential_lubrication": obliquity**2*(shear_force*slide - roll*torque),
    }


def outputs(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Results for a separated doublet: restitutions, and rates over their scale.

    Total operations: 68
    """
    normal_velocity = state["normal_velocity"]
    decay = state["decay"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    slow_mode = exp(-decay)
    fast_mode = exp(decay*(-121/75 - 14*sqrt(46)/75))
    slide = (
        fast_mode*(initial_turning/2 - sqrt(46)*initial_spin/46 - 3*sqrt(46)*initial_turning/46)
        + slow_mode*(sqrt(46)*initial_spin/46 + 3*sqrt(46)*initial_turning/46 + initial_turning/2)
    )
    roll = (
        fast_mode*(3*sqrt(46)*initial_spin/46 + initial_spin/2 - 5*sqrt(46)*initial_turning/92)
        + slow_mode*(initial_spin/2 - 3*sqrt(46)*initial_spin/46 + 5*sqrt(46)*initial_turning/92)
    )
    return {
        "restitution": normal_velocity,
        "tangential_restitution": slide/initial_turning,
        "final_rotation_rate": 0,
        "final_spin": roll,
    }


def surface_slip(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Relative velocity of the surfaces at the contact, at the lever arm of the shear, over a Omega.

    Total operations: 68
    """
    decay = state["decay"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    slow_mode = exp(-decay)
    fast_mode = exp(decay*(-121/75 - 14*sqrt(46)/75))
    slide = (
        fast_mode*(initial_turning/2 - sqrt(46)*initial_spin/46 - 3*sqrt(46)*initial_turning/46)
        + slow_mode*(sqrt(46)*initial_spin/46 + 3*sqrt(46)*initial_turning/46 + initial_turning/2)
    )
    roll = (
        fast_mode*(3*sqrt(46)*initial_spin/46 + initial_spin/2 - 5*sqrt(46)*initial_turning/92)
        + slow_mode*(initial_spin/2 - 3*sqrt(46)*initial_spin/46 + 5*sqrt(46)*initial_turning/92)
    )
    return {
        "surface_slip": slide - roll,
    }


def rigid_rotation(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """The state with this least energy: no normal velocity, rigid rotation.

    Total operations: 0
    """
    gap = state["gap"]
    decay = state["decay"]
    return {
        "gap": gap,
        "normal_velocity": 0,
        "decay": decay,
    }


def escape_energy(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Kinetic energy over m v0^2 of the motion along the line of centres, the only one that can separate sphere
    and wall.

    Total operations: 2
    """
    normal_velocity = state["normal_velocity"]
    return {
        "kinetic": normal_velocity**2/2,
    }
