"""The slots that laws fill: their functions, the dimensionless arguments of these and the same in SI, and scales."""

from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import sympy as sp

from ..vocabulary import quantities as q
from ..vocabulary.dimensions import ONE, Dimension, dimension_of
from .forces import FILM, SHEAR, force_laws
from .law import Law, LawFunction, slot_calls
from .pendulum import offset_squared
from .scaling import LUBRICATION_PRESSURE

h = sp.Symbol("gap_over_radius", positive=True)  # x/R
distance = sp.Symbol("distance", positive=True)  # r/a
approach = sp.Symbol("approach", real=True)  # -u/v0, positive while closing


@dataclass(frozen=True)
class Place:
    """A function of a slot.

    Arguments:
        arguments: its dimensionless arguments.
        optional: not every law of the slot has it.
        for_proof: used by a stick certificate only, which is not available without it.
        at: the same arguments in SI quantities; empty if the function has no SI form.
        scale: factor from the function to its SI value; 1 if the function has no SI form.
    """

    slot: str
    function: str
    arguments: tuple[sp.Symbol, ...]
    doc: str
    optional: bool = False
    for_proof: bool = False
    at: tuple[sp.Expr, ...] = ()
    scale: sp.Expr = sp.S.One

    @property
    def dimension(self) -> Dimension:
        return dimension_of(self.scale, q.DIMENSIONS) or ONE

    @property
    def required(self) -> bool:
        return not (self.optional or self.for_proof)

    @property
    def closed(self) -> bool:
        """Called where groups of a user's model are not at hand: a function of its arguments alone."""
        return self.for_proof or self.function == "rupture_distance"

    @property
    def spread(self) -> "Place":
        """The function of a film whose rim follows the volume of the bridge."""
        return replace(self, arguments=(*self.arguments, q.aspect, q.volume), at=(*self.at, q.x0 / q.a, q.volume))


FILM_FORCE, INSIDE = "Normal film force over 6 pi mu a^2 u/x0", "for a gap inside the film (gap < 1)"
_STRINGS = (q.string_ratio, offset_squared)
_TAKEN = "Velocity, over v0/St, that the film takes from"
_RESTORING = "Horizontal restoring force over weight and swing d/a: a/sqrt(l^2 - d^2)."
_FUNCTIONS = (
    Place("film", "resistance", (q.gap,), f"{FILM_FORCE}, {INSIDE}."),
    Place("film", "suction", (q.gap,), "What of the resistance is left while opening.", optional=True),
    Place("film", "stopping", (q.gap,), f"{_TAKEN} a doublet opening from this gap to x0.", for_proof=True),
    Place("film", "braking", (q.gap,), f"{_TAKEN} an approach from x0 to this gap.", for_proof=True),
    Place("shear", "log_factor", (q.gap, q.aspect), "Tangential force over 8 pi mu a^2 (omega - xi), inside its edge."),
    Place("shear", "edge", (q.aspect,), "Gap (in film thicknesses) beyond which there is no tangential force."),
    Place("arm", "lever", (distance,), "Arm over a, from the centre distance r/a."),
    Place("glass", "pressure", (q.gap, approach), "Film pressure on the axis over 3 mu a v0/x0^2."),
    Place("glass", "reach", (approach, q.glass_number), "Gap at which this approach speed meets the criterion.",
          for_proof=True),
    Place("bridge", "force", (h, q.volume, q.contact_angle), "Capillary attraction over pi R sigma."),
    Place("bridge", "rupture_distance", (q.volume, q.contact_angle), "Rupture distance over R that goes with this law.",
          optional=True),
    Place("strings", "rise", _STRINGS, "Height gained by each sphere over a."),
    Place("strings", "stiffness", _STRINGS, _RESTORING),
    Place("attraction", "force", (q.gap,), "Attraction over A a/(6 x0^2)."),
    Place("attraction", "potential", (q.gap,), "Potential energy over A a/(6 x0), zero far away.", optional=True),
)  # fmt: skip
SLOTS = tuple(dict.fromkeys(place.slot for place in _FUNCTIONS))
MIDGAP = {"arm": Law("arm", "midgap", "", "", (LawFunction("lever", (distance,), distance / 2, ""),))}
"""The lever arm at which the torques of the film about the centre of mass balance."""


@cache
def places() -> dict[str, Place]:
    """Every function of every slot, by `slot.function`; scales and SI arguments are taken from the force laws."""
    scaled = _scaled()
    entries = {f"{place.slot}.{place.function}": place for place in _FUNCTIONS}
    return {key: replace(place, **scaled.get(key, {})) for key, place in entries.items()}


def place_of(slot: str, function: str, spread: bool = False) -> Place:
    """A function of a slot, for a law whose film has its rim as `spread` says."""
    place = places()[f"{slot}.{function}"]
    return place.spread if spread else place


def _scaled() -> dict[str, dict[str, Any]]:
    """Arguments in SI and factor of the call in a force that is a single call times a factor."""
    result: dict[str, dict[str, Any]] = {
        "glass.pressure": {"at": (q.x / q.x0, -q.u / q.v0), "scale": LUBRICATION_PRESSURE},
        "shear.edge": {"at": (q.aspect,), "scale": q.x0},
        "bridge.rupture_distance": {"at": (q.volume, q.contact_angle), "scale": q.R},
    }
    for force in force_laws().values():
        calls = slot_calls(force)
        if len(calls) != 1 or calls[0].func.__name__.startswith("strings."):
            continue  # rise and stiffness of the strings share one pair of arguments
        factor = force.subs({FILM: 1, SHEAR: 1}).xreplace({calls[0]: sp.Integer(1)})
        result[calls[0].func.__name__] = {"at": calls[0].args, "scale": factor}
    return result


MOTION: dict[str, tuple[sp.Symbol, ...]] = {"film": (q.normal_velocity,), "shear": (q.normal_velocity,)}
"""States other than the gap that a slot's law may depend on: what the stick certificates do not need to know."""
