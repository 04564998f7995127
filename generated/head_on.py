# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 5bb85b7457d42805a0bc607bb05b818a64a138863ee7dcc49b2d16aff121d307
"""Head-on doublet with a film only.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- normal_velocity [v0]: normal velocity over impact speed, negative on approach

Groups:
- stokes [1]: Stokes number m v0/(6 pi mu a^2)
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity")
GROUPS = ("stokes", "glass_number", "elastic_gap", "rough_gap", "dry_restitution")
SLOTS = ("film", "glass")
FUNCTIONS = (
    "right_hand_side", "inward_force", "events", "rebound", "start", "energies", "energy_rates",
    "rebound_loss", "outputs", "effective_potential", "rigid_rotation", "restitution_ceiling",
)
REGIONAL = ("right_hand_side", "energy_rates")
DIGEST = "5bb85b7457d42805a0bc607bb05b818a64a138863ee7dcc49b2d16aff121d307"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 5
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    stokes = groups["stokes"]
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    return {
        "gap": normal_velocity,
        "normal_velocity": -film_force,
    }


def inward_force(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Sum of the normal forces except the film's, over m v0^2/x0: positive inward.

    Total operations: 0
    """
    return {
        "inward_force": 0,
    }


def events(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Event functions, each positive before its event: rebound criteria while closing, `turning` the normal
    velocity (negative while closing), `release` in resting contact.

    Total operations: 6
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    glass_number = groups["glass_number"]
    elastic_gap = groups["elastic_gap"]
    rough_gap = groups["rough_gap"]
    return {
        "turning": normal_velocity,
        "glass": glass_number - laws.glass.pressure(gap, -normal_velocity),
        "elastic": gap - elastic_gap,
        "rough": gap - rough_gap,
        "rupture": 1 - gap,
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

    Total operations: 2
    """
    normal_velocity = state["normal_velocity"]
    return {
        "kinetic": normal_velocity**2/2,
    }


def energy_rates(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 5
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    stokes = groups["stokes"]
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    return {
        "normal_lubrication": film_force*normal_velocity,
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

    Total operations: 0
    """
    return {
        "energy": 0,
        "slope": 0,
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


def restitution_ceiling(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Upper bound of e_n^2 for separation at this gap, from the initial energy and angular momentum, without the
    work of attractions: 2 (W_c(x_f) - W_c(x0))/(m v0^2) is still to be subtracted.

    Total operations: 0
    """
    return {
        "squared": 1,
    }
