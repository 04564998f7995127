"""Functions emitted beside the right-hand side, and the margins of the stick proof: each mutant caught by its check."""

from collections.abc import Callable
from typing import Any

import pytest
import sympy as sp
from wetdoublet.derive.checks.emitted import (
    events_are_the_definitions,
    inward_is_minus_the_acceleration,
    momentum_is_the_bodies,
    outputs_are_the_definitions,
    resting_is_held,
    tangential_force_is_the_published,
)
from wetdoublet.derive.checks.pendulum_certificate import margins_are_the_lemmas
from wetdoublet.derive.checks.restitution import decomposition
from wetdoublet.derive.equations import events, intermediates, observables
from wetdoublet.derive.equations.certificates import pendulum
from wetdoublet.derive.equations.events import rebound_loss
from wetdoublet.derive.physics.law import slot_call
from wetdoublet.derive.physics.mechanics import F_t
from wetdoublet.derive.vocabulary import quantities as q

from .test_mutants import Healthy, Mutate, Mutation, caught, force, value_of

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("few_structures")]


def times(right: Callable[..., Any], factor: Any) -> Mutation:
    """The mutation of a function by a factor."""
    return lambda mutate: mutate(right, lambda structure: right(structure) * factor)


_SLOWER = {pendulum.FASTEST: pendulum.FASTEST / 10}
_REST = sp.sqrt(2 * pendulum.LARGEST_PULL)
_HALF_THE_PULL = sp.sqrt(sp.Min(q.normal_velocity, 0) ** 2 + pendulum.LARGEST_PULL)


# Bounds taken where they are not the worst, what is wrong with margins themselves, and the margins that are caught.
# Of different margins several are derived at once.
@pytest.mark.parametrize(
    ("bounds", "margins", "names"),
    [
        ({pendulum.NEAREST: 4 + q.aspect, pendulum.FASTEST: _HALF_THE_PULL}, {}, "outward recoil"),
        ({pendulum.FARTHEST: 4 + q.aspect * pendulum.CONTACT, pendulum.FASTEST: _REST}, {}, "outward recoil"),
        ({pendulum.LARGEST_MOMENTUM: q.orbital_momentum}, {"recoil": _SLOWER}, "outward recoil"),
        ({pendulum.CONTACT: q.rough_gap}, {}, "outward pull recoil"),
        ({pendulum.LARGEST_PULL: pendulum.pull_at(sp.Integer(1), q.beta)}, {}, "recoil beneath"),
        (
            {pendulum.PULL: pendulum.pull_at(sp.Integer(1), q.beta)}, {"recoil": {pendulum.REACH: pendulum.CONTACT}},
            "pull recoil",
        ),
    ],
    ids=["nearest, half the pull", "farthest, from rest", "momentum, a tenth", "contact", "pull at beta", "reach"],
)  # fmt: skip
def test_a_margin_that_is_not_the_worst(mutate: Mutate, healthy: Healthy, bounds, margins, names):
    """Each wrong distance, orbit, contact, pull, speed or reach of a rebound is caught by the margins that have it."""
    outputs = {name: value for _, _, values in pendulum.functions() for name, value in values.items()}
    wrong = {name: value.subs(margins.get(name, {})) for name, value in outputs.items()}
    right = dict(pendulum.definitions())
    assert all(right[name] != value for name, value in bounds.items())
    assert all(wrong[name] != outputs[name] for name in margins)
    mutate(pendulum.definitions, lambda *_: tuple({**right, **bounds}.items()))
    mutate(pendulum.functions, lambda *_: [("margins", "", wrong)])
    caught(margins_are_the_lemmas(), healthy, *(f"margin of the stick proof: {each}" for each in names.split()))


MUTANTS: dict[str, tuple[Mutation, Callable[[], Any], str]] = {
    "orbit at rest": (
        value_of(intermediates.resting_rates, q.orbital_momentum, lambda e: -e), resting_is_held, "resting contact",
    ),
    "output final_spin": (
        value_of(observables.outputs, "final_spin", lambda e: -e), outputs_are_the_definitions, "outputs",
    ),
    **{
        f"event {name}": (value_of(events.events, name, change), events_are_the_definitions, "events")
        for name, change in (
            ("half_turn", lambda e: e + sp.pi),
            ("glass", lambda e: q.glass_number + slot_call("glass", "pressure", q.gap, -q.normal_velocity)),
        )
    },
    # it would rest where it should be thrown off
    "an inward force that pushes": (
        times(intermediates.inward_force, -1), inward_is_minus_the_acceleration, "inward force",
    ),
    # it starts at 1 as it should, and is not L
    "L times the gap": (times(observables.angular_momentum, q.gap), momentum_is_the_bodies, "emitted angular momentum"),
    # half of F_t dissipates and conserves L: only the published force tells
    "half of F_t": (force(F_t, lambda f: f / 2), tangential_force_is_the_published, "tangential force"),
    "e_n^2 - 1 with half the shear": (
        value_of(observables.energy_rates, "tangential_lubrication", lambda e: e / 2), decomposition,
        "decomposition of e_n^2 - 1",
    ),
    "e_n^2 - 1 with half the loss of a reversal": (
        lambda mutate: mutate(rebound_loss, lambda *_: q.normal_velocity**2 * (1 - q.e_dry**2) / 4), decomposition,
        "decomposition of e_n^2 - 1",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MUTANTS)
def test_a_mutant_is_caught(mutate: Mutate, healthy: Healthy, name: str):
    """A sign, a factor or a shift in one value of what is emitted, and nowhere else."""
    mutation, check, by = MUTANTS[name]
    mutation(mutate)
    caught(check(), healthy, by)
