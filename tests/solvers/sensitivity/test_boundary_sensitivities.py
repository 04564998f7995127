"""How boundaries move: against boundaries traced at other parameters, the doubling table, and closed forms."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, boundary, boundary_sensitivities, sensitivities
from wetdoublet.solvers.paper.factors import DOUBLED
from wetdoublet.solvers.sensitivity.boundaries import BoundarySensitivities, Moving

from ...helpers.command import run
from ...helpers.sensitive import HARD, cancelling

pytestmark = pytest.mark.slow

# scene, its changes, degrees, Stokes numbers about the one change that is looked at
LINES = {
    "saddle": ("granulation", {}, 55, (0.02, 0.07)),
    "saddle, surface arm": ("granulation", HARD | {"model.arm": "surface"}, 45, (0.03, 0.09)),
    "graze": ("granulation", {}, 45, (0.08, 0.2)),
    "graze, head-on": ("granulation", {}, 0, (0.08, 0.2)),
    "rim, turned": ("pendulum", {}, 45, (0.9, 1.25)),
    "rim, reversed": ("pendulum", {}, 20, (1.2, 1.6)),
    "graze, strings": ("pendulum", {}, 45, (1.25, 1.6)),
    "rim of a constant force": ("granulation", HARD | {"bridge.law": "constant"}, 45, (0.03, 0.1)),
}
NAMES = ("liquid.film_thickness", "liquid.viscosity", "particles.reduced_radius")
_STEP = 2e-3


def moved(scene: Scene, degrees: float, span: tuple[float, float], **options: object) -> BoundarySensitivities:
    """Sensitivities of the one change within a span."""
    found = boundary_sensitivities(scene, angle=math.radians(degrees), stokes=span, **options)  # type: ignore[arg-type]  # by keyword
    assert len(found.changes[0]) == 1
    assert found.changes[0][0].reason == ""
    return found


def only(found: BoundarySensitivities) -> Moving:
    return found.changes[0][0]


@pytest.mark.parametrize("line", LINES)
def test_boundaries_move_as_traced(line: str) -> None:
    """The elasticities of St* and Ce* are those of boundaries traced with a parameter 0.2 % up and down, to 1e-5."""
    preset, changes, degrees, span = LINES[line]
    scene = Scene.load(preset).with_entries(changes)
    name = NAMES[list(LINES).index(line) % len(NAMES)]
    found = only(moved(scene, degrees, span, wrt=[name], rtol=1e-10))

    def traced(part: float) -> np.ndarray:
        changed = scene.with_entries({name: float(scene.entries[name]) * (1 + part)})
        [[one]] = boundary(changed, angle=math.radians(degrees), stokes=span, rtol=1e-10).changes
        return np.log([one.stokes, one.centrifugal or 1.0, changed.speed_of(one.stokes)])

    slopes = (traced(_STEP) - traced(-_STEP)) / (2 * _STEP)
    # the differences: h^2 = 4e-6 of a third derivative of order one, and St* located to 1e-9 over h
    assert found.elasticity["stokes"][name] == pytest.approx(slopes[0], abs=1e-5)
    assert found.elasticity["speed"][name] == pytest.approx(slopes[2], abs=1e-5)
    if found.change.centrifugal:
        assert found.elasticity["centrifugal"][name] == pytest.approx(slopes[1], abs=2e-5)


@pytest.mark.parametrize("key", ["factor_film", "factor_radius"])
def test_elasticities_add_up_to_a_doubling(key: str) -> None:
    """Ce*(2p)/Ce*(p) is 2 to the mean of the elasticity along the way: the doubling table out of derivatives alone."""
    scene, name = Scene.load("granulation").with_entries(HARD), DOUBLED[key]
    nodes, weights = np.polynomial.legendre.leggauss(4)
    elasticities = []
    for node in nodes:
        there = scene.with_entries({name: float(scene.entries[name]) * 2 ** ((node + 1) / 2)})
        one = only(moved(there, 45, (0.01, 0.2), wrt=[name]))
        elasticities.append(float(one.elasticity["centrifugal"][name] or 0.0))
    # an independent prototype's, midgap, three digits; four nodes of a smooth function are exact beyond that
    expected = {"factor_film": 0.762, "factor_radius": 1.136}[key]
    assert 2 ** (weights @ elasticities / 2) == pytest.approx(expected, abs=6e-4)


def test_direction_of_the_doubling_table() -> None:
    """Every elasticity of Ce* has the sign of its doubling, and predicts its size to within 40 % of the change."""
    scene = Scene.load("granulation").with_entries(HARD)
    found = only(moved(scene, 45, (0.03, 0.09), wrt=list(DOUBLED.values())))
    table = dict(zip(DOUBLED.values(), (1.038, 0.762, 0.983, 1.010, 1.010, 1.136), strict=True))  # the prototype's
    for name, factor in table.items():
        predicted = float(found.elasticity["centrifugal"][name] or 0.0)
        assert predicted == pytest.approx(math.log2(factor), rel=0.4)


def test_dimensional_analysis_of_a_boundary() -> None:
    """St* is a pure number: its elasticities cancel in every unit (length, mass, time)."""
    found = only(moved(Scene.load("granulation"), 55, (0.02, 0.07)))
    # the saddle's neighbourhood is left at 1e-8 of St*
    assert cancelling(found.elasticity["stokes"]) == pytest.approx([0.0] * 3, abs=1e-7)


def test_head_on_graze_in_the_film_alone() -> None:
    """Head-on without a bridge St* is in closed form: u = 1 - Lf(x)/St, and max u/x^2 = glass number ~ 1/St.

    Lf(s) = ln(1/s) - 3/2 + 2s - s^2/2; dSt*/dp_gt by differences of that.
    """
    from scipy.optimize import brentq, minimize_scalar

    scene = Scene.load("granulation-dry-bridge")
    found = only(moved(scene, 0, (0.08, 0.2), wrt=["liquid.glass_transition_pressure"], rtol=1e-10))
    particles, liquid = scene.particles, scene.liquid
    a, m, mu, x0 = particles.reduced_radius, particles.reduced_mass, liquid.viscosity, liquid.film_thickness

    def margin(stokes: float, pressure: float) -> float:
        def minus(s: float) -> float:
            return -(1 - (math.log(1 / s) - 1.5 + 2 * s - s * s / 2) / stokes) / s**2

        peak = -minimize_scalar(minus, bounds=(0.1, 1), method="bounded", options={"xatol": 1e-9}).fun
        speed = stokes * 6 * math.pi * mu * a**2 / m
        return peak * 3 * mu * a * speed / x0**2 / pressure - 1

    def edge(part: float) -> float:
        return float(brentq(margin, 0.08, 0.2, args=(liquid.glass_transition_pressure * (1 + part),), xtol=1e-14))

    assert found.change.stokes == pytest.approx(edge(0), rel=1e-8)
    slope = math.log(edge(1e-3) / edge(-1e-3)) / 2e-3
    assert found.elasticity["stokes"]["liquid.glass_transition_pressure"] == pytest.approx(slope, abs=1e-5)


def test_what_no_boundary_depends_on_is_zero() -> None:
    """A doublet that escapes unreversed knows nothing of the solids, nor of the glass."""
    found = only(moved(Scene.load("granulation"), 55, (0.02, 0.07)))
    for name in ("particles.roughness", "particles.dry_restitution", "liquid.glass_transition_pressure"):
        assert found.gradient["stokes"][name] == 0.0
        assert found.gradient["centrifugal"][name] == 0.0


def test_the_angle_is_the_slope_of_the_curve() -> None:
    """dSt*/dtheta0 is the slope of the traced boundary."""
    scene, h = Scene.load("granulation"), 1e-3
    found = only(moved(scene, 55, (0.02, 0.07), wrt=["impact.angle"], rtol=1e-10))
    at = math.radians(55)
    low, high = boundary(scene, angle=[at - h, at + h], stokes=(0.02, 0.07), rtol=1e-10).changes
    slope = (high[0].stokes - low[0].stokes) / (2 * h)
    assert found.gradient["stokes"]["impact.angle"] == pytest.approx(slope, rel=2e-5)
    relative = [scene.speed_of(one[0].stokes) / math.cos(at + side) for one, side in ((low, -h), (high, h))]
    by_angle = (relative[1] - relative[0]) / (2 * h)
    assert found.gradient["relative_speed"]["impact.angle"] == pytest.approx(by_angle, rel=1e-4)


def test_on_the_command_line() -> None:
    """`boundary --wrt` adds "sensitivities" to each change, and leaves the rest as it is without it."""
    plain = ["boundary", "granulation", "--angle", "55:55:1", "--stokes", "0.02:0.07", "--json"]
    with_ = json.loads(run(*plain, "--wrt", "bridge.volume").stdout)
    without = json.loads(run(*plain).stdout)
    for one, other in zip(with_["changes"][0], without["changes"][0], strict=True):
        both = one.pop("sensitivities")
        assert set(both) == {"stokes", "speed", "relative_speed", "centrifugal"}
        assert set(both["stokes"]) == {"gradient", "elasticity"}
        assert one == other


def test_what_a_boundary_is_followed_in_is_no_parameter() -> None:
    """St* cannot be differentiated in the Stokes number; a misspelt name is told the nearest."""
    with pytest.raises(InputError, match="impact.stokes"):
        boundary_sensitivities("granulation", angle=0.9, wrt=["impact.stokes"])
    with pytest.raises(InputError, match="did you mean bridge.volume"):
        boundary_sensitivities("granulation", angle=0.9, wrt=["bridge.volum"])


def test_a_stick_points_to_its_boundary() -> None:
    """Its table names the command, and `boundary()` is what `boundary_sensitivities` finds at its angle."""
    stick = sensitivities("granulation", wrt=["liquid.viscosity", "impact.speed"], stokes=0.01, angle="60 deg")
    assert "wetdoublet boundary SCENE --wrt" in str(stick)
    found = stick.boundary()
    assert found.parameters == ("liquid.viscosity",)
    expected = boundary_sensitivities("granulation", angle=stick.scene.angle, wrt="liquid.viscosity")
    assert found.to_dict()["changes"] == expected.to_dict()["changes"]
    assert found.changes[0][0].change.before == "stick"
