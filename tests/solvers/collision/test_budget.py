"""One budget of steps for all that a collision takes: kernel, location, replay, planar collisions beside a wall."""

import json
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from wetdoublet.solvers import ComputationError, Scene, collide_many, collide_pair
from wetdoublet.solvers.collision.by_casadi import by_casadi
from wetdoublet.solvers.engines.casadi.integrators import Locator, Plain
from wetdoublet.solvers.engines.settings import CASADI_STEPS_IN_SPACE, CVODES, Budget
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.space.beside_wall import beside_wall, planar_by_casadi
from wetdoublet.solvers.space.pairs import checked

from ...helpers.data import DATA

pytestmark = pytest.mark.slow

# strings pull it back again and again; sliding friction takes its spin


@dataclass
class Counted:
    """Steps of CasADi's integrators, as they report them."""

    rosenbrock: int = 0
    cvodes: int = 0

    @property
    def total(self) -> float:
        """In steps of Rosenbrock."""
        return self.rosenbrock + self.cvodes * CVODES


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> Iterator[Counted]:
    """The steps of all calls of integrators."""
    count = Counted()
    for kind in (Locator, Plain):

        def call(self, *given, original=kind.__call__):
            try:
                return original(self, *given)
            finally:
                if isinstance(self, Plain) and self.plugin == "cvodes":
                    count.cvodes += self.steps
                else:
                    count.rosenbrock += self.steps

        monkeypatch.setattr(kind, "__call__", call)
    return count


@pytest.mark.parametrize("engine", ["rosenbrock", "cvodes"])
@pytest.mark.parametrize("most", [30, 300, 5_000])
@pytest.mark.parametrize("distance", [1e-12])
def test_location_and_replay_share_the_steps(engine: str, most: int, distance: float, counted: Counted) -> None:
    """However few there are: also beside a boundary, where an engine misses the events, and is tried again."""
    scene = Scene.load("granulation").with_impact(stokes=0.0563 * (1 - distance), angle="60 deg")
    n = nondimensionalise(scene, *scene.need_impact())
    budget = Budget(most)
    try:
        by_casadi(scene, n, 1e-9, engine, True, False, budget=budget)
        decided = True
    except ComputationError as error:
        decided, reason = False, str(error)
        assert "steps" in reason or "gave up" in reason
    assert decided or most < 5_000
    assert budget.spent <= most
    assert counted.total <= 2 * most  # a decided trajectory that cannot be replayed is located again


@pytest.mark.parametrize(("most", "ledger"), [(40, False), (90, True), (5_000, True)])
def test_planar_collisions_beside_a_wall_share_the_steps(most: int, ledger: bool, counted: Counted) -> None:
    """Two, or four with a ledger: one that has no steps left fails the collision, and says so."""
    scene = Scene.load("granulation").with_entries({"partner.wall": True})
    pairs = checked(scene, [0, 0, 1], [[0.2, 0.1, 3.0]], [[0, 100.0, 20.0]])
    budgets = [Budget(most)]
    made = beside_wall(pairs, lambda those: planar_by_casadi(those, 1e-9, ledger, budgets), 1e-9, ledger)
    assert made is not None
    ends = made[0]
    assert budgets[0].spent <= most
    assert counted.total <= 2 * most
    assert (int(ends.outcome[0]) < 0) == (most < 1_000)
    assert ("steps in" in ends.reason[0]) == (most < 1_000)


@pytest.mark.parametrize("engine", ["rosenbrock", "cvodes"])
def test_a_pair_in_space_takes_no_more(engine: str, counted: Counted) -> None:
    """In space, where a step takes longer, there are fewer."""
    scene = Scene.from_dict(
        {
            "particles": {
                "radius": 4.572e-3, "mass": 1.49e-4, "roughness": 2.218e-9, "dry_restitution": 0.216,
                "youngs_modulus": 6.578e14, "poisson_ratio": 0.3834,
            },
            "liquid": {"viscosity": 0.0633, "film_thickness": 2.603e-6, "glass_transition_pressure": 2.283e7},
            "bridge": {
                "surface_tension": 0.5783, "volume": 3.386e-4, "contact_angle": 0.9966, "law": "willett-simple",
            },
        }
    )  # fmt: skip
    velocities, spins = [[0.1297, -0.01152, 0.08369], [0, 0, 0]], [[-74.6, -75.2, -13.4], [-11.8, 13.2, 376.5]]
    found = collide_pair(scene, [0, 0, 1], velocities, spins, engine=engine)
    assert int(found.outcome) == -1
    assert counted.total <= CASADI_STEPS_IN_SPACE


def test_a_batch_loses_no_outcome_for_what_else_it_shows() -> None:
    """With a term of the ledger the trajectory has to be replayed; the outcome is that of the location."""
    row = json.loads((DATA / "hard_scenes.json").read_text())["hundreds of rebounds on glassy liquid"]
    found = collide_many(Scene.from_dict(row["scene"]), engine="rosenbrock", of=("restitution", "energy.capillary"))
    assert found.outcome.values.tolist() == [0]
