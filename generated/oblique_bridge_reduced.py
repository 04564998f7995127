# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 d76574b5e8c063dadf18b6548bec1ce80c072871f4d8b39da6f2629f44e895ac
"""Oblique doublet with a liquid bridge, spin eliminated through the conserved angular momentum.

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

from .head_on import rebound_loss
from .head_on_bridge import energy_rates
from .oblique import restitution_ceiling, turning_rate
from .oblique_bridge import events, inward_force
from .oblique_reduced import energies, outputs, rebound, resting_rates, rigid_rotation, start, surface_slip


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity", "orbital_momentum")
GROUPS = (
    "stokes", "aspect", "obliquity", "initial_turning", "initial_spin", "capillary", "volume",
    "contact_angle", "glass_number", "elastic_gap", "rough_gap", "rupture_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "shear", "bridge")
FUNCTIONS = (
    "right_hand_side", "resting_rates", "turning_rate", "inward_force", "events", "rebound", "start",
    "energies", "energy_rates", "rebound_loss", "outputs", "surface_slip", "effective_potential",
    "rigid_rotation", "restitution_ceiling",
)
REGIONAL = ("right_hand_side", "resting_rates", "energy_rates")
DIGEST = "d76574b5e8c063dadf18b6548bec1ce80c072871f4d8b39da6f2629f44e895ac"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 42
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    orbital_momentum = state["orbital_momentum"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    distance = aspect*gap + 4
    orbital_rate = orbital_momentum/distance**2
    momentum = 6.4*initial_spin + initial_turning*(aspect + 4)**2
    spin = 5*momentum/32 - 5*orbital_momentum/32
    slip = orbital_rate - spin
    shear_force = 4*aspect*shear*slip*laws.shear.log_factor(gap, aspect)/(3*stokes)
    centrifugal_force = aspect*distance*obliquity**2*orbital_rate**2/16
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    return {
        "gap": normal_velocity,
        "normal_velocity": centrifugal_force - bridge_force - film_force,
        "orbital_momentum": -distance*shear_force,
    }


def effective_potential(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of
    the least energy along the gap, capillary work included.

    Total operations: 30
    """
    gap = state["gap"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    initial_turning = groups["initial_turning"]
    initial_spin = groups["initial_spin"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    distance = aspect*gap + 4
    momentum = 6.4*initial_spin + initial_turning*(aspect + 4)**2
    inertia_ratio = distance**2 + 6.4
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    return {
        "energy": momentum**2*obliquity**2/(32*inertia_ratio),
        "slope": bridge_force - aspect*distance*momentum**2*obliquity**2/(16*inertia_ratio**2),
    }
