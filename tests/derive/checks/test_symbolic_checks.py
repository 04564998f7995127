"""Every check holds of the derivation, and those of a scene's laws are among them."""

import pytest
from wetdoublet.solvers.verify.verdicts import findings

pytestmark = pytest.mark.slow


def test_every_symbolic_check_holds(healthy):
    """All checks hold of the derivation, but for notes, where no proof exists."""
    assert [check for check in healthy.values() if check.ok is False] == []
    assert {name for name, check in healthy.items() if check.ok is None} == {
        *(f"certificate: oblique{more}" for more in ("", "_bridge_strings")),
        "film's rim: infinite",
    }
    assert all(check.statement and check.figure for check in healthy.values())


def test_checks_of_a_scenes_laws_are_those_laws_alone(healthy):
    """With laws chosen, each check of a law is of the one chosen; each name stands once, and none is new."""
    names = [check.name for check in findings({"shear": "film"})]
    assert len(set(names)) == len(names)
    assert set(names) < healthy.keys()
    left_out = healthy.keys() - set(names)
    assert left_out == {name for name in healthy if "immersed" in name}
