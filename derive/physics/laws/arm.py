"""Lever arm of the tangential force about each sphere's centre."""

from __future__ import annotations

import sympy as sp

from .base import Law, LawFunction
from .references import PAPER

distance = sp.Symbol("distance", positive=True)  # r/a

ARMS = (
    Law(
        slot="arm",
        name="midgap",
        meaning="the tangential force acts at mid-gap, arm = r/2: conserves angular momentum identically",
        source="torque balance of the film about the centre of mass",
        functions=(LawFunction("lever", (distance,), distance / 2, "Arm over a, from the centre distance r/a."),),
    ),
    Law(
        slot="arm",
        name="surface",
        meaning="leading-order arm R = 2a: conserves angular momentum only to O(x/4a)",
        source=f"{PAPER.short}: leading order in the gap",
        functions=(LawFunction("lever", (distance,), sp.Integer(2), "Arm over a: the sphere radius."),),
        references=(PAPER,),
    ),
)
