"""Deliberately broken models are caught, each by the check whose law it breaks; the right model passes that check."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
import sympy as sp
from wetdoublet.derive.checks.admission import certificate
from wetdoublet.derive.checks.base import Check
from wetdoublet.derive.checks.certificate import least_energy, least_energy_is_a_minimum
from wetdoublet.derive.checks.conservation import energy, inertia_is_rigid_rotation, strings_are_conservative
from wetdoublet.derive.checks.dimensions import (
    centrifugal_number,
    dimension_checks,
    groups_are_the_papers,
    groups_span_the_nullspace,
    si_equations,
)
from wetdoublet.derive.checks.dissipation import (
    arms,
    bridge_does_work,
    film_dissipates,
    rebound_dissipates,
    rebound_is_charged,
)
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
from wetdoublet.solvers.verify.report import Finding

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("few_structures")]

OBLIQUE = Structure(oblique=True, bridge=False, strings=False)
MIDGAP, IMMERSED, FILM = LAWS["arm"]["midgap"], LAWS["shear"]["immersed"], LAWS["film"]["finite"]
STRINGS = LAWS["strings"]["small-angle"]
Mutate = Callable[[Any, Any], None]
Mutation = Callable[[Mutate], None]
Healthy = dict[str, Finding]


def flat(checks: Any) -> list[Check]:
    """One check, or checks however they are nested, as a list."""
    return [checks] if isinstance(checks, Check) else [check for each in checks for check in flat(each)]


def failed(checks: Any) -> dict[str, Check]:
    """The checks that fail, by name."""
    return {check.name: check for check in flat(checks) if check.ok is False}


def caught(checks: Any, healthy: Healthy, *names: str) -> None:
    """Assert that exactly these checks fail, and that they hold for the right model."""
    assert list(failed(checks)) == list(names)
    assert all(healthy[name].ok for name in names)


def altered(law: Law, **results: sp.Expr) -> Law:
    """The law with other results for the functions named."""
    functions = tuple(replace(f, result=results.get(f.name, f.result)) for f in law.functions)
    return replace(law, functions=functions)


def force(name: sp.Symbol, change: Callable[[sp.Expr], sp.Expr]) -> Mutation:
    """The mutation of a force."""

    def mutation(mutate: Mutate) -> None:
        right = forces.force_laws()
        mutate(forces.force_laws, lambda *_: {**right, name: change(right[name])})

    return mutation


def value_of(right: Callable[..., Any], name: Any, change: Callable[[sp.Expr], sp.Expr]) -> Mutation:
    """The mutation of one value of a function of the structure, where the structure has it."""

    def wrong(structure: Structure) -> dict[Any, sp.Expr]:
        found = right(structure)
        return {**found, name: change(found[name])} if name in found else found

    return lambda mutate: mutate(right, wrong)


def putting(*functions: tuple[Callable[..., Any], Callable[..., Any]]) -> Mutation:
    """The mutation that puts wrong functions in place of right ones."""

    def mutation(mutate: Mutate) -> None:
        for right, wrong in functions:
            mutate(right, wrong)

    return mutation


def centripetal(*given: Any) -> Any:
    return tuple((name, -value if name == CENTRIFUGAL_FORCE else value) for name, value in intermediates(*given))


def doubled(structure: Structure, conserved: Any = ()) -> Any:
    return intermediates(structure, tuple((invariant, 2 * value) for invariant, value in conserved))


def growing(states: Any) -> Any:
    """A rebound of -(2 - e) u."""
    return {s: -(2 - q.e_dry) * q.normal_velocity if s == q.normal_velocity else s for s in states}


def of_points(structure: Structure, right: Any = observables.restitution_ceiling) -> Any:
    """The ceiling with the inertia of two points in place of two spheres."""
    if not structure.oblique:
        return right(structure)
    return {"squared": right(structure)["squared"].subs(observables.INERTIA_RATIO, forces.DISTANCE**2)}


def saddle(kinetic: sp.Expr) -> sp.Expr:
    """Less by the square of the slip: what it is in rigid rotation, where it is no longer least."""
    slip = q.orbital_momentum / (4 + q.aspect * q.gap) ** 2 - q.spin
    return kinetic - (q.obliquity * slip) ** 2 if kinetic.has(q.spin) else kinetic


def hollow_in_one_place(*_: Any) -> sp.Expr:
    return sp.expand(doublet_inertia() + (sp.Rational(2, 3) - sp.Rational(2, 5)) * 16 * q.m * q.a**2)


def rebounds() -> tuple[Check, ...]:
    return rebound_is_charged(), rebound_dissipates()


NONE, ROOM, SHEARS = putting(), "forces as the laws fill them", "shear dissipates: immersed, midgap arm"
PUSHES, RIMLESS = altered(FILM, resistance=-FILM["resistance"].result), altered(FILM, resistance=1 / q.gap)
THIRD = altered(replace(MIDGAP, name="third"), lever=sp.Integer(3))
LONG = altered(IMMERSED, edge=2 * IMMERSED["edge"].result)
# What is wrong, how it is made, the checks that run, and the names of those that fail.
MUTANTS: dict[str, tuple[Mutation, Callable[[], Any], list[str]]] = {
    "F_t that drives omega and xi apart: it conserves L and gives energy": (
        force(F_t, lambda f: -f), lambda: arms([MIDGAP], [IMMERSED]), [SHEARS],
    ),
    "a film that pushes along gives energy, and does not stop a head-on doublet": (
        NONE, lambda: (film_dissipates(PUSHES), head_on_closed_form([PUSHES])),
        ["film dissipates: finite", "head-on closed form: finite"],
    ),
    "Taylor's unbounded film, 1/s, acts at x = x0, and has another momentum integral": (
        NONE, lambda: (film_ends([RIMLESS], []), head_on_closed_form([RIMLESS])),
        ["film's rim: finite", "head-on closed form: finite"],
    ),
    "a centripetal term in place of the centrifugal one does work out of nothing": (
        putting((intermediates, centripetal)), lambda: energy([OBLIQUE]), ["energy: oblique"],
    ),
    "2/3 for 2/5 in I(x) alone contradicts the kinetic energy": (
        putting((doublet_inertia, hollow_in_one_place)),
        lambda: (inertia_is_rigid_rotation(), least_energy(), least_energy_is_a_minimum()),
        ["inertia", "stick certificate", "least energy at fixed L"],
    ),
    "a kinetic energy that is stationary in rigid rotation, and not least": (
        value_of(observables.energies, "kinetic", saddle), least_energy_is_a_minimum, ["least energy at fixed L"],
    ),
    "a viscous term in F_c is charged, but its work is no potential": (
        force(F_c, lambda f: f * (1 - q.u / q.v0)), bridge_does_work, ["bridge does work only"],
    ),
    "strings that pull sideways twice as hard can be swung round for energy": (
        force(S_t, lambda f: 2 * f), lambda: strings_are_conservative([STRINGS]), ["strings: small-angle"],
    ),
    "a film force with a radius too many is named with its dimension": (
        force(F_n, lambda f: f * q.a), lambda: dimension_checks({ROOM: si_equations()[ROOM]}),
        [f"dimensions: {ROOM}"],
    ),
    "sliding taken as omega - xi/2 brakes a doublet that turns as one body": (
        force(F_t, lambda f: f.subs(q.xi, q.xi / 2)), rigid_rotation_is_free, ["rigid rotation"],
    ),
    "a rebound with -(2 - e) u gains what it is charged as a loss": (
        putting((rebound, growing)), rebounds, ["rebound's energy"],
    ),
    "a gain that the ledger knows of balances, and is still a gain": (
        putting((rebound, growing), (rebound_loss, lambda *_: q.normal_velocity**2 * (1 - (2 - q.e_dry) ** 2) / 2)),
        rebounds, ["rebound dissipates"],
    ),
    "shear charged with half its power leaves the rest unaccounted for": (
        value_of(observables.energy_rates, "tangential_lubrication", lambda e: e / 2),
        lambda: energy([OBLIQUE]), ["energy: oblique"],
    ),
    "ln(2a/x) used up to x = 4a is negative beyond 2a": (
        NONE, lambda: film_ends([], [LONG]), ["shear's edge: immersed"],
    ),
    "a ceiling with the inertia of two points in place of two spheres": (
        putting((observables.restitution_ceiling, of_points)), ceiling_is_the_published, ["ceiling of e_n^2"],
    ),
    "a spin eliminated with another value of L than the start's": (
        putting((intermediates, doubled)), reduced_is_full, ["reduced form"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MUTANTS)
def test_a_mutant_is_caught(name: str, mutate: Mutate, healthy: Healthy) -> None:
    """By these checks and by no other of those that run."""
    mutation, checks, names = MUTANTS[name]
    mutation(mutate)
    caught(checks(), healthy, *names)


def test_a_failure_says_where() -> None:
    """The point at which a film drives, the torque of an arm that is neither."""
    assert "-" in failed(film_dissipates(PUSHES))["film dissipates: finite"].figure
    kept, taken = arms([THIRD], [IMMERSED])  # that its shear takes energy is open
    assert taken.name == "shear dissipates: immersed, third arm" and not taken.ok
    assert kept.figure == "dL/dt = F_t*(2*a - x)" and kept.ok is False  # 2 arm - r = 6a - (4a + x)


def test_a_bridge_that_depends_on_velocity_has_no_certificate(mutate: Mutate) -> None:
    force(F_c, lambda f: f * (1 - q.u / q.v0))(mutate)
    assert not certificate(Structure(oblique=False, bridge=True, strings=False)).admitted


@pytest.mark.parametrize(
    ("group", "factor", "names"),
    [
        (q.stokes, q.a, {"paper's groups", "dimensions: groups", "St, Ca, Ce"}),
        (q.centrifugal, sp.Rational(1, 2), {"paper's groups", "centrifugal number"}),
    ],
    ids=["St times a", "Ce half"],
)
def test_a_group_misdefined(mutate: Mutate, healthy: Healthy, group, factor, names):
    """A factor in a group's definition, a pure number or a length, is caught as what it is."""
    right = group_definitions()
    mutate(group_definitions, lambda *_: {**right, group: right[group] * factor})
    rooms = {"groups": si_equations()["groups"]}
    checks = dimension_checks(rooms), groups_are_the_papers(), groups_span_the_nullspace(), centrifugal_number()
    assert {*failed(checks)} == names
    assert all(healthy[name].ok for name in names)


def test_small_angle_strings_of_twice_the_strength(monkeypatch, healthy: Healthy):
    """Twice the linearised strings are conservative and vanish for l -> oo, but are not the linearisation."""
    wrong = altered(STRINGS, **{f.name: 2 * f.result for f in STRINGS.functions})
    monkeypatch.setitem(LAWS["strings"], "small-angle", wrong)
    caught(small_angle_is_linear(), healthy, "small-angle strings")
