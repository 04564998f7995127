# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 8217d49a2987033ea8c6b205dd70e1d5aee5d203720eb4ea80465efe075486b7
"""Head-on doublet with a liquid bridge and pendulum strings.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- normal_velocity [v0]: normal velocity over impact speed, negative on approach

Groups:
- stokes [1]: Stokes number m v0/(6 pi mu a^2)
- aspect [1]: film thickness over reduced radius, x0/a
- capillary [1]: capillary number 3 mu a v0/(sigma x0)
- volume [1]: bridge volume over R^3 (constant)
- contact_angle [rad]: contact angle of the liquid on the sphere
- weight [1]: gravity over impact deceleration, g x0/v0^2
- string_ratio [1]: string length over reduced radius
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- rupture_gap [x0]: rupture distance over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass, bridge, strings.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity")
GROUPS = (
    "stokes",
    "aspect",
    "capillary",
    "volume",
    "contact_angle",
    "weight",
    "string_ratio",
    "glass_number",
    "elastic_gap",
    "rough_gap",
    "rupture_gap",
    "dry_restitution",
)
SLOTS = ("film", "glass", "bridge", "strings")
FUNCTIONS = (
    "right_hand_side",
    "inward_force",
    "events",
    "rebound",
    "start",
    "energies",
    "energy_rates",
    "rebound_loss",
    "outputs",
    "effective_potential",
    "rigid_rotation",
)
REGIONAL = ("right_hand_side", "energy_rates")
DIGEST = "8217d49a2987033ea8c6b205dd70e1d5aee5d203720eb4ea80465efe075486b7"


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
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    offset_squared = aspect**2*gap**2/4
    string_pull = aspect*gap*weight*laws.strings.stiffness(string_ratio, offset_squared)
    return {
        "gap": normal_velocity,
        "normal_velocity": -bridge_force - film_force - string_pull,
    }


def inward_force(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Sum of the normal forces except the film's, over m v0^2/x0: positive inward.

    Total operations: 14
    """
    gap = state["gap"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    offset_squared = aspect**2*gap**2/4
    string_pull = aspect*gap*weight*laws.strings.stiffness(string_ratio, offset_squared)
    return {
        "inward_force": bridge_force + string_pull,
    }


def events(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Event functions, each positive before its event: rebound criteria while closing, `turning` the normal
    velocity (negative while closing), `release` in resting contact.

    Total operations: 7
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    glass_number = groups["glass_number"]
    elastic_gap = groups["elastic_gap"]
    rough_gap = groups["rough_gap"]
    rupture_gap = groups["rupture_gap"]
    return {
        "glass": glass_number - laws.glass.pressure(gap, -normal_velocity),
        "elastic": gap - elastic_gap,
        "rough": gap - rough_gap,
        "turning": normal_velocity,
        "rupture": rupture_gap - gap,
        "film_edge": 1 - gap,
    }


def rebound(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State just after a rebound: u -> -e_dry u; the other states are continuous.

    Total operations: 2
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    dry_restitution = groups["dry_restitution"]
    return {
        "gap": gap,
        "normal_velocity": -dry_restitution*normal_velocity,
    }


def start(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State at initial contact.

    Total operations: 1
    """
    return {
        "gap": 1,
        "normal_velocity": -1,
    }


def energies(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Energies of the state over m v0^2.

    Total operations: 10
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    aspect = groups["aspect"]
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    offset_squared = aspect**2*gap**2/4
    return {
        "kinetic": normal_velocity**2/2,
        "strings": 4*weight*laws.strings.rise(string_ratio, offset_squared)/aspect,
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
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    return {
        "normal_lubrication": film_force*normal_velocity,
        "capillary": bridge_force*normal_velocity,
    }


def rebound_loss(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Energy lost in a rebound that starts from this state, over m v0^2.

    Total operations: 5
    """
    normal_velocity = state["normal_velocity"]
    dry_restitution = groups["dry_restitution"]
    return {
        "dry_contact": normal_velocity**2*(1 - dry_restitution**2)/2,
    }


def outputs(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Results for a separated doublet: restitutions, and rates over their scale.

    Total operations: 0
    """
    normal_velocity = state["normal_velocity"]
    return {
        "restitution": normal_velocity,
    }


def effective_potential(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of
    the least energy along the gap, capillary work included.

    Total operations: 18
    """
    gap = state["gap"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    offset_squared = aspect**2*gap**2/4
    string_pull = aspect*gap*weight*laws.strings.stiffness(string_ratio, offset_squared)
    return {
        "energy": 4*weight*laws.strings.rise(string_ratio, offset_squared)/aspect,
        "slope": bridge_force + string_pull,
    }


def rigid_rotation(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """The state with this least energy: no normal velocity, rigid rotation.

    Total operations: 0
    """
    gap = state["gap"]
    return {
        "gap": gap,
        "normal_velocity": 0,
    }
