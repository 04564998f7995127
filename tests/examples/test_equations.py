"""The programs of the page on the equations in CasADi agree with `collide`, `sensitivities` and `solve`."""

import sys
from pathlib import Path

import pytest
import wetdoublet as wd

pytestmark = pytest.mark.slow
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def page():
    """What is bound after the page's programs."""
    sys.path.insert(0, str(ROOT / "docs/_ext"))
    try:
        from snippets import blocks
    finally:
        sys.path.pop(0)
    text = "".join(
        text for language, text in blocks(ROOT / "docs/how-to/casadi.md") if language == "python" and ".so" not in text
    )
    bound: dict = {}
    exec(text, bound)
    return bound


def test_shooting_has_the_restitution_and_its_elasticities(page):
    """CVODES over durations that a rootfinder finds: e_n to 2e-9, all elasticities to 1e-8 (rtol 1e-9 and 1e-11)."""
    scene, entries = page["scene"], page["eq"].entries
    assert float(page["restitution"](page["values"])) == pytest.approx(wd.collide(scene).restitution, abs=2e-9)
    ours = wd.sensitivities(scene, wrt=list(entries)).gradient["restitution"]
    theirs = dict(zip(entries, page["gradient"](page["values"]).full()[0], strict=True))
    assert len(ours) == 15
    for name, value in entries.items():
        assert theirs[name] * value == pytest.approx(ours[name] * value, abs=1e-8), name
    assert abs(theirs["liquid.film_thickness"] * entries["liquid.film_thickness"]) > 1


def test_the_viscosity_of_a_restitution(page):
    """Newton and ipopt find the viscosity that `solve` finds, and the collision with it has e_n = 0.5."""
    (value,) = wd.solve(page["scene"], free="liquid.viscosity", within=(0.5, 5), restitution=0.5)
    assert (page["by_newton"], page["by_ipopt"]) == pytest.approx((value, value), rel=1e-8)
    scene = page["scene"].with_entries({"liquid.viscosity": page["by_newton"]})
    assert wd.collide(scene).restitution == pytest.approx(0.5, abs=1e-7)


def test_multiple_shooting_finds_viscosity_and_film(page):
    """The data are exact, so that both entries come back, from 20 % and 12 % off."""
    assert page["begin"][:2] == pytest.approx([1.2, 0.875])
    assert page["fitted"] == pytest.approx([1.0, 1.0], abs=1e-6)
