"""Resting contact with friction in C: the series of its motion, and the forces of the dry contact.

The gap is held; the tangential states slide or roll. The recurrences are those of `resting_rates`, in a struct of their
own, so that the motion before and after costs no more than without friction.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from ...equations import friction
from ...equations.model import Model
from .c_text import Constants, Recurrences
from .layout import comment, function
from .program import Program

FLAGS = (friction.SLIDING, friction.ROLLING)
SERIES = ("slip", "limit", "holding", "reaction")


class Resting:
    """The parts of a structure's header for resting contact with friction.

    Arguments:
        program: of `resting_rates` and what `SERIES` are made of.
        rates: of the states, by name.
        more: the series of `SERIES`.
        turning: rate of the angle turned, where it is a quadrature.
    """

    def __init__(
        self,
        model: Model,
        program: Program,
        constants: Constants,
        rates: Mapping[str, str | sp.Expr],
        more: Mapping[str, str | sp.Expr],
        turning: str | sp.Expr | None,
    ) -> None:
        self.model, self.constants, self.rates, self.more, self.turning = model, constants, rates, more, turning
        self.made = Recurrences(program, constants, lambda name: f"s->{name}")

    def struct(self) -> list[str]:
        """The series, those of the states first, in their order."""
        lines = ["typedef struct {"]
        lines += [f"    vec {state.name}[TERMS];" for state in self.model.states]
        lines += ["#if CAPILLARY_STATE", "    vec capillary_work[TERMS];", "#endif"]
        lines += ["#if TURNING_STATE", "    vec turned[TERMS];", "#endif"]
        lines += [f"    {field}" for field in self.made.fields()]
        lines += [f"    vec rest_{name}[TERMS];" for name in SERIES]
        return [*comment("Series of resting contact with friction."), *lines, "} rubbing;", ""]

    def coefficients(self) -> list[str]:
        """Coefficient k of every series but those of the states, and k + 1 of the states."""
        rates = [f"s->{name.name}[k + 1] = {self._rate(self.rates[name.name])}*next;" for name in self.model.states]
        rates += ["#if CAPILLARY_STATE", "s->capillary_work[k + 1] = splat(0.0);", "#endif"]
        if self.turning is not None:
            rates += ["#if TURNING_STATE", f"s->turned[k + 1] = {self._rate(self.turning)}*next;", "#endif"]
        return [
            *comment(
                "Coefficient k of the series that follow from the states, at last of the slip, of Coulomb's limit, of "
                "the force that holds rolling surfaces together, and of the reaction. Sliding has the sign of the slip "
                "or is 0, rolling is 1 or 0."
            ),
            *function(
                "INLINE void rubbing_coefficients(rubbing *s, const constants *c, vec film, vec shear, vec sliding, "
                "vec rolling, int k)",
                [
                    "(void)film; (void)shear; (void)sliding; (void)rolling;",
                    *self.made.lines(),
                    *(f"s->rest_{name}[k] = {self._rate(self.more[name])};" for name in SERIES),
                ],
            ),
            "",
            *comment("Coefficient k + 1 of the states."),
            *function(
                "INLINE void rubbing_next(rubbing *s, const constants *c, int k)",
                ["(void)c;", "double next = 1.0/(k + 1);", *rates],
            ),
            "",
        ]

    def _rate(self, rate: str | sp.Expr) -> str:
        if isinstance(rate, str):
            return self.made.coefficient(rate)
        return f"(k == 0 ? {self.constants.text.vector(rate)} : splat(0.0))"
