"""Deliberately broken models are caught, each by the check whose law it breaks; the right model passes that check."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import pytest
import sympy as sp
from wetdoublet.derive.checks import Check
from wetdoublet.derive.checks.admission import certificate
from wetdoublet.derive.checks.certificate import least_energy, least_energy_is_a_minimum
from wetdoublet.derive.checks.conservation import energy, inertia_is_rigid_rotation, strings_are_conservative
from wetdoublet.derive.checks.dimensions import (
    centrifugal_number,
    dimension_checks,
    groups_are_the_papers,
    groups_span_the_nullspace,
    si_equations,
)
from wetdoublet.derive.checks.dissipation import arms, bridge_does_work, film_dissipates, rebound_dissipates
from wetdoublet.derive.checks.laws import film_ends, head_on_closed_form, rigid_rotation_is_free, small_angle_is_linear
from wetdoublet.derive.checks.limits import reduced_is_full
from wetdoublet.derive.checks.restitution import ceiling_is_the_published
from wetdoublet.derive.equations import observables
from wetdoublet.derive.equations.events import rebound, rebound_loss
from wetdoublet.derive.equations.intermediates import CENTRIFUGAL_FORCE, intermediates
from wetdoublet.derive.laws import LAWS
from wetdoublet.derive.physics import forces
from wetdoublet.derive.physics.law import Law
from wetdoublet.derive.physics.mechanics import F_c, F_n, F_t, S_t, doublet_inertia
from wetdoublet.derive.physics.scaling import group_definitions
from wetdoublet.derive.physics.structure import Structure
from wetdoublet.derive.vocabulary import quantities as q

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("few_structures")]

OBLIQUE = Structure(oblique=True, bridge=False, strings=False)
Mutate = Callable[[Any, Any], None]
Healthy = dict[str, Check]


def failed(checks: Check | Iterable[Check]) -> dict[str, Check]:
    """The checks that fail, by name."""
    each = [checks] if isinstance(checks, Check) else list(checks)
    return {check.name: check for check in each if check.ok is False}


def caught(checks: Check | Iterable[Check], healthy: Healthy, *names: str) -> dict[str, Check]:
    """Assert that exactly these checks fail, and that they hold for the right model."""
    found = failed(checks)
    assert list(found) == list(names)
    assert all(healthy[name].ok for name in names)
    return found


def altered(law: Law, **results: sp.Expr) -> Law:
    """The law with other results for the functions named."""
    functions = tuple(replace(f, result=results.get(f.name, f.result)) for f in law.functions)
    return replace(law, functions=functions)


def altered_force(mutate: Mutate, force: sp.Symbol, change: Callable[[sp.Expr], sp.Expr]) -> None:
    right = forces.force_laws()
    mutate(forces.force_laws, lambda *_: {**right, force: change(right[force])})


def test_tangential_force_of_the_wrong_sign(mutate: Mutate, healthy: Healthy):
    """F_t that drives omega and xi apart conserves L and gives energy."""
    altered_force(mutate, F_t, lambda force: -force)
    found = arms([LAWS["arm"]["midgap"]], [LAWS["shear"]["immersed"]])
    caught(found, healthy, "shear dissipates: immersed, midgap arm")


def test_film_force_of_the_wrong_sign(healthy: Healthy):
    """A film that pushes along gives energy, and not what stops a head-on doublet."""
    right = LAWS["film"]["finite"]
    wrong = altered(right, resistance=-right["resistance"].result)
    found = caught(film_dissipates(wrong), healthy, "film dissipates: finite")
    assert "-" in found["film dissipates: finite"].figure  # the point where it is negative is shown
    caught(head_on_closed_form([wrong]), healthy, "head-on closed form: finite")


def test_film_without_its_rim(healthy: Healthy):
    """Taylor's unbounded film, 1/s, acts at x = x0: it has another momentum integral than the published one."""
    wrong = altered(LAWS["film"]["finite"], resistance=1 / q.gap)
    caught(film_ends([wrong], []), healthy, "film's rim: finite")
    caught(head_on_closed_form([wrong]), healthy, "head-on closed form: finite")


def test_centrifugal_term_of_the_wrong_sign(mutate: Mutate, healthy: Healthy):
    """A centripetal term in place of the centrifugal one does work out of nothing."""

    def wrong(*args: Any) -> Any:
        return tuple((name, -value if name == CENTRIFUGAL_FORCE else value) for name, value in intermediates(*args))

    mutate(intermediates, wrong)
    caught(energy([OBLIQUE]), healthy, "energy: oblique")


def test_inertia_of_hollow_spheres_in_one_place(mutate: Mutate, healthy: Healthy):
    """2/3 for 2/5 in I(x) alone contradicts the kinetic energy."""
    hollow = sp.expand(doublet_inertia() + (sp.Rational(2, 3) - sp.Rational(2, 5)) * 16 * q.m * q.a**2)
    mutate(doublet_inertia, lambda *_: hollow)
    caught(inertia_is_rigid_rotation(), healthy, "inertia")
    caught(least_energy(), healthy, "stick certificate")
    caught(least_energy_is_a_minimum(), healthy, "least energy at fixed L")


def test_inertia_of_hollow_spheres_in_the_ledger(mutate: Mutate, healthy: Healthy):
    """2/3 for 2/5 in the kinetic energy alone breaks the balance with the equations of motion."""
    right = observables.energies(OBLIQUE)
    wrong = {name: value.subs(q.spin**2, q.spin**2 * sp.Rational(5, 3)) for name, value in right.items()}
    assert wrong != right
    mutate(observables.energies, lambda structure: wrong)
    caught(energy([OBLIQUE]), healthy, "energy: oblique")


def test_an_arm_that_is_neither():
    """An arm of 3a: the failure names the arm and its torque on the doublet; that its shear takes energy is open."""
    wrong = altered(replace(LAWS["arm"]["midgap"], name="third"), lever=sp.Integer(3))
    kept, taken = arms([wrong], [LAWS["shear"]["immersed"]])
    assert taken.name == "shear dissipates: immersed, third arm" and not taken.ok
    found = failed([kept])
    assert list(found) == ["angular momentum, third arm"]
    assert found["angular momentum, third arm"].figure == "dL/dt = F_t*(2*a - x)"  # 2 arm - r = 6a - (4a + x)


def test_a_bridge_that_depends_on_velocity(mutate: Mutate, healthy: Healthy):
    """A viscous term in F_c keeps the balance, for it is charged; but its work is no potential, and no certificate."""
    altered_force(mutate, F_c, lambda force: force * (1 - q.u / q.v0))
    caught(bridge_does_work(), healthy, "bridge does work only")
    assert not certificate(Structure(oblique=False, bridge=True, strings=False)).admitted


def test_strings_that_are_no_gradient(mutate: Mutate, healthy: Healthy):
    """Strings that pull sideways twice as hard can be swung round for energy: no potential has these forces."""
    altered_force(mutate, S_t, lambda force: 2 * force)
    caught(strings_are_conservative([LAWS["strings"]["small-angle"]]), healthy, "strings: small-angle")


def test_strings_of_another_potential(healthy: Healthy):
    """A stiffness that is not the slope of the height gained contradicts the ledger."""
    right = LAWS["strings"]["small-angle"]
    wrong = altered(right, stiffness=2 * right["stiffness"].result)
    caught(strings_are_conservative([wrong]), healthy, "strings: small-angle")


def test_film_force_of_the_wrong_dimension(mutate: Mutate, healthy: Healthy):
    """A film force with a radius too many is named with the dimension it has."""
    altered_force(mutate, F_n, lambda force: force * q.a)
    room = "forces as the laws fill them"
    found = caught(dimension_checks({room: si_equations()[room]}), healthy, f"dimensions: {room}")
    assert found[f"dimensions: {room}"].figure.startswith("F_n:")


def test_shear_in_rigid_rotation(mutate: Mutate, healthy: Healthy):
    """Sliding taken as omega - xi/2 brakes a doublet that turns as one body."""
    altered_force(mutate, F_t, lambda force: force.subs(q.xi, q.xi / 2))
    caught(rigid_rotation_is_free(), healthy, "rigid rotation")


def test_a_rebound_that_gains_energy(mutate: Mutate, healthy: Healthy):
    """U -> -(2 - e) u gains what it is charged as a loss; if the gain is booked, the booking is negative."""
    wrong = {True: -(2 - q.e_dry) * q.normal_velocity}
    mutate(rebound, lambda states: {s: wrong.get(s == q.normal_velocity, s) for s in states})
    caught(rebound_dissipates(), healthy, "rebound's energy")


def test_a_rebound_that_books_its_gain(mutate: Mutate, healthy: Healthy):
    """A gain that the ledger knows of balances, and is still a gain."""
    mutate(
        rebound, lambda states: {s: -(2 - q.e_dry) * q.normal_velocity if s == q.normal_velocity else s for s in states}
    )
    mutate(rebound_loss, lambda *_: q.normal_velocity**2 * (1 - (2 - q.e_dry) ** 2) / 2)
    caught(rebound_dissipates(), healthy, "rebound dissipates")


@pytest.mark.parametrize(
    ("group", "factor", "names"),
    [
        (q.stokes, sp.Integer(2), {"paper's groups"}),
        (q.stokes, q.a, {"paper's groups", "dimensions: groups", "St, Ca, Ce"}),
        (q.centrifugal, sp.Rational(1, 2), {"paper's groups", "centrifugal number"}),
        (q.centrifugal, q.x0 / q.a, {"paper's groups", "centrifugal number"}),
    ],
    ids=["St twice", "St times a", "Ce half", "Ce of x0"],
)
def test_a_group_misdefined(mutate: Mutate, healthy: Healthy, group, factor, names):
    """A factor in a group's definition, a pure number or a length, is caught as what it is."""
    right = group_definitions()
    mutate(group_definitions, lambda *_: {**right, group: right[group] * factor})
    rooms = {"groups": si_equations()["groups"]}
    found = failed(
        [*dimension_checks(rooms), groups_are_the_papers(), groups_span_the_nullspace(), centrifugal_number()]
    )
    assert set(found) == names
    assert all(healthy[name].ok for name in names)


def test_small_angle_strings_of_twice_the_strength(monkeypatch, healthy: Healthy):
    """Twice the linearised strings are conservative and vanish for l -> oo, but are not the linearisation."""
    right = LAWS["strings"]["small-angle"]
    wrong = altered(right, **{f.name: 2 * f.result for f in right.functions})
    monkeypatch.setitem(LAWS["strings"], "small-angle", wrong)
    caught(small_angle_is_linear(), healthy, "small-angle strings")


def test_a_ledger_that_contradicts_the_equations(mutate: Mutate, healthy: Healthy):
    """Shear charged with half its power leaves the rest unaccounted for."""
    right = observables.energy_rates
    key = "tangential_lubrication"
    half = right(OBLIQUE)
    half[key] /= 2
    mutate(right, lambda structure: half)
    caught(energy([OBLIQUE]), healthy, "energy: oblique")


def test_a_logarithm_past_its_edge(healthy: Healthy):
    """ln(2a/x) used up to x = 4a is negative beyond 2a: the shear gives energy there, at a point that is shown."""
    right = LAWS["shear"]["immersed"]
    wrong = altered(right, edge=2 * right["edge"].result)
    found = arms([LAWS["arm"]["midgap"]], [wrong])
    caught(found, healthy, "shear dissipates: immersed, midgap arm")
    caught(film_ends([], [wrong]), healthy, "shear's edge: immersed")


def test_a_ceiling_of_another_inertia(mutate: Mutate, healthy: Healthy):
    """A ceiling with the inertia of two points in place of two spheres is not the derived one."""
    right = observables.restitution_ceiling
    wrong = right(OBLIQUE)["squared"].subs(observables.INERTIA_RATIO, forces.DISTANCE**2)
    mutate(right, lambda structure: {"squared": wrong} if structure.oblique else right(structure))
    caught(ceiling_is_the_published(), healthy, "ceiling of e_n^2")


def test_a_reduced_form_of_another_start(mutate: Mutate, healthy: Healthy):
    """A spin eliminated with another value of L than the start's is not the full model's spin."""

    def wrong(structure: Structure, conserved: Any = ()) -> Any:
        return intermediates(structure, tuple((invariant, 2 * value) for invariant, value in conserved))

    mutate(intermediates, wrong)
    caught(reduced_is_full(), healthy, "reduced form")
