"""What is made of sensitivities: trajectories, bands of uncertainty, Sobol indices, pictures, what a gradient costs."""

import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from wetdoublet.solvers import (
    ComputationError,
    InputError,
    Scene,
    band,
    collide,
    sobol_indices,
    trajectory_sensitivities,
)
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.scene.schema import FIELDS
from wetdoublet.solvers.sensitivity import uncertainty
from wetdoublet.solvers.sensitivity.uncertainty import deviations, first_order

from ...helpers.reference import sensitivities
from ...helpers.sensitive import CASES, GRANULATION, varied

GLASS = CASES[0].scene
WRT = ("liquid.viscosity", "impact.angle", "bridge.volume")


@pytest.fixture(scope="module")
def trajectory() -> xr.Dataset:
    return trajectory_sensitivities(GLASS, WRT, rtol=1e-10)


def test_the_end_of_a_trajectory_is_the_collision(trajectory: xr.Dataset) -> None:
    """At rupture: dt_f/dp of the event, and du/dp at fixed time plus the acceleration times dt_f/dp is v0 de_n/dp."""
    found = sensitivities(GLASS, ["restitution", "contact_time", "rotation", "final_spin"], WRT, rtol=1e-10)
    late = trajectory.isel(time=slice(-8, None))
    rate = {name: float(np.gradient(late[name].values, late.time.values, edge_order=2)[-1]) for name in
            ("normal_velocity", "rotation", "spin", "gap")}  # fmt: skip
    for name in WRT:
        move = float(trajectory.d_event_time.sel(event="rupture", parameter=name))
        assert move == pytest.approx(found.gradient["contact_time"][name], rel=1e-8)
        for of, value, scale in (
            ("normal_velocity", "restitution", GLASS.speed),
            ("rotation", "rotation", 1.0),
            ("spin", "final_spin", 1.0),
        ):
            slope = float(trajectory[f"d_{of}"].sel(parameter=name)[-1]) + rate[of] * move
            expected = float(found.gradient[value][name] or 0.0) * float(scale or 0)
            # differences of the last samples, which crowd towards the end, give the acceleration to 1e-4
            assert slope == pytest.approx(expected, rel=1e-4, abs=1e-4 * abs(rate[of] * move))


def test_along_a_trajectory(trajectory: xr.Dataset) -> None:
    """dy(t)/dp at fixed t in each phase is what trajectories at two neighbouring parameters show at the same time."""
    from scipy.interpolate import make_interp_spline

    name, h = "liquid.viscosity", 1e-3
    p = float(GLASS.entries[name])
    up, down = (trajectory_sensitivities(varied(GLASS, name, p * (1 + sign * h)), [name]) for sign in (1, -1))
    for phase in dict.fromkeys(trajectory.phase.values):
        inside = np.flatnonzero(trajectory.phase.values == phase)[
            12:-12
        ]  # away from where one trajectory is a phase ahead
        time = trajectory.time.values[inside]
        for of in ("gap", "normal_velocity", "spin"):
            high, low = (
                make_interp_spline(one.time.values[here], one[of].values[here], k=5)(time)
                for one in (up, down)
                for here in [one.phase.values == phase]
            )
            slope = trajectory[f"d_{of}"].sel(parameter=name).values[inside] * p
            # h^2 of the third derivative, some 1e-5; the spline is better
            assert slope == pytest.approx((high - low) / (2 * h), abs=5e-5 * np.abs(slope).max())


def test_saltation_at_the_rebound(trajectory: xr.Dataset) -> None:
    """du/dp jumps where u jumps: from the state before and after, and the move of the event's time, in closed form.

    At fixed t, du+ = -e_dry (du- + a- dt) - a+ dt with dt the move of the event and a the accelerations.
    """
    edge = int(np.flatnonzero(trajectory.phase.values[1:] != trajectory.phase.values[:-1])[0])
    before, after = trajectory.isel(time=edge), trajectory.isel(time=edge + 1)
    assert float(after.normal_velocity) == pytest.approx(-0.99 * float(before.normal_velocity), rel=1e-9)
    u, t = trajectory.normal_velocity.values, trajectory.time.values
    a_before = np.gradient(u[edge - 6 : edge + 1], t[edge - 6 : edge + 1], edge_order=2)[-1]
    a_after = np.gradient(u[edge + 1 : edge + 8], t[edge + 1 : edge + 8], edge_order=2)[0]
    for name in WRT:
        move = float(trajectory.d_event_time.sel(event="glass", parameter=name))
        du_before, du_after = (float(one.d_normal_velocity.sel(parameter=name)) for one in (before, after))
        expected = -0.99 * (du_before + a_before * move) - a_after * move
        assert du_after == pytest.approx(expected, rel=1e-3, abs=1e-3 * abs(a_after * move))  # accelerations: 1e-4


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


@pytest.mark.slow
def test_band_against_samples(tmp_path: Path) -> None:
    """Small uncertainties away from boundaries: the samples' deviation is the first-order one; a stick has none."""
    found = band(
        GRANULATION, {"liquid.viscosity": "2 %", "particles.reduced_radius": "0.5 %"}, "impact.stokes",
        [0.01, 0.05, 0.3], samples=32,
    )  # fmt: skip
    assert list(found.outcome.values) == ["stick", "stick-rotate-separate", "bounce"]
    assert found.first_order.values[0] == found.sampled.values[0] == 0.0
    # 32 points of a Sobol sequence, the next order in sigma: a few percent
    assert found.sampled.values[1:] == pytest.approx(found.first_order.values[1:], rel=0.06)
    assert (found.low <= found.restitution).all()
    found.wetdoublet.plot(tmp_path / "band.png")
    assert (tmp_path / "band.png").stat().st_size > 10_000


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
    assert found.elasticity["restitution"]["particles.roughness"] == 0
    assert 0 < abs(found.elasticity["restitution"]["liquid.viscosity"]) < 1e-15
    lines = {line.split()[0]: line.split()[-1] for line in str(found).splitlines() if line.startswith(("p", "l"))}
    assert (lines["particles.roughness"], lines["liquid.viscosity"]) == ("none", "~0")


def test_sobol_indices() -> None:
    """Of a box in which one parameter matters and one has no influence: index about one, and exactly none."""
    pytest.importorskip("SALib")
    ranges = {"impact.angle": ("60 deg", "66 deg"), "particles.dry_restitution": (0.9, 1.0)}
    found = sobol_indices(GRANULATION, ranges, samples=16)
    assert float(found["total"].sel(parameter="particles.dry_restitution")) == pytest.approx(0.0, abs=1e-12)
    assert float(found["total"].sel(parameter="impact.angle")) == pytest.approx(1.0, abs=0.5)  # 16 base samples
    assert found.attrs["collisions"] == 64


def test_without_salib(monkeypatch: pytest.MonkeyPatch) -> None:
    """One line says what to install."""
    monkeypatch.setitem(sys.modules, "SALib.sample.sobol", None)
    with pytest.raises(ComputationError, match=r"SALib; in the clone run pip install '\.\[global\]'"):
        sobol_indices(GRANULATION, {"impact.angle": ("60 deg", "66 deg")}, samples=2)


def test_the_scene_given_stays_as_it_is() -> None:
    """A result's scene has the impact that was asked for, and collides to the value that was differentiated."""
    found = sensitivities(Scene.load("granulation"), stokes=0.02, angle="75 deg", rtol=1e-10)
    one = collide(found.scene, rtol=1e-10, engine="rosenbrock")
    assert found.value["restitution"] == pytest.approx(one.restitution, rel=1e-9)


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
