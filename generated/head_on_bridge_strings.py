# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 c778c6494f8f28b5c799d49f8248dadac6ee6692172c9c360d9ff87bb3a10f64
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

from .head_on import outputs, rebound, rebound_loss, rigid_rotation, start
from .head_on_bridge import energy_rates, events
from .head_on_strings import energies


Values = Mapping[str, Any]

STATES = ("gap", "normal_velocity")
GROUPS = (
    "stokes", "aspect", "capillary", "volume", "contact_angle", "weight", "string_ratio", "glass_number",
    "elastic_gap", "rough_gap", "rupture_gap", "dry_restitution",
)
SLOTS = ("film", "glass", "bridge", "strings")
FUNCTIONS = (
    "right_hand_side", "inward_force", "events", "rebound", "start", "energies", "energy_rates",
    "rebound_loss", "outputs", "effective_potential", "rigid_rotation",
)
REGIONAL = ("right_hand_side", "energy_rates")
DIGEST = "c778c6494f8f28b5c799d49f8248dadac6ee6692172c9c360d9ff87bb3a10f64"


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
