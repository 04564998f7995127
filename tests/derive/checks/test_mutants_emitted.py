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
from wetdoublet.derive.physics.structure import Structure
from wetdoublet.derive.vocabulary import quantities as q

from .test_mutants import Healthy, Mutate, altered_force, caught

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("few_structures")]


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
            {pendulum.PULL: pendulum.pull_at(sp.Integer(1), q.beta)},
            {"recoil": {pendulum.REACH: pendulum.CONTACT}},
            "pull recoil",
        ),
    ],
    ids=[
        "nearest, half the pull",
        "farthest, from rest",
        "momentum, a tenth",
        "contact",
        "pull at beta",
        "reach, touch",
    ],
)
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


def _with(right: Callable[..., Any], name: Any, change: Callable[[sp.Expr], sp.Expr]) -> Callable[..., Any]:
    """A function of the structure with one of its values changed, where it has it."""

    def wrong(structure: Structure) -> dict[Any, sp.Expr]:
        found = right(structure)
        return {**found, name: change(found[name])} if name in found else found

    return wrong


@pytest.mark.parametrize(
    ("right", "name", "change", "check", "caught_by"),
    [
        (intermediates.resting_rates, q.orbital_momentum, lambda e: -e, resting_is_held, "resting contact"),
        (intermediates.resting_rates, q.normal_velocity, lambda e: e + 1, resting_is_held, "resting contact"),
        (observables.outputs, "tangential_restitution", lambda e: 2 * e, outputs_are_the_definitions, "outputs"),
        (observables.outputs, "final_spin", lambda e: -e, outputs_are_the_definitions, "outputs"),
        (observables.outputs, "restitution", lambda e: -e, outputs_are_the_definitions, "outputs"),
        (events.events, "rupture", lambda e: e + q.gap / 2, events_are_the_definitions, "events"),
        (events.events, "elastic", lambda e: e + q.elastic_gap / 2, events_are_the_definitions, "events"),
        (events.events, "rough", lambda e: e + q.rough_gap / 2, events_are_the_definitions, "events"),
        (
            events.events,
            "glass",
            lambda e: q.glass_number + slot_call("glass", "pressure", q.gap, -q.normal_velocity),
            events_are_the_definitions,
            "events",
        ),
        (events.events, "half_turn", lambda e: e + sp.pi, events_are_the_definitions, "events"),
        (events.events, "release", lambda e: -e, inward_is_minus_the_acceleration, "inward force"),
    ],
    ids=[
        "orbit at rest", "opening at rest", "e_t", "spin", "e_n",
        "rupture", "elastic", "rough", "glass", "half turn", "release",
    ],
)  # fmt: skip
def test_one_value_of_a_function(mutate: Mutate, healthy: Healthy, right, name, change, check, caught_by):
    """A sign, a factor or a shift in one value of resting rates, outputs or events, and nowhere else."""
    mutate(right, _with(right, name, change))
    caught(check(), healthy, caught_by)


def test_an_inward_force_that_pushes(mutate: Mutate, healthy: Healthy):
    """The sign of what holds a doublet in contact: it would rest where it should be thrown off."""
    right = intermediates.inward_force
    mutate(right, lambda structure: -right(structure))
    caught(inward_is_minus_the_acceleration(), healthy, "inward force")


def test_an_angular_momentum_of_another_measure(mutate: Mutate, healthy: Healthy):
    """L times the gap starts at 1 as it should, and is not L."""
    right = observables.angular_momentum
    mutate(right, lambda structure: right(structure) * q.gap)
    caught(momentum_is_the_bodies(), healthy, "emitted angular momentum")


@pytest.mark.parametrize("factor", [sp.Rational(1, 2), sp.Integer(-1)])
def test_a_tangential_force_of_another_size(mutate: Mutate, healthy: Healthy, factor):
    """Half of F_t dissipates and conserves L: only the published force tells."""
    altered_force(mutate, F_t, lambda force: factor * force)
    caught(tangential_force_is_the_published(), healthy, "tangential force")


def test_a_decomposition_with_half_the_shear(mutate: Mutate, healthy: Healthy):
    """Shear charged with half its power: the terms of e_n^2 - 1 do not add up."""
    right = observables.energy_rates
    half = _with(right, "tangential_lubrication", lambda e: e / 2)
    mutate(right, half)
    caught(decomposition(), healthy, "decomposition of e_n^2 - 1")


def test_a_decomposition_with_another_dry_loss(mutate: Mutate, healthy: Healthy):
    """A reversal charged with half its loss leaves the other half unaccounted for."""
    mutate(rebound_loss, lambda *_: q.normal_velocity**2 * (1 - q.e_dry**2) / 4)
    caught(decomposition(), healthy, "decomposition of e_n^2 - 1")
