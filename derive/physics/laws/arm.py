"""Lever arm of the tangential force about each sphere's centre."""

import sympy as sp

from .base import Law, LawFunction
from .references import PAPER

distance = sp.Symbol("distance", positive=True)  # r/a

_MIDGAP = "the tangential force acts at mid-gap, arm = r/2: conserves angular momentum identically"
_SURFACE = "leading-order arm R = 2a: conserves angular momentum only to O(x/4a)"
_AT_MIDGAP = LawFunction("lever", (distance,), distance / 2, "Arm over a, from the centre distance r/a.")
_AT_SURFACE = LawFunction("lever", (distance,), sp.Integer(2), "Arm over a: the sphere radius.")

ARMS = (
    Law("arm", "midgap", _MIDGAP, "torque balance of the film about the centre of mass", (_AT_MIDGAP,)),
    Law("arm", "surface", _SURFACE, f"{PAPER.short}: leading order in the gap", (_AT_SURFACE,), references=(PAPER,)),
)
