"""Doublets that a weak bridge holds in a thick film, beyond the edge of the tangential force."""

import pytest
from wetdoublet.generated.automaton import OPENING
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.certificates import proof_for
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.verify.audit import WithoutCertificate

SCENE = Scene.from_dict(
    {
        "particles": {"radius": 1e-4, "mass": 1e-8, "roughness": 1e-7, "dry_restitution": 0.9},
        "liquid": {"viscosity": 0.1, "film_thickness": 2.69e-4, "glass_transition_pressure": 1e12},
        "bridge": {"surface_tension": 0.15, "volume": 224.0},
        "impact": {"speed": 0.733, "angle": 0.935, "spin": 32000.0, "partner_spin": 27700.0},
    }
)


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_a_floating_doublet_is_a_stick(engine: str) -> None:
    """A doublet that swings beyond the tangential force for ever is proved after a few turns."""
    found = collide(SCENE, engine=engine, ledger=False)
    assert (found.outcome, found.certified) == ("stick", True)
    assert len(found.events) < 10


def test_it_swings_between_the_edge_and_its_last_maximum() -> None:
    """Followed without any proof, it reaches neither the edge at 2 a nor a larger gap."""
    n = nondimensionalise(SCENE, *SCENE.need_impact())
    model = load(select_model(SCENE, oblique=True))
    free = WithoutCertificate(model, n.groups, 1e-9)
    path = free.on(40.0)
    proof, edge = proof_for(model, path.p, 1e-9), SCENE.reduced_radius * 2 / n.length
    turns = [(step.phase, y) for step, y in zip(path.steps, path.ends, strict=True) if step.event == "turning"]
    first = next(k for k, (before, y) in enumerate(turns) if before.motion == OPENING and proof.decided(y, free.phase))
    later = [float(y[0]) for _, y in turns[first:]]
    assert len(later) > 10
    assert edge < min(later) < max(later) <= later[0] * (1 + 1e-8)
