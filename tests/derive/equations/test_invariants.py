"""Invariants are found from the rates, what they eliminate is eliminated, and signs and certificates follow."""

from dataclasses import replace

import pytest
import sympy as sp
from wetdoublet.derive.checks.admission import certificate
from wetdoublet.derive.checks.base import nonnegative
from wetdoublet.derive.equations.invariants import NoInvariantError, conserved_momentum, invariants
from wetdoublet.derive.laws import LAWS
from wetdoublet.derive.physics.structure import Structure
from wetdoublet.derive.vocabulary import quantities as q

MIDGAP = {"arm": LAWS["arm"]["midgap"]}
_LEVER = replace(LAWS["arm"]["midgap"].functions[0], result=sp.Integer(2))  # the radius, over a
SURFACE = {"arm": replace(LAWS["arm"]["midgap"], name="surface", functions=(_LEVER,))}
DEFAULT = {"film": "finite", "shear": "immersed", "bridge": "mikami", "strings": "exact"}
FILLED = {slot: LAWS[slot][name] for slot, name in DEFAULT.items()}


@pytest.mark.parametrize(("name", "others"), [("oblique_bridge", {}), ("oblique", FILLED)])
def test_midgap_conserves_angular_momentum_and_nothing_else(models, name: str, others):
    """The search finds L = m (r^2 omega + (32/5) a^2 xi) over m a^2 Omega, whatever the other laws are."""
    (found,) = invariants(models[name], MIDGAP | others)
    assert found.expression == q.orbital_momentum + sp.Rational(32, 5) * q.spin
    assert found.describe() == "orbital_momentum + (32/5) spin: angular momentum L/(m a^2 Omega)"
    assert found.is_angular_momentum


@pytest.mark.slow
def test_surface_arm_conserves_nothing(models):
    """With the arm 2a there is no invariant, nor with an arm left open; the reduced form says so."""
    assert invariants(models["oblique"], SURFACE) == invariants(models["oblique_bridge"], FILLED) == ()
    with pytest.raises(NoInvariantError, match=r"not conserved \(arm surface"):
        conserved_momentum(models["oblique"], SURFACE)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["oblique_strings", "head_on_bridge_strings"])
def test_strings_and_head_on_conserve_nothing(models, name: str):
    """Strings exert a torque, and head-on there is one momentum, which the film takes."""
    assert invariants(models[name], MIDGAP | FILLED) == ()


def test_without_shear_each_momentum_is_its_own():
    """A user's model without tangential force conserves the orbit's and the spins' momentum separately."""
    rates = {
        q.gap: q.normal_velocity,
        q.normal_velocity: -q.normal_velocity / q.gap,
        q.orbital_momentum: sp.Integer(0),
        q.spin: sp.Integer(0),
    }
    assert [each.expression for each in invariants(rates)] == [q.orbital_momentum, q.spin]


def test_a_coefficient_may_depend_on_the_gap():
    """In angular velocities the same law reads (4 + eps s)^2 omega + (32/5) xi: the coefficient is found as well."""
    omega, xi, torque = sp.symbols("omega xi torque", real=True)
    distance = 4 + q.aspect * q.gap
    rates = {
        q.gap: q.normal_velocity,
        q.normal_velocity: sp.Symbol("force", real=True),
        omega: -torque / distance - 2 * q.aspect * q.normal_velocity * omega / distance,
        xi: torque * distance * sp.Rational(5, 32),
    }
    (found,) = invariants(rates)
    expected = distance**2 * omega + sp.Rational(32, 5) * xi
    assert sp.simplify(found.expression * expected.subs({xi: 0, omega: 1, q.gap: 0}) - expected) == 0
    assert not found.is_angular_momentum  # not in the states that L is written in


def test_an_unknown_momentum_is_not_solved_for(models):
    """Solving an invariant for a state that it does not contain is a named error."""
    (found,) = invariants(models["oblique"], MIDGAP)
    with pytest.raises(NoInvariantError, match="normal_velocity cannot be eliminated"):
        found.solved(q.normal_velocity, sp.Integer(0))


def test_signs_are_proved_refuted_or_left_open():
    """Squares and logarithms inside their edge are proved, a change of sign is refuted, the rest says so."""
    s, edge = q.gap, sp.Integer(1)
    for true in ((1 - s) ** 2 / s, sp.log(1 / s), 1 - s, 1 - s**2, -sp.log(s) * q.normal_velocity**2):
        assert nonnegative(true, s, edge).proved is True, true
    for false in (s - 1, q.normal_velocity, sp.log(s), (s - sp.Rational(1, 2)) * (1 - s)):
        assert nonnegative(false, s, edge).proved is False, false
    assert nonnegative(2 + sp.sin(7 * s) + sp.cos(5 * s) * s, s, edge).proved is None


@pytest.mark.slow
def test_certificates_are_admitted_where_their_premises_hold():
    """Bridge and midgap arm: admitted. Surface arm, film alone, strings: not, for the reason that is each one's own."""
    bridge = Structure(oblique=True, bridge=True, strings=False)
    proved = certificate(bridge)
    assert proved.admitted and any("angular momentum" in text for text in proved.held)
    surface = certificate(bridge, SURFACE)
    assert not surface.admitted
    assert "L not conserved" in surface.describe()
    assert "no barrier" in certificate(Structure(oblique=True, bridge=False, strings=False)).describe()
    assert "torque" in certificate(Structure(oblique=True, bridge=True, strings=True)).describe()
    assert certificate(Structure(oblique=False, bridge=False, strings=True)).admitted
    hung = Structure(oblique=True, bridge=False, strings=True)
    assert "momenta" in certificate(hung).describe()
    assert not certificate(hung, SURFACE).admitted
