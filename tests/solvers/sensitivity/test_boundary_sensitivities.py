"""How boundaries move: against boundaries traced at other parameters, the doubling table, and closed forms."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, boundary, boundary_sensitivities
from wetdoublet.solvers.sensitivity.boundaries import BoundarySensitivities, Moving, moving

from ...helpers.data import DATA
from ...helpers.sensitive import HARD

pytestmark = pytest.mark.slow

# scene, its changes, degrees, Stokes numbers about the one change that is looked at
LINES = {
    "saddle": ("granulation", {}, 55, (0.02, 0.07)),
    "graze": ("granulation", {}, 45, (0.08, 0.2)),
    "rim, turned": ("pendulum", {}, 45, (0.9, 1.25)),
    "graze, strings": ("pendulum", {}, 45, (1.25, 1.6)),
    "rim of a constant force": ("granulation", HARD | {"bridge.law": "constant"}, 45, (0.03, 0.1)),
}
DRAWN_IN, TURNS_TWICE = json.loads((DATA / "moving_boundaries.json").read_text()).values()
REBOUNDS_TO_THE_RIM = {  # the doublet that just leaves the film was reversed in it: no gradient grows there
    "particles": {"reduced_radius": 3.1445e-05, "reduced_mass": 4.07395e-08, "roughness": 3.96947e-07,
                  "dry_restitution": 0.62647, "youngs_modulus": 9.45574e9, "poisson_ratio": 0.026088},
    "liquid": {"viscosity": 0.529452, "film_thickness": 1.50916e-06, "glass_transition_pressure": 1.85579e8},
    "impact": {"angle": 1.0472},
    "partner": {"wall": True},
}  # fmt: skip
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


@pytest.mark.parametrize(
    ("tables", "span", "kind", "name"),
    [
        (DRAWN_IN, (1.8, 2.1), "escape", "particles.roughness"),
        (DRAWN_IN, (4.0, 4.6), "escape reversed", "particles.dry_restitution"),
        (TURNS_TWICE, (0.115, 0.13), "escape", "liquid.film_thickness"),
        (REBOUNDS_TO_THE_RIM, (0.7, 1.0), "escape reversed", "liquid.film_thickness"),
    ],
)
def test_what_parts_both_sides_is_differentiated(
    tables: dict[str, dict[str, object]], span: tuple[float, float], kind: str, name: str
) -> None:
    """Where the first criteria of both sides do not tell: the slope is that of boundaries traced 0.2 and 0.4 % off."""
    scene = Scene.from_dict({table: dict(entries) for table, entries in tables.items()})
    found = only(moved(scene, math.degrees(scene.angle), span, wrt=[name], rtol=1e-10))

    def traced(part: float) -> float:
        changed = scene.with_entries({name: float(scene.entries[name]) * (1 + part)})
        [[one]] = boundary(changed, stokes=span, rtol=1e-10).changes
        return math.log(one.stokes)

    near, far = (traced(step) - traced(-step) for step in (_STEP, 2 * _STEP))
    # St* located to 1e-9 over the step
    assert found.elasticity["stokes"][name] == pytest.approx((8 * near - far) / (12 * _STEP), abs=2e-6)
    assert found.change.kind == kind


def test_a_criterion_met_at_initial_contact() -> None:
    """From the pressure p_gt on that a doublet brings, it rebounds at once: St* ~ p_gt x0^2/(mu a v0) alone."""
    scene = Scene.from_dict(DRAWN_IN | {"liquid": DRAWN_IN["liquid"] | {"glass_transition_pressure": 500.0}})
    names = ["liquid.viscosity", "liquid.glass_transition_pressure", "particles.dry_restitution"]
    # u = v0 and x = x0 there: p_gt = 3 mu a v0/x0^2, and St = m v0/(6 pi mu a^2)
    liquid, a, m = scene.liquid, scene.reduced_radius, scene.reduced_mass
    expected = 500.0 * liquid.film_thickness**2 * m / (18 * math.pi * liquid.viscosity**2 * a**3)
    found = only(moved(scene, 42.228, (0.5 * expected, 2 * expected), wrt=names))
    assert found.change.stokes == pytest.approx(expected, rel=1e-8)
    # no gradient grows there: the change is located to 1e-11 with entries moved by 1e-5
    assert list(found.elasticity["stokes"].values()) == pytest.approx([-2.0, 1.0, 0.0], abs=1e-6)


def test_a_change_that_is_none_has_no_slope() -> None:
    """Beside a Stokes number at which nothing changes, the outcomes contradict the change: its reason says so."""
    scene = Scene.load("granulation")
    [[one, *_]] = boundary(scene, angle=math.radians(55), stokes=(0.02, 0.07)).changes
    wrong = moving(scene, math.radians(55), replace(one, stokes=one.stokes * 1.01), ("liquid.viscosity",))
    assert not wrong.gradient
    assert "end in" in wrong.reason


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


def test_what_a_boundary_is_followed_in_is_no_parameter() -> None:
    """St* cannot be differentiated in the Stokes number; a misspelt name is told the nearest."""
    with pytest.raises(InputError, match="impact.stokes"):
        boundary_sensitivities("granulation", angle=0.9, wrt=["impact.stokes"])
    with pytest.raises(InputError, match="did you mean bridge.volume"):
        boundary_sensitivities("granulation", angle=0.9, wrt=["bridge.volum"])
