"""Published trends of others' experiments, as `docs/explanation/against-experiments.md` lists them."""

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene, boundary, collide, collide_many, critical, gradients_many

PLANE = Scene.from_dict({
    "particles": {"diameter": "12 mm", "density": "7800 kg/m^3", "roughness": "1 um", "dry_restitution": 0.9},
    "partner": {"wall": True},
    "liquid": {"viscosity": "0.1 Pa s", "film_thickness": "100 um"},
})  # fmt: skip
ENTRIES = ["liquid.viscosity", "liquid.film_thickness", "particles.dry_restitution"]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "of_thickness"), [("pendulum", 0.9), ("granulation", 0.1)])
@pytest.mark.parametrize("angle", [45, 60, 70])
def test_turning_doublets_forget_their_film(name: str, of_thickness: float, angle: int) -> None:
    """Donahue et al., JFM 2012: viscosity and dry restitution matter little to e_n and rotation, thickness to rotation.

    Exponents along the strip of stick-rotate-separate, away from its ends, where the rotation grows without bound.
    """
    scene = Scene.load(name)
    [line] = boundary(scene, angle=math.radians(angle)).changes
    low, high = (change.stokes for change in line[:2])
    found = gradients_many(
        scene, stokes=np.linspace(low, high, 12)[2:-2], angle=f"{angle} deg", wrt=ENTRIES,
        of=["restitution", "rotation"],
    )  # fmt: skip
    assert set(found.outcome.values.tolist()) == {1}
    scale = np.array([scene.entries[entry] for entry in ENTRIES])
    exponent = np.median(np.abs(found.gradient.values * scale / found.value.values[..., None]), axis=1)
    viscosity, thickness, dry = exponent.T
    assert viscosity.max() < 0.2
    assert dry.max() == 0
    assert thickness[1] < 0.25
    assert thickness[0] < of_thickness  # not weak on the pendulum, and the page says so


def test_softer_spheres_rebound_at_lower_stokes_numbers() -> None:
    """Davis et al., JFM 2002: St* falls as elasticity grows, weakly; e_n rises with St over St*."""
    critical_numbers = []
    for modulus in (1e8, 1e9, 1e10):
        elastic = {"particles.youngs_modulus": modulus, "particles.poisson_ratio": 0.3}
        soft = PLANE.with_entries({**elastic, "particles.roughness": "0.01 um"})
        [one] = critical(soft, angle=0.0).rows
        assert collide(soft, stokes=1.01 * one.stokes, angle=0.0).reversal == "elastic"
        critical_numbers.append(one.stokes)
    rise = np.diff(critical_numbers)
    assert (rise > 0).all()
    assert (np.abs(np.diff(rise)) < 0.4 * rise[1:]).all()  # of a logarithm the differences are alike
    above = collide_many(soft, stokes=critical_numbers[-1] * np.geomspace(1.01, 30, 20), angle=0.0).restitution.values
    assert (np.diff(above) > 0).all()


def test_restitution_is_linear_in_the_inverse_stokes_number() -> None:
    """Mueller & Huang, PRE 2016: a line in 1/St; its end at infinite St is e_dry here, whatever the thickness."""
    for thickness in ("50 um", "100 um", "200 um"):
        scene = PLANE.with_entries({"liquid.film_thickness": thickness})
        inverse = np.linspace(0.005, 0.08, 25)
        restitution = collide_many(scene, stokes=1 / inverse, angle=0.0).restitution.values
        line = np.polyfit(inverse, restitution, 1)
        assert np.polyval(line, inverse) == pytest.approx(restitution, abs=1e-7)
        assert line[1] == pytest.approx(0.9, abs=1e-7)
        assert line[0] < 0


@pytest.mark.slow
def test_initial_spin_moves_the_tangential_restitution_alone() -> None:
    """Buck et al., Powder Technol. 2017: e_n does not depend on it; rolling increases the tangential velocity."""
    rough = PLANE.with_entries({"particles.friction": 0.3})
    spun = [collide(rough.with_entries({"impact.spin": spin}), speed=2.0, angle=0.5) for spin in (-100.0, 0.0, 100.0)]
    assert [one.outcome for one in spun] == ["bounce"] * 3
    assert spun[0].restitution == pytest.approx(spun[1].restitution, rel=1e-8)
    assert spun[2].restitution == pytest.approx(spun[1].restitution, rel=1e-8)
    tangential = [one.tangential_restitution for one in spun]
    assert min(np.diff(tangential)) > 0.05


def test_viscosity_lowers_restitution_and_the_thickness_that_sticks() -> None:
    """Antonyuk et al., Particuology 2009: more viscosity lowers e_n, and the thickness of the layer that holds."""
    viscosity = np.geomspace(0.02, 0.5, 12)
    varied = {"liquid.viscosity": viscosity}
    restitution = collide_many(PLANE, speed=2.0, angle=0.0, vary=varied).restitution.values
    assert (np.diff(restitution) < 0).all()
    thickness = np.geomspace(2e-6, 1e-3, 200)
    least = []
    for each in (10.0, 20.0, 40.0):
        layers = {"liquid.film_thickness": thickness}
        scene = PLANE.with_entries({"liquid.viscosity": each})
        outcome = collide_many(scene, speed=2.0, angle=0.0, vary=layers).outcome.values
        least.append(thickness[np.flatnonzero(outcome == 0)[0]])
    assert least[0] > least[1] > least[2]


@pytest.mark.parametrize(("thickness", "dry"), [(100e-6, 0.9), (3e-6, 0.35), (0.9e-3, 0.6)])
def test_the_criterion_of_ennis(thickness: float, dry: float) -> None:
    """St* = (1 + 1/e) ln(h/h_a) of an unbounded film; the finite film of the paper has a lower one."""
    ennis = (1 + 1 / dry) * math.log(thickness / 1e-6)
    scene = PLANE.with_entries({"liquid.film_thickness": thickness, "particles.dry_restitution": dry})
    [unbounded] = critical(scene.with_entries({"model.film": "infinite"}), angle=0.0).rows
    [finite] = critical(scene, angle=0.0).rows
    # beside a wall the radius is twice the reduced one of two such spheres, which St takes into account
    assert unbounded.stokes == pytest.approx(ennis, rel=1e-7)
    assert finite.stokes < 0.8 * ennis
