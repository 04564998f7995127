"""Proofs of unequal pairs, of a sphere at a wall, of a film alone, and of pairs that come to rest in contact."""

import pytest
from wetdoublet.solvers import Scene, collide, prove
from wetdoublet.solvers.engines.interval.build import NotProvable, engine
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.model.model import select_model

from ...helpers.own_arm import surface

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")


def beside(scene: Scene, ratio: float | None, spins: tuple[float, float] = (0.0, 0.0)) -> Scene:
    """A scene with a sphere `ratio` times as large and of the same density as partner, or a wall."""
    if ratio is None:
        coated = "liquid.coating_thickness" in scene.entries
        return scene.with_entries({"partner.wall": True} | ({"partner.coating_thickness": 0.0} if coated else {}))
    radius, mass = 2 * scene.particles.reduced_radius, 2 * scene.particles.reduced_mass
    sizes = {"partner.radius": ratio * radius, "partner.mass": ratio**3 * mass}
    return scene.with_entries(sizes | dict(zip(("impact.spin", "impact.partner_spin"), spins, strict=True)))


@pytest.mark.slow
def test_either_sphere_may_come_first() -> None:
    """A pair, and the same pair named the other way round, have enclosures that overlap to their last digits."""
    scene = Scene.load("granulation")
    pair = beside(scene, 2.0, (300.0, -100.0)).with_impact(stokes=0.3, angle=0.9)
    radius, mass = 4 * scene.particles.reduced_radius, 16 * scene.particles.reduced_mass
    shape = {"particles.reduced_radius": radius / 2, "particles.reduced_mass": mass / 2}
    other = beside(scene.with_entries(shape), 0.5, (-100.0, 300.0)).with_impact(stokes=0.3, angle=0.9)
    (one, two), (three, four) = (prove(each).restitution or (0.0, 1.0) for each in (pair, other))
    assert max(one, three) <= min(two, four) + 1e-12
    assert two - one < 1e-9
    assert four - three < 1e-9


def test_a_film_alone_stops_a_head_on_impact() -> None:
    """Where the film takes more than the impact brings, that is a stick; where not, a bounce with the kernel's e_n."""
    entries = {"liquid.glass_transition_pressure": 1e9, "particles.dry_restitution": 0.7}
    scene = Scene.load("granulation-dry-bridge").with_entries(entries)
    outcomes = []
    for stokes in (0.3, 0.9, 1.3, 3.0):
        proof, one = prove(scene, stokes=stokes, angle=0.0), collide(scene, stokes=stokes, angle=0.0, ledger=False)
        assert proof.restitution is not None
        assert proof.restitution[0] - 1e-8 <= one.restitution <= proof.restitution[1] + 1e-8
        assert proof.outcome == one.outcome
        outcomes.append(proof.outcome)
    assert outcomes == ["stick", "stick", "bounce", "bounce"]


RESTING = {"liquid.viscosity": 0.0119, "particles.roughness": 3.3e-6, "bridge.surface_tension": 0.056}


@pytest.mark.parametrize("restitution", [0.0, 0.09, 0.5, 0.8])
def test_rest_in_contact_is_a_proved_stick(restitution: float) -> None:
    """Slip keeps the energy above the barrier; rebounds of falling speed end in rest, and the bridge holds."""
    scene = Scene.load("lactose-pvp").with_entries(RESTING | {"particles.dry_restitution": restitution})
    assert prove(scene, stokes=1.65, angle=1.3435).outcome == "stick"
    assert collide(scene, stokes=1.65, angle=1.3435, ledger=False).outcome == "stick"


@pytest.mark.slow
def test_a_pair_that_rests_for_a_while_is_no_proved_stick() -> None:
    """Spins of both spheres speed up the orbit of a pair at rest until it is released. A proof that takes the orbital
    momentum of the last rebound for all that follow says that it sticks.
    """
    scene = Scene.load("lactose-pvp").with_entries({"particles.dry_restitution": 0.6003})
    scene = beside(scene, 2.392, (-21.95, 3866.3)).with_impact(stokes=5.0273, angle=0.35442)
    one = collide(scene, ledger=False)
    assert one.outcome == "bounce"
    assert "released" in {each.kind for each in one.events}
    assert prove(scene).outcome is None


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"particles.friction": 0.2}, "friction"), ({"model.film": "constant-volume"}, "follows the bridge's volume"),
        ({"model.film": "cavitating"}, ""), ({"model.arm": "surface"}, ""),
    ],
)  # fmt: skip
def test_refusals_name_what_is_not_enclosed(changes: dict[str, object], reason: str) -> None:
    """The reason is what of the structure has no enclosure; a law without one is refused by the engine as well."""
    scene = surface("granulation") if "model.arm" in changes else Scene.load("granulation").with_entries(changes)
    scene = scene.with_impact(stokes=0.1, angle=0.5)
    proof = prove(scene)
    assert proof.outcome is None and proof.reason and reason in proof.reason
    if not reason:
        with pytest.raises(NotProvable):
            engine(select_model(scene, True, fold=True), False, 0)
