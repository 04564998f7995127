"""Bridge laws as parts: own rupture distances, ranges that are left."""

import math

import pytest
from wetdoublet.solvers import InputError, ModelWarning, Scene, collide_many
from wetdoublet.solvers.host.emitted import LAWS

from ...helpers.reference import collide

OWN = {
    "mikami": lambda v, phi: (0.62 * phi + 0.99) * v**0.34,
    "mikami-log10": lambda v, phi: (0.62 * phi + 0.99) * v**0.34,
    "willett": lambda v, phi: (1 + phi / 2) * (v ** (1 / 3) + v ** (2 / 3) / 10),
    "willett-simple": lambda v, phi: (1 + phi / 2) * (v ** (1 / 3) + v ** (2 / 3) / 10),
    "soulie": lambda v, phi: (1 + phi / 2) * v ** (1 / 3),
}


@pytest.mark.parametrize("law", LAWS["bridge"])
def test_own_rupture(law):
    """`own` is the distance that the law's authors give; a law without one says which have."""
    entries = {"bridge.law": law, "bridge.rupture": "own", "bridge.contact_angle": "20 deg"}
    scene = Scene.load("granulation")
    if law not in OWN:
        with pytest.raises(InputError, match="one of mikami, mikami-log10, willett, willett-simple, soulie"):
            scene.with_entries(entries)
        return
    expected = OWN[law](0.1, math.radians(20)) * 1e-4
    assert scene.with_entries(entries).rupture_gap == pytest.approx(expected, rel=1e-12)


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
