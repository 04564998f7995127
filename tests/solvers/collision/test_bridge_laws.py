"""Ranges of bridge laws that are left."""

import pytest
from wetdoublet.solvers import ModelWarning, Scene, collide_many

from ...helpers.reference import collide


def test_a_range_that_is_left_is_said_once():
    """Outside a law's range: a ModelWarning, the same sentence with the result and in the table, and never an error."""
    scene = Scene.load("granulation").with_entries({"bridge.law": "willett-simple", "bridge.contact_angle": "60 deg"})
    with pytest.warns(ModelWarning) as caught:
        one = collide(scene)
    of_laws = [said for said in one.validity if "range of the law" in said]
    assert [str(each.message) for each in caught] == of_laws
    assert len(of_laws) == 2
    assert "bridge.volume = 0.1 is above 0.001" in of_laws[0]
    assert "bridge.contact_angle = 60 deg is above 50 deg" in of_laws[1]
    assert "note: bridge.volume" in str(one)
    with pytest.warns(ModelWarning, match="above 0.001"):
        collide_many(scene, stokes=[0.03], angle=[1.0], engine="rosenbrock")
    assert collide("granulation").validity == ()
    inside = {"bridge.law": "willett", "bridge.contact_angle": "50 deg"}  # the ends of a range belong to it
    said = collide(Scene.load("granulation").with_entries(inside)).validity
    assert not any("range of the law" in each for each in said)
