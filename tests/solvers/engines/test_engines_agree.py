"""Both engines decide alike: the same events in the same order, and the same certificates on the same states."""

import numpy as np
import pytest
from wetdoublet.generated.automaton import CLOSING, EVENTS, KINDS, OUTCOMES, Status
from wetdoublet.solvers import CheckFailed, Scene
from wetdoublet.solvers.certificates import proof_for
from wetdoublet.solvers.engines.casadi.locate import EventLocator, locate
from wetdoublet.solvers.engines.taylor.call import Impacts, run_kernel
from wetdoublet.solvers.engines.taylor.record import Recorded, run_recorded
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.model.phases import Phase

from ...helpers.entries import CIRCLES

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")

GRANULATION, PENDULUM = Scene.load("granulation"), Scene.load("pendulum")
SOLID = {"liquid.glass_transition_pressure": "1e6 GPa"}


def without_bridge(**tables: dict[str, str]) -> Scene:
    """Granulation with a film alone, and other tables."""
    return Scene.from_dict({name: table for name, table in GRANULATION.to_dict().items() if name != "bridge"} | tables)


def by_kernel(scene: Scene, stokes: np.ndarray, angle: np.ndarray) -> Recorded:
    """Collisions with their events."""
    impacts = Impacts(scene, stokes / scene.stokes_per_speed, angle, {})
    told = run_recorded(impacts, bool(angle[0] > 0), 1e-9, trajectory=True, keep=False, fold=False)
    assert told is not None
    return told


def events(told: Recorded, k: int) -> list[str]:
    return [KINDS[int(kind)] for kind in told.events[k, : told.answers["events"][k]]["kind"]]


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


@pytest.mark.slow
@pytest.mark.parametrize("scene", [GRANULATION, PENDULUM], ids=["granulation", "pendulum"])
def test_both_engines_decide_alike_on_spheres_that_meet_outside_the_film(scene):
    """Events, outcome and restitution of soft spheres with a bridge, whose elastic length is up to three films.

    A stick is proved at the next look for a proof, which one of the engines may take an event later.
    """
    rng, modulus, rebounds = np.random.default_rng(31), 1e5, []
    for _ in range(30):
        stokes, angle = float(np.exp(rng.uniform(np.log(0.0005), np.log(3)))), float(rng.uniform(0.05, 1.4))
        soft = scene.with_entries(
            SOLID
            | {
                "bridge.surface_tension": float(rng.uniform(0.01, 0.08)),
                "bridge.volume": float(rng.uniform(0.01, 0.1)),
                "bridge.contact_angle": 0.0,
                "particles.dry_restitution": float(rng.uniform(0.1, 1)),
                "particles.youngs_modulus": modulus,
                "particles.poisson_ratio": 0.3,
            }
        )
        length = nondimensionalise(soft, stokes / soft.stokes_per_speed, angle).groups["elastic_gap"]
        stiffness = modulus * (length / float(rng.uniform(1, 3))) ** 2.5  # the elastic length goes with its power -2/5
        soft = soft.with_entries({"particles.youngs_modulus": stiffness})
        told = by_kernel(soft, np.array([stokes]), np.array([angle]))
        groups = nondimensionalise(soft, stokes / soft.stokes_per_speed, angle).groups
        path = locate(load(select_model(soft, True, fold=False)), groups, 1e-9)
        (answer,) = told.answers
        same = len(path.kinds) if path.separated else min(len(path.kinds), answer["events"])
        assert OUTCOMES[answer["outcome"]] == path.outcome, (stokes, angle, stiffness)
        assert events(told, 0)[:same] == path.kinds[:same], (stokes, angle, stiffness)
        if path.separated:
            restitution = path.model.values("outputs", path.y, path.p)["restitution"]
            assert answer["shown"][0] == pytest.approx(restitution, rel=1e-6)
        rebounds.append(path.kinds.count("elastic"))
    assert len(set(rebounds)) > 1


@pytest.mark.parametrize("angle", [0.0, 0.6])
def test_a_criterion_that_holds_at_initial_contact_parts_the_films(angle):
    """Without a bridge a rebound there is at the rupture gap, and over at once."""
    scene = without_bridge().with_entries({"liquid.glass_transition_pressure": "1 Pa"})
    told = by_kernel(scene, np.array([1.0]), np.array([angle]))
    n = nondimensionalise(scene, 1.0 / scene.stokes_per_speed, angle)
    path = locate(load(select_model(scene, angle > 0, fold=False)), n.groups, 1e-9)
    assert events(told, 0) == path.kinds == ["glass", "rupture"]


@pytest.mark.slow
@pytest.mark.parametrize("tables", [{}, {"attraction": {"hamaker": "1e-19 J"}}], ids=["film", "attraction"])
def test_both_engines_prove_the_same_sticks_by_the_film(tables):
    """Head-on at initial contact, up to the largest speed that the film stops and beyond."""
    scene = without_bridge(**tables)
    stokes = np.geomspace(0.02, 0.3, 25)
    speed = stokes / scene.stokes_per_speed
    told = run_kernel(Impacts(scene, speed, np.zeros(speed.size), {}), 1e-9)
    assert told is not None
    model = load(select_model(scene, False))
    own = []
    for each in speed.tolist():
        p = model.group_values(nondimensionalise(scene, each, 0.0).groups)
        state = np.append(model.start(p), [0.0] * len(model.works))
        own.append(bool(proof_for(model, p, 1e-9).decided(state, Phase(film=1, shear=0, motion=CLOSING))))
    assert own == (told["status"] == Status.PROVED_AT_TOUCH).tolist()
    assert len(set(own)) == 2


@pytest.mark.slow
def test_a_doublet_that_circles_is_held_where_it_falls_back_in_both_engines():
    """One that would circle in and out of its film for hundreds of phases is a stick by the momentum of its orbit."""
    scene = Scene.from_dict(CIRCLES)
    speed, angle = 0.0149 / scene.stokes_per_speed, 0.4465
    impacts = Impacts(scene, np.array([speed]), np.array([angle]), {})
    told = run_recorded(impacts, True, 1e-9, trajectory=True, budget=2000, keep=False, fold=False)
    path = locate(load(select_model(scene, True, fold=False)), nondimensionalise(scene, speed, angle).groups, 1e-9)
    assert told is not None
    (answer,) = told.answers
    assert answer["events"] == len(path.kinds) < 10
    assert answer["status"] == Status.DECIDED
    assert (OUTCOMES[answer["outcome"]], bool(answer["certified"])) == (path.outcome, path.certified) == ("stick", True)
