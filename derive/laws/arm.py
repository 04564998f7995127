"""Lever arm of the tangential force about each sphere's centre."""

from ..physics.slots import MIDGAP, distance
from ..user import law

law(
    "arm", "midgap", source="torque balance of the film about the centre of mass",
    meaning="the tangential force acts at mid-gap, arm = r/2: conserves angular momentum identically",
    lever=MIDGAP["arm"]["lever"](distance),
)  # fmt: skip
