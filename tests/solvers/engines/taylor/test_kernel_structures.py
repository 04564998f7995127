"""What the kernel knows beyond the paper's structures: partners, attractions, films, ruptures, a user's laws."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide, collide_many, sensitivities
from wetdoublet.solvers.engines.taylor import build as library
from wetdoublet.solvers.engines.taylor import call as engine
from wetdoublet.solvers.engines.taylor import headers
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.many.results import QUANTITIES, RATES
from wetdoublet.solvers.sensitivity.result import Sensitivities

pytestmark = [pytest.mark.skipif(compiler() is None, reason="no C compiler"), pytest.mark.slow]
EVERYTHING = (*QUANTITIES, *RATES, "reversal")
STRINGS = {"pendulum.length": 0.01, "bridge.law": "constant", "particles.dry_restitution": 0.9}
RTOL = 1e-7  # of the lowest order, whose kernel is compiled fastest

# preset, what is changed, Stokes numbers, angles in degrees
KINDS: dict[str, tuple[str, dict[str, Any], list[float], list[float]]] = {
    "pair that attracts, cavitating, own rupture": (
        "granulation",
        {"partner.radius": "300 um", "partner.density": "1500 kg/m^3", "attraction.hamaker": 1e-14,
         "model.film": "cavitating", "bridge.law": "willett", "bridge.rupture": "own"},
        [0.01, 0.03, 0.05, 0.1, 0.3, 0.02], [20, 60, 75, 45, 10, 80],
    ),
    "wall that attracts": (
        "granulation-dry-bridge", {"partner.wall": True, "attraction.hamaker": 1e-13},
        [0.01, 0.05, 0.1, 0.3, 1.0, 0.11], [20, 60, 75, 45, 10, 80],
    ),
    "attraction and a film of constant volume on strings": (
        "granulation", STRINGS | {"model.film": "constant-volume", "attraction.hamaker": 1e-15},
        [0.005, 0.02, 0.02, 0.1, 0.2, 0.4], [60, 20, 65, 10, 20, 15],
    ),
}  # fmt: skip


def _scene(kind: str) -> Scene:
    preset, changes, _, _ = KINDS[kind]
    return Scene.load(preset).with_entries(changes)


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Kernels compiled without optimisation: sooner."""
    monkeypatch.setenv("WETDOUBLET_CFLAGS", "-O0")


def _agrees(scene: Scene, stokes: Any, angle: Any) -> np.ndarray:
    """Outcome, proof and every quantity as Rosenbrock has them; returns which sticks are proved."""
    found = collide_many(scene, stokes=stokes, angle=np.radians(angle), rtol=RTOL, engine="taylor", of=EVERYTHING)
    own = engine.run_kernel(engine.Impacts(scene, scene.speed_of(np.array(stokes)), np.radians(angle), {}), RTOL, True)
    assert own is not None
    assert (own["status"] <= 1).all()  # nothing was handed over
    expected = collide_many(
        scene, stokes=stokes, angle=np.radians(angle), rtol=1e-10, engine="rosenbrock", of=EVERYTHING
    )
    for name in ("outcome", "certified", "reason"):
        assert (found[name].values == expected[name].values).all(), name
    for name in EVERYTHING:  # the conditioning of these impacts is at most some tens
        np.testing.assert_allclose(found[name], expected[name], rtol=30 * RTOL, atol=1e-12, err_msg=name)
    return found["certified"].values


@pytest.mark.usefixtures("quick")
def test_both_spins_of_a_pair():
    """`collide` shows the partner's own spin, and what a stick leaves undefined."""
    scene = _scene("pair that attracts, cavitating, own rupture")
    found, expected = (
        collide(scene, stokes=0.1, angle="45 deg", rtol=RTOL, engine=by, ledger=False)
        for by in ("taylor", "rosenbrock")
    )
    assert found.engine == "taylor"
    for name in ("final_spin", "final_spin_partner", "final_rotation_rate", "generalised_centrifugal"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=30 * RTOL), name
    stick = collide(scene, stokes=0.01, angle="20 deg", rtol=RTOL, engine="taylor", ledger=False)
    assert (stick.outcome, stick.certified, stick.final_spin_partner) == ("stick", True, None)


ALONE: list[tuple[str, dict[str, Any]]] = [
    *((preset, {}) for preset in ("granulation", "pendulum", "granulation-dry-bridge")),
    ("granulation", {"bridge.rupture": "own"}),
    ("pendulum", {"model.film": "cavitating"}),
    ("granulation-dry-bridge", {"attraction.hamaker": 1e-18}),
    ("granulation", {"partner.wall": True}),
]


@pytest.mark.parametrize(("preset", "changes"), ALONE, ids=[f"{p} {' '.join(c)}".strip() for p, c in ALONE])
def test_every_kind_is_known(preset: str, changes: dict[str, Any]):
    """Every preset and every kind of change has its headers, none of which failed to be emitted."""
    assert library.kernel_supports(Scene.load(preset).with_entries(changes))


MODEL = '''"""A liquid that thins, and a bridge that is cut off."""
from wetdoublet.derive.user import *

k = quantity("thinning", default="0.3", bounds=">= 0", meaning="loss of resistance with the square of the speed")
law("film", "thinning", resistance=(1 - gap)**2 / gap / (1 + k * opening**2), source="a test")
law("bridge", "cut", force=2 * Max(1 - h, 0), source="a test")
'''


@pytest.fixture(scope="module")
def derived(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cache into which the model above has been derived, the model beside."""
    folder = tmp_path_factory.mktemp("thinning")
    (folder / "thinning.py").write_text(MODEL)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("WETDOUBLET_CACHE", str(folder))
        Scene.load("granulation", model=folder / "thinning.py")
    return folder


@pytest.fixture
def thinning(derived: Path, monkeypatch: pytest.MonkeyPatch) -> Scene:
    """Granulation with that model, and its cache."""
    monkeypatch.setenv("WETDOUBLET_CACHE", str(derived))
    return Scene.load("granulation", model=derived / "thinning.py")


@pytest.mark.usefixtures("quick")
def test_a_users_model_has_its_kernel(thinning: Scene, derived: Path):
    """Laws of one's own, with a group of their own and the velocity, run in the kernel, derived once into the cache."""

    def kept() -> dict[str, int]:
        return {path.name.split("-", 3)[3]: path.stat().st_mtime_ns for path in derived.glob("emitted-*.h")}

    scene = thinning.with_entries({"bridge.law": "mikami"})
    assert _agrees(scene, [0.01, 0.03, 0.05, 0.1, 0.3], [20, 60, 75, 45, 30]).any()
    first = kept()
    assert {"oblique_bridge_reduced", "film_thinning"} <= {name.partition(".")[0] for name in first}
    headers.headers.cache_clear()
    thick, thin = collide_many(
        scene, stokes=0.1, angle=0.8, vary={"custom.thinning": [0.0, 0.3]}, rtol=RTOL, engine="taylor", of=EVERYTHING
    ).restitution.values
    plain = collide_many("granulation", stokes=0.1, angle=0.8, engine="rosenbrock").restitution.values[0]
    assert thick == pytest.approx(plain, rel=30 * RTOL)
    assert thin > thick  # a film that thins takes less
    assert kept() == first


def _differentiates(scene: Scene, of: list[str], stokes: float, angle: float) -> Sensitivities:
    """The kernel's derivatives by all parameters, which are CasADi's to the tolerance."""
    asked = {"of": of, "stokes": stokes, "angle": angle}
    found = sensitivities(scene, **asked, rtol=RTOL, engine="taylor")
    expected = sensitivities(scene, **asked, rtol=1e-10, engine="rosenbrock")
    assert (found.engine, expected.engine) == ("taylor", "rosenbrock")
    for name, row in expected.elasticity.items():
        own, right = (np.array(list(each.values()), dtype=float) for each in (found.elasticity[name], row))
        np.testing.assert_allclose(own, right, atol=100 * RTOL * np.nanmax(np.abs(right)), err_msg=name)
        assert not (right[own != 0] == 0).any()  # what is small is not nothing
    return found


@pytest.mark.usefixtures("quick")
def test_a_wall_that_attracts_has_derivatives():
    """By the Hamaker constant as well, whose part in it is some 1e-12."""
    found = _differentiates(_scene("wall that attracts"), ["restitution", "final_spin"], 0.05, 0.8)
    assert found.gradient["restitution"]["attraction.hamaker"] != 0


@pytest.mark.usefixtures("quick")
def test_a_users_model_has_derivatives(thinning: Scene):
    """By quantities of its own too, of a law that knows the velocity."""
    found = _differentiates(thinning.with_entries({"bridge.law": "mikami"}), ["restitution", "final_spin"], 0.1, 0.8)
    assert found.gradient["restitution"]["custom.thinning"] > 0  # a film that thins takes less


def test_what_has_no_tangent_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    """A law whose slopes are not emitted: one line says why, once, and CasADi answers."""
    texts = headers._texts
    none = ["#error no slopes of it\n"]
    monkeypatch.setattr(headers, "_texts", lambda choice, tangent: none if tangent else texts(choice, tangent))
    headers.tangents.cache_clear()
    headers._say.cache_clear()
    try:
        for stokes in (0.3, 0.4):
            found = sensitivities(Scene.load("granulation"), stokes=stokes, angle=0.5, engine="taylor")
            assert found.engine == "rosenbrock"
    finally:
        headers.tangents.cache_clear()
    assert capsys.readouterr().err == "no derivatives by the Taylor kernel (no slopes of it): other engines answer\n"


def test_a_law_with_a_kink_has_its_kernel(thinning: Scene, capfd: pytest.CaptureFixture[str]):
    """A bridge that is cut off by Max is the kernel's as well, which says nothing and agrees with another engine."""
    found = [collide_many(thinning, stokes=0.3, angle=0.8, engine=by) for by in ("taylor", "rosenbrock")]
    assert capfd.readouterr().err == ""
    assert found[0].attrs["engine"] == "taylor"
    assert found[0].restitution.values == pytest.approx(found[1].restitution.values, rel=1e-6)
