"""One budget of steps for all that a collision takes: kernel, location, replay, planar collisions beside a wall."""

from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from wetdoublet.solvers import ComputationError, Scene, collide, collide_many, collide_pair
from wetdoublet.solvers.collision.by_casadi import by_casadi
from wetdoublet.solvers.engines.casadi.integrators import Locator, Plain
from wetdoublet.solvers.engines.choice import available_engines
from wetdoublet.solvers.engines.settings import CASADI_STEPS, CASADI_STEPS_IN_SPACE, CVODES, Budget
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.space.beside_wall import beside_wall, planar_by_casadi
from wetdoublet.solvers.space.pairs import checked

pytestmark = pytest.mark.slow

# strings pull it back again and again; sliding friction takes its spin
CHATTERS = {
    "particles": {
        "reduced_radius": 3.63446e-5, "density": 3551.35, "roughness": 4.67339e-12, "dry_restitution": 0.8424,
        "friction": 0.0837436, "contact_tangential_restitution": 0.944388,
    },
    "liquid": {"viscosity": 0.00304334, "film_thickness": 1.41066e-6, "glass_transition_pressure": 277920.0},
    "bridge": {"surface_tension": 0.0410723, "volume": 7.24216e-5, "contact_angle": 0.0},
    "pendulum": {"length": 0.00905657, "gravity": 5.21874},
    "model": {"film": "infinite", "glass": "film-corrected"},
    "impact": {"stokes": 1.14092e-5, "angle": 0.185771},
}  # fmt: skip


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
@pytest.mark.parametrize("most", [30, 100, 300, 700, 2_000, 5_000])
@pytest.mark.parametrize("distance", [1e-3, 1e-12])
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


def test_chatter_with_friction_on_strings_is_decided(counted: Counted) -> None:
    """Strings pull it back again and again, and friction takes its spin: a stick, but no theorem, by either engine."""
    for engine in ("taylor", "rosenbrock"):
        found = collide(Scene.from_dict(CHATTERS), engine=engine)
        assert (found.outcome, found.certified, found.engine) == ("stick", False, engine)
    assert counted.total <= CASADI_STEPS


@pytest.mark.parametrize("ledger", [False, True])
@pytest.mark.parametrize("most", [40, 90, 5_000])
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


@pytest.fixture
def rebounds() -> Scene:
    """A stick proved after hundreds or thousands of rebounds on glassy liquid."""
    return Scene.from_dict(
        {
            "particles": {
                "reduced_radius": 3.83599e-6, "density": 359.144, "roughness": 7.10954e-11, "dry_restitution": 0.79116,
            },
            "liquid": {"viscosity": 0.00197202, "film_thickness": 2.69617e-9, "glass_transition_pressure": 2128.65},
            "bridge": {
                "surface_tension": 6.66418e-4, "volume": 3.10253e-4, "contact_angle": 0.655003, "law": "soulie",
            },
            "model": {"film": "constant-volume"},
            "impact": {"stokes": 2.11852, "angle": 0.0, "spin": 13292.9, "partner_spin": -250769.0},
        }
    )  # fmt: skip


def test_what_the_kernel_decides_stands(rebounds: Scene) -> None:
    """Rosenbrock spends its steps before."""
    if "taylor" not in available_engines(rebounds):
        pytest.skip("no kernel can be compiled here")
    found = collide(rebounds)
    assert (found.engine, found.outcome, found.certified) == ("taylor", "stick", True)
    assert len(found.events) > 1000


@pytest.mark.parametrize("engine", ["rosenbrock", "cvodes"])
def test_a_replay_without_steps_loses_no_outcome(rebounds: Scene, engine: str) -> None:
    """More phases than location and replay have calls for together: what was located is the answer."""
    scene = rebounds.with_entries({"impact.stokes": 2.81})
    found = collide(scene, engine=engine)
    assert (found.outcome, found.certified) == ("stick", True)
    assert len(found.events) > 300


def test_a_batch_loses_no_outcome_for_what_else_it_shows(rebounds: Scene) -> None:
    """With a term of the ledger the trajectory has to be replayed; the outcome is that of the location."""
    found = collide_many(
        rebounds.with_entries({"impact.stokes": 2.81}), engine="rosenbrock", of=("restitution", "energy.capillary")
    )
    assert found.outcome.values.tolist() == [0]
