"""Resting contact with friction in C: the series of its motion, and the forces of the dry contact.

The gap is held; the tangential states slide or roll. The recurrences are those of `resting_rates`, in a struct of their
own, so that the motion before and after costs no more than without friction.
"""

from collections.abc import Mapping

import sympy as sp

from ...equations import friction
from ...equations.model import Model
from ...vocabulary.quantities import normal_velocity
from .constants import Constants
from .layout import comment, compiled_if, documented, struct
from .ledger import BOOKED, Ledger
from .program import Program
from .recurrences import Recurrences

FLAGS = (friction.SLIDING, friction.ROLLING)
SERIES = ("slip", "limit", "holding", "reaction")  # the last alone in space, where a creep takes the place of rolling
GRIPS = {"grip_backward": "-", "grip_forward": "+"}  # largest friction less the one that acts, in both directions
_ARGUMENTS = "rubbing *s, const constants *c, vec film, vec shear, vec sliding, vec rolling, int k"
# Fields of the states that are integrals along a trajectory
QUADRATURES = (
    *compiled_if("CAPILLARY_STATE", ["vec capillary_work[TERMS];"]),
    *compiled_if("TURNING_STATE", ["vec turned[TERMS];"]),
)


class Resting:
    """The parts of a structure's header for resting contact with friction.

    Arguments:
        program: of `resting_rates` and of `SERIES`.
        results: rates of the states and the series of `SERIES`, by name.
        turning: rate of the angle turned, where it is a quadrature.
    """

    def __init__(
        self,
        model: Model,
        program: Program,
        constants: Constants,
        results: Mapping[str, str | sp.Expr],
        turning: str | sp.Expr | None,
    ) -> None:
        self.model, self.results, self.turning = model, results, turning
        self.recurrences = Recurrences(program, constants, lambda name: f"s->{name}")
        self.ledger = Ledger(model, program, self.recurrences, constants.beside(BOOKED), {normal_velocity: 0})
        self._series = [name for name in SERIES if name in results]
        self._grips = GRIPS if "holding" in results else {}

    def struct(self) -> list[str]:
        """The series, those of the states first, in their order."""
        fields = [f"vec {state.name}[TERMS];" for state in self.model.states]
        fields += [
            *QUADRATURES,
            *self.ledger.states(),
            *self.recurrences.fields(),
            *self.ledger.series(),
            *(f"vec rest_{name}[TERMS];" for name in (*self._series, *self._grips)),
        ]
        return [*comment("Series of resting contact with friction."), *struct("rubbing", fields)]

    def coefficients(self) -> list[str]:
        """Coefficient k of every series but those of the states, and k + 1 of the states."""
        rate, names = self.recurrences.rate, [state.name for state in self.model.states]
        rates = [f"s->{name}[k + 1] = {rate(self.results[name])}*next;" for name in names]
        rates += compiled_if("CAPILLARY_STATE", ["s->capillary_work[k + 1] = splat(0.0);"])
        if self.turning is not None:
            rates += compiled_if("TURNING_STATE", [f"s->turned[k + 1] = {rate(self.turning)}*next;"])
        return [
            *documented(
                "Coefficient k of the series that follow from the states, at last of the slip, of Coulomb's limit, of "
                "the force that holds rolling surfaces together, and of the reaction. Sliding has the sign of the slip "
                "or is 0, rolling is 1 or 0.",
                f"INLINE void rubbing_coefficients({_ARGUMENTS})",
                [
                    "(void)film; (void)shear; (void)sliding; (void)rolling;",
                    *self.recurrences.lines(),
                    *(f"s->rest_{name}[k] = {rate(self.results[name])};" for name in self._series),
                    *(
                        f"s->rest_{name}[k] = s->rest_limit[k] {sign} s->rest_holding[k];"
                        for name, sign in self._grips.items()
                    ),
                ],
            ),
            *documented(
                "Coefficient k + 1 of the states.",
                f"INLINE void rubbing_next({_ARGUMENTS})",
                [
                    "(void)c; (void)film; (void)shear; (void)sliding; (void)rolling;",
                    "double next = 1.0/(k + 1);",
                    *rates,
                    *self.ledger.coefficients(),
                ],
            ),
        ]
