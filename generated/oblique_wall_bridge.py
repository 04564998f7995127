# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 59f22c08ccfef4f050c67262a0cca7d477920b7f4f900486819dfd84d0b69af8
"""Oblique sphere-wall doublet with a liquid bridge.

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
- capillary [1]: capillary number 3 mu a v0/(sigma x0)
- volume [1]: bridge volume over R^3 (constant)
- contact_angle [rad]: contact angle of the liquid on the sphere
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- rupture_gap [x0]: rupture distance over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass, shear, bridge.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from casadi import exp, sqrt
from .head_on import rebound_loss
from .head_on_bridge import effective_potential, inward_force
from .oblique_wall import (
    energies, escape_energy, outputs, rebound, resting_rates, rigid_rotation, start, surface_slip,
)


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity", "decay")
GROUPS = (
    "stokes", "aspect", "obliquity", "initial_turning", "initial_spin", "capillary", "volume",
    "contact_angle", "glass_number", "elastic_gap", "rough_gap", "rupture_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "shear", "bridge")
FUNCTIONS = (
    "right_hand_side", "resting_rates", "inward_force", "events", "rebound", "start", "energies",
    "energy_rates", "rebound_loss", "outputs", "surface_slip", "effective_potential", "rigid_rotation",
    "escape_energy",
)
REGIONAL = ("right_hand_side", "resting_rates", "energy_rates")
DIGEST = "59f22c08ccfef4f050c67262a0cca7d477920b7f4f900486819dfd84d0b69af8"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 20
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    return {
        "gap": normal_velocity,
        "normal_velocity": -bridge_force - film_force,
        "decay": aspect*shear*(14 - sqrt(46))*laws.shear.log_factor(gap, aspect)/(15*stokes),
    }


def events(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Event functions, each positive before its event: rebound criteria while closing, `turning` the normal
    velocity (negative while closing), `release` in resting contact.

    Total operations: 9
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    aspect = groups["aspect"]
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
        "film_edge": 1 - gap,
        "tangential_edge": laws.shear.edge(aspect) - gap,
    }


def energy_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 101
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    decay = state["decay"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
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
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    return {
        "normal_lubrication": film_force*normal_velocity,
        "capillary": bridge_force*normal_velocity,
        "tangential_lubrication": obliquity**2*(shear_force*slide - roll*torque),
    }
