"""Both engines decide alike: the same events in the same order, and the same certificates on the same states."""

import pytest
from wetdoublet.generated.automaton import EVENTS
from wetdoublet.solvers import CheckFailed, Scene
from wetdoublet.solvers.engines.casadi.locate import EventLocator
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.model.phases import Phase

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")

GRANULATION = Scene.load("granulation")


def test_the_reference_knows_every_action() -> None:
    """Each action of the table has its effect in the CasADi engine; a rebound is decided apart."""
    scene = GRANULATION.with_impact(stokes=0.03, angle=1.0).with_entries({"particles.friction": 0.3})
    groups = nondimensionalise(scene, *scene.need_impact()).groups
    finder = EventLocator(load(select_model(scene, True)), groups, 1e-9)

    def after(action: str, target: str) -> Phase:
        finder.y[1] = 0.5  # opening, so that it may separate
        return finder._done(action, finder.phase, target)

    known = [after(action, event.target) for event in EVENTS for action in event.actions if action != "rebound"]
    assert len(known) > 8
    assert all(isinstance(phase, Phase) for phase in known)
    with pytest.raises(CheckFailed, match="unknown action"):
        finder._done("explode", finder.phase, "")
