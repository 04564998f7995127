"""What is made of sensitivities: bands of uncertainty, pictures, what a gradient costs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.scene.schema import FIELDS
from wetdoublet.solvers.sensitivity import uncertainty
from wetdoublet.solvers.sensitivity.uncertainty import deviations, first_order

from ...helpers.reference import sensitivities
from ...helpers.sensitive import GRANULATION


def test_first_order_standard_deviation() -> None:
    """Independent inputs add in squares; a percentage is a part of the value, text with a unit is absolute."""
    sigma = deviations(GRANULATION, {"liquid.viscosity": "5 %", "impact.angle": "1 deg"})
    assert sigma == pytest.approx({"liquid.viscosity": 0.1, "impact.angle": np.pi / 180})
    found = sensitivities(GRANULATION, ["contact_time"], tuple(sigma))
    row = found.gradient["contact_time"]
    expected = np.hypot(*(float(row[name] or 0) * sigma[name] for name in sigma))
    assert first_order(found, sigma)["contact_time"] == pytest.approx(expected)
    with pytest.raises(InputError, match="viscosity"):
        deviations(GRANULATION, {"liquid.viscosity": "5 kg"})


def test_samples_at_the_edge_of_what_may_be() -> None:
    """Samples of a value that may only move one way (a contact angle of 0, a head-on impact) lie on that side alone."""
    for name in ("bridge.contact_angle", "impact.angle"):
        assert uncertainty.possible_values(FIELDS[name], 0.0, np.array([0.1, -0.1])).tolist() == [0.1, 0.0]


def test_tornado(tmp_path: Path) -> None:
    """A bar for every parameter that can be seen, as long as its elasticity; the others are named in words."""
    found = sensitivities(GRANULATION, ["restitution", "contact_time"])
    figure = found.plot(tmp_path / "tornado.png")
    assert (tmp_path / "tornado.png").stat().st_size > 10_000
    for axis, name in zip(figure.axes, found.value, strict=True):
        row = {p: v for p, v in found.elasticity[name].items() if v and p not in ("impact.stokes", "liquid.viscosity")}
        lengths = sorted(bar.get_width() for bar in axis.patches)
        assert lengths == pytest.approx(sorted(row.values()))
    longest = max(abs(value or 0) for value in found.elasticity["contact_time"].values())
    assert abs(found.elasticity["contact_time"]["liquid.viscosity"]) < 0.005 * longest  # 1/200 of the panel's longest
    weak, _, none = figure.get_supxlabel().partition("no influence")
    assert "viscosity" in weak and "roughness" in none


def test_the_table_tells_nothing_from_little() -> None:
    """Head-on and reversed at initial contact the film has no work to do: of the viscosity only rounding is left.

    At a fixed speed it is in St and Ca, whose shares cancel; roughness does not enter at all.
    """
    found = sensitivities(GRANULATION.with_impact(stokes=0.3, angle=0.0), ["restitution"], engine="rosenbrock")
    row = found.elasticity["restitution"]
    assert row["particles.roughness"] == 0
    assert abs(row["liquid.viscosity"]) < 1e-15
    found = replace(found, elasticity={"restitution": {**row, "liquid.viscosity": 1e-16}})  # it may be 0 as well
    lines = {line.split()[0]: line.split()[-1] for line in str(found).splitlines() if line.startswith(("p", "l"))}
    assert (lines["particles.roughness"], lines["liquid.viscosity"]) == ("none", "~0")


@pytest.mark.slow
@pytest.mark.skipif(compiler() is None, reason="no C compiler")
def test_the_kernel_answers_where_the_other_engine_misses():
    """Glass met within rounding of initial contact: e_n = e_dry, its derivative 1."""
    scene = Scene.load("granulation-dry-bridge").with_entries(
        {"model.glass": "film-corrected", "liquid.glass_transition_pressure": "1e-3 Pa"}
    )
    found = sensitivities(scene, ["restitution"], ["particles.dry_restitution"], stokes=3, angle=0.5, engine=None)
    assert found.engine == "taylor"
    assert found.gradient["restitution"]["particles.dry_restitution"] == pytest.approx(1.0, rel=1e-9)
