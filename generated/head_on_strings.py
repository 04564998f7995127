# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 f28e8cc4792a48c36b88dd16465fbe754866335ac5f30cbfec3a05a1aecfd715
"""Head-on doublet with pendulum strings.

Time in x0/v0. States (per unit):
- gap [x0]: gap over film thickness
- normal_velocity [v0]: normal velocity over impact speed, negative on approach

Groups:
- stokes [1]: Stokes number m v0/(6 pi mu a^2)
- aspect [1]: film thickness over reduced radius, x0/a
- weight [1]: gravity over impact deceleration, g x0/v0^2
- string_ratio [1]: string length over reduced radius
- glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
- elastic_gap [x0]: elastic length over film thickness
- rough_gap [x0]: roughness over film thickness
- dry_restitution [1]: restitution of the dry contact

Law slots: film, glass, strings.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .head_on import energy_rates, events, outputs, rebound, rebound_loss, rigid_rotation, start


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity")
GROUPS = (
    "stokes", "aspect", "weight", "string_ratio", "glass_number", "elastic_gap", "rough_gap",
    "dry_restitution",
)
SLOTS = ("film", "glass", "strings")
FUNCTIONS = (
    "right_hand_side", "inward_force", "events", "rebound", "start", "energies", "energy_rates",
    "rebound_loss", "outputs", "effective_potential", "rigid_rotation",
)
REGIONAL = ("right_hand_side", "energy_rates")
DIGEST = "f28e8cc4792a48c36b88dd16465fbe754866335ac5f30cbfec3a05a1aecfd715"


def right_hand_side(state: Values, groups: Values, laws: Any, film: int = 1, shear: int = 1) -> dict[str, Any]:
    """Rates of the states per v0/x0.

    Region: film is 1 inside the film, shear 1 inside the tangential edge, else 0.

    Total operations: 14
    """
    gap = state["gap"]
    normal_velocity = state["normal_velocity"]
    stokes = groups["stokes"]
    aspect = groups["aspect"]
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    film_force = film*normal_velocity*laws.film.resistance(gap)/stokes
    offset_squared = aspect**2*gap**2/4
    string_pull = aspect*gap*weight*laws.strings.stiffness(string_ratio, offset_squared)
    return {
        "gap": normal_velocity,
        "normal_velocity": -film_force - string_pull,
    }


def inward_force(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Sum of the normal forces except the film's, over m v0^2/x0: positive inward.

    Total operations: 8
    """
    gap = state["gap"]
    aspect = groups["aspect"]
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    offset_squared = aspect**2*gap**2/4
    string_pull = aspect*gap*weight*laws.strings.stiffness(string_ratio, offset_squared)
    return {
        "inward_force": string_pull,
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


def effective_potential(state: Values, groups: Values, laws: Any) -> dict[str, Any]:
    """Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of
    the least energy along the gap, capillary work included.

    Total operations: 12
    """
    gap = state["gap"]
    aspect = groups["aspect"]
    weight = groups["weight"]
    string_ratio = groups["string_ratio"]
    offset_squared = aspect**2*gap**2/4
    string_pull = aspect*gap*weight*laws.strings.stiffness(string_ratio, offset_squared)
    return {
        "energy": 4*weight*laws.strings.rise(string_ratio, offset_squared)/aspect,
        "slope": string_pull,
    }
