"""Lever arm of the tangential force about each sphere's centre."""

import sympy as sp

from .base import Law, LawFunction

distance = sp.Symbol("distance", positive=True)  # r/a

_MIDGAP = "the tangential force acts at mid-gap, arm = r/2: conserves angular momentum identically"
_AT_MIDGAP = LawFunction("lever", (distance,), distance / 2, "Arm over a, from the centre distance r/a.")

ARMS = (Law("arm", "midgap", _MIDGAP, "torque balance of the film about the centre of mass", (_AT_MIDGAP,)),)
