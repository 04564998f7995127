# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 bc94045a07b71a949f169f6ecfa1b92c789a0545cba490e448ede4529fd01997
"""Oblique sphere-wall doublet with a liquid bridge, a film whose rim follows the bridge's volume.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- opening [v0]: opening velocity over impact speed, negative on approach
- slide [v0 tan(theta0)]: tangential velocity of centre and wall over its first
- roll [v0 tan(theta0)/a]: spin beside a wall

Groups:
- stokes [1]: Stokes number m v0/(6 pi mu a^2)
- aspect [1]: film thickness over reduced radius, x0/a
- obliquity [1]: tangent of the impact angle
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


Values = Mapping[str, Any]

STATES = ("gap", "opening", "slide", "roll")
GROUPS = (
    "stokes",
    "aspect",
    "obliquity",
    "capillary",
    "volume",
    "contact_angle",
    "glass_number",
    "elastic_gap",
    "rough_gap",
    "rupture_gap",
    "dry_restitution",
)
SLOTS = ("film", "glass", "shear", "bridge")
FUNCTIONS = (
    "right_hand_side",
    "resting_rates",
    "inward_force",
    "events",
    "reversal",
    "start",
    "energies",
    "energy_rates",
    "reversal_loss",
    "outputs",
    "effective_potential",
    "rigid_rotation",
    "escape_energy",
)
REGIONAL = ("right_hand_side", "resting_rates", "energy_rates")
DIGEST = "bc94045a07b71a949f169f6ecfa1b92c789a0545cba490e448ede4529fd01997"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 32
    """
    gap = state["gap"]
    opening = state["opening"]
    slide = state["slide"]
    roll = state["roll"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    shear_force = 2*aspect*shear*(4*slide - roll)*laws.shear.log_factor(gap, aspect)/(15*stokes)
    torque = 2*aspect*shear*(slide - 4*roll)*laws.shear.log_factor(gap, aspect)/(15*stokes)
    film_force = film*opening*laws.film.resistance(gap, aspect, volume)/stokes
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    return {
        "gap": opening,
        "opening": -bridge_force - film_force,
        "slide": -shear_force,
        "roll": 5*torque/2,
    }


def resting_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0 in resting contact: gap held, the rotation goes on.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 21
    """
    gap = state["gap"]
    slide = state["slide"]
    roll = state["roll"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    shear_force = 2*aspect*shear*(4*slide - roll)*laws.shear.log_factor(gap, aspect)/(15*stokes)
    torque = 2*aspect*shear*(slide - 4*roll)*laws.shear.log_factor(gap, aspect)/(15*stokes)
    return {
        "gap": 0,
        "opening": 0,
        "slide": -shear_force,
        "roll": 5*torque/2,
    }


def inward_force(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """What holds a doublet at rest together, over m v0^2/x0: positive inward.

    Total operations: 5
    """
    gap = state["gap"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    return {
        "inward_force": bridge_force,
    }


def events(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Event functions, each positive before its event: the criteria while closing, `turning` the opening
    velocity (its sign tells closing from opening), `release` in resting contact.

    Total operations: 8
    """
    gap = state["gap"]
    opening = state["opening"]
    aspect = groups["aspect"]
    glass_number = groups["glass_number"]
    elastic_gap = groups["elastic_gap"]
    rough_gap = groups["rough_gap"]
    rupture_gap = groups["rupture_gap"]
    return {
        "glass": glass_number - laws.glass.pressure(gap, -opening),
        "elastic": gap - elastic_gap,
        "rough": gap - rough_gap,
        "turning": opening,
        "rupture": rupture_gap - gap,
        "tangential_edge": laws.shear.edge(aspect) - gap,
    }


def reversal(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State just after a reversal by the solids: u -> -e_dry u, all else continues.

    Total operations: 2
    """
    gap = state["gap"]
    opening = state["opening"]
    slide = state["slide"]
    roll = state["roll"]
    dry_restitution = groups["dry_restitution"]
    return {
        "gap": gap,
        "opening": -dry_restitution*opening,
        "slide": slide,
        "roll": roll,
    }


def start(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """State at first touch.

    Total operations: 1
    """
    return {
        "gap": 1,
        "opening": -1,
        "slide": 1,
        "roll": 0,
    }


def energies(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Energies of the state over m v0^2.

    Total operations: 10
    """
    opening = state["opening"]
    slide = state["slide"]
    roll = state["roll"]
    obliquity = groups["obliquity"]
    return {
        "kinetic": obliquity**2*(0.2*roll**2 + slide**2/2) + opening**2/2,
    }


def energy_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Energy taken per x0/v0 by the film, the bridge and the shear, over m v0^2.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 34
    """
    gap = state["gap"]
    opening = state["opening"]
    slide = state["slide"]
    roll = state["roll"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    obliquity = groups["obliquity"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    shear_force = 2*aspect*shear*(4*slide - roll)*laws.shear.log_factor(gap, aspect)/(15*stokes)
    torque = 2*aspect*shear*(slide - 4*roll)*laws.shear.log_factor(gap, aspect)/(15*stokes)
    film_force = film*opening*laws.film.resistance(gap, aspect, volume)/stokes
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    return {
        "normal_lubrication": film_force*opening,
        "capillary": bridge_force*opening,
        "tangential_lubrication": obliquity**2*(shear_force*slide - roll*torque),
    }


def reversal_loss(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Energy lost in a reversal that starts from this state, over m v0^2.

    Total operations: 5
    """
    opening = state["opening"]
    dry_restitution = groups["dry_restitution"]
    return {
        "dry_contact": opening**2*(1 - dry_restitution**2)/2,
    }


def outputs(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """What a separated doublet shows: restitutions, and rates over omega0.

    Total operations: 0
    """
    opening = state["opening"]
    slide = state["slide"]
    roll = state["roll"]
    return {
        "restitution": opening,
        "tangential_restitution": slide,
        "final_rotation_rate": 0,
        "final_spin": roll,
    }


def effective_potential(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Least energy over m v0^2 of a doublet with this gap and angular momentum, capillary work left out, and the
    slope with it.

    Total operations: 5
    """
    gap = state["gap"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    capillary = groups["capillary"]
    volume = groups["volume"]
    contact_angle = groups["contact_angle"]
    bridge_force = laws.bridge.force(aspect*gap/2, volume, contact_angle)/(capillary*stokes)
    return {
        "energy": 0,
        "slope": bridge_force,
    }


def rigid_rotation(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """The state that has this least energy: at rest in the gap, turning as one body.

    Total operations: 0
    """
    gap = state["gap"]
    slide = state["slide"]
    roll = state["roll"]
    return {
        "gap": gap,
        "opening": 0,
        "slide": slide,
        "roll": roll,
    }


def escape_energy(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Energy over m v0^2 of the motion along the line of centres, which alone can part the two.

    Total operations: 2
    """
    opening = state["opening"]
    return {
        "kinetic": opening**2/2,
    }
