"""Fits of several scenes together, with shared and own entries, and of the noise."""

import json

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import t as student
from wetdoublet.solvers import Scene, collide_many, fit, log_likelihood
from wetdoublet.solvers.fitting.measurements import Measurements

from tests.helpers.command import run
from tests.helpers.synthetic import drawn

from .test_fit import VISCOSITY, plan

NOISE, FILM = "noise.restitution", "liquid.film_thickness"

OIL = Scene.load("pendulum").with_entries({"name": "oil"})
SYRUP = Scene.load("pendulum").with_entries({"name": "syrup", VISCOSITY: "16 Pa s"})


@pytest.fixture(scope="module")
def tables() -> list[Measurements]:
    """Impacts of two liquids on one kind of sphere."""
    return [drawn(scene, plan(scene, 8, (0.5, 4.0), k), 7 + k) for k, scene in enumerate((OIL, SYRUP))]


def test_a_table_in_two_parts_is_one_table(tables):
    """With all entries shared, parts of a table have the likelihood of the whole, and its gradient."""
    whole, rows = tables[0], np.arange(8)
    parts = [whole.subset(rows[:5]), whole.subset(rows[5:])]
    names = [VISCOSITY, FILM, NOISE]
    at = {VISCOSITY: 13.0, FILM: OIL.entries[FILM], NOISE: 1.2}
    together, alone = log_likelihood([OIL, OIL], parts, names)(at), log_likelihood(OIL, whole, names)(at)
    assert together[0] == pytest.approx(alone[0], rel=1e-10)
    assert together[1] == pytest.approx(alone[1], rel=1e-8)


@pytest.mark.slow
@pytest.mark.usefixtures("optimized")
def test_scenes_that_share_nothing_are_fitted_alone(tables):
    """With an entry of its own each scene has the estimate and the interval that it has alone."""
    found = fit([OIL, SYRUP], tables, VISCOSITY, own=VISCOSITY, starts=0)
    assert found.points == 16
    for scene, table in zip((OIL, SYRUP), tables, strict=True):
        alone, joint = (
            fit(scene, table, VISCOSITY, starts=0).estimates[VISCOSITY],
            found.estimates[f"{VISCOSITY}@{scene.name}"],
        )
        width = alone.high - alone.low
        # an end is found to 2 % of the root of the drop, an estimate to 1e-3 of the log-likelihood
        assert joint.value == pytest.approx(alone.value, abs=0.05 * width)
        assert (joint.low, joint.high) == pytest.approx((alone.low, alone.high), abs=0.05 * width)


@pytest.mark.slow
@pytest.mark.usefixtures("optimized")
def test_gradients_of_shared_and_own_entries_and_of_noise(tables):
    """The gradient is that of the density, for the scatter in speed and angle too."""
    names = [VISCOSITY, FILM, NOISE, "noise.speed", "noise.angle"]
    density = log_likelihood([OIL, SYRUP], tables, names, own={VISCOSITY: ["a", "b"]})
    assert density.names[:2] == (f"{VISCOSITY}@a", f"{VISCOSITY}@b")
    at = np.array([12.4, 15.3, OIL.entries[FILM] * 1.02, 1.1, 0.9, 1.2])
    gradient = density(at)[1]
    for k, name in enumerate(density.names):
        step = np.where(np.arange(at.size) == k, 1e-3 * at, 0.0)
        slope = (density(at + step)[0] - density(at - step)[0]) / (2e-3 * at[k])
        assert gradient[name] * at[k] == pytest.approx(slope * at[k], rel=0.02, abs=0.1)  # of a curvature of hundreds


def test_noise_is_that_of_the_residuals():
    """Without scatter the noise is the rms of the residuals, and its interval that of a normal distribution's width."""
    speed, factor = np.linspace(0.5, 1.0, 12), 1.7
    angle = np.zeros(12)
    exact = collide_many("pendulum", speed=speed, angle=angle).restitution.values
    off = factor * 0.01 * np.random.default_rng(5).standard_normal(12)
    nothing = np.full(12, 1e-7)
    seen = {"restitution": (exact + off, np.full(12, 0.01))}
    data = Measurements(speed, angle, nothing * speed, nothing, np.full(12, 2), seen)
    assert (exact > 0).all()
    found = fit("pendulum", data, NOISE)
    rms = np.sqrt(np.mean(off**2)) / 0.01
    estimate = found.estimates[NOISE]
    assert estimate.value == pytest.approx(rms, rel=5e-3)

    least = 6 * np.log1p(student.ppf(0.975, 12) ** 2 / 12)  # Student's t for 12 values

    def drop(f: float) -> float:
        return 12 * (np.log(f / rms) + (rms / f) ** 2 / 2 - 0.5) - least

    # ends are found to 2 % of the root of the drop, of which a noise of 12 values moves 20 %
    assert estimate.low == pytest.approx(brentq(drop, 0.3 * rms, rms), rel=0.01)
    assert estimate.high == pytest.approx(brentq(drop, rms, 4 * rms), rel=0.01)
    normal = -((off / (0.01 * estimate.value)) ** 2) / 2 - np.log(np.sqrt(2 * np.pi) * 0.01 * estimate.value)
    assert found.log_likelihood == pytest.approx(normal.sum(), abs=0.01)


@pytest.mark.parametrize("free", [VISCOSITY, NOISE])
def test_larger_noise_than_may_be_free_is_not_asked_to_be_freed_again(free):
    """Residuals of eight standard deviations: the remark names the noise to free, or that it goes no further."""
    speed, zero = np.linspace(0.5, 1.0, 12), np.zeros(12)
    exact = collide_many("pendulum", speed=speed, angle=zero).restitution.values
    off = 0.04 * (-1.0) ** np.arange(12)
    seen = {"restitution": (exact + off, np.full(12, 0.005))}
    data = Measurements(speed, zero, 1e-7 * speed, np.full(12, 1e-7), np.full(12, 2), seen)
    [remark] = [text for text in fit("pendulum", data, free, starts=0).remarks if text.startswith("Residuals")]
    assert (f"free {NOISE} estimates" in remark, "goes no further" in remark) == (free != NOISE, free == NOISE)


@pytest.mark.slow
@pytest.mark.usefixtures("optimized")
def test_command(tables, tmp_path):
    """Pairs of scene and data give entries by label, and a scene each."""
    pairs = []
    for scene, table in zip((OIL, SYRUP), tables, strict=True):
        (tmp_path / f"{scene.name}.toml").write_text(scene.to_toml())
        columns = [table.speed, np.degrees(table.angle), table.outcome, table.observed["restitution"][0]]
        words = np.array(["S", "SRS", "B"])[table.outcome]
        lines = [f"{v},{a},{word},{'' if np.isnan(e) else e}" for v, a, word, e in zip(*columns[:2], words, columns[3])]
        (tmp_path / f"{scene.name}.csv").write_text("\n".join(["speed [m/s],angle [deg],outcome,restitution", *lines]))
        pairs += [tmp_path / f"{scene.name}.toml", tmp_path / f"{scene.name}.csv"]
    found = run("fit", *pairs, "--free", VISCOSITY, "--own", VISCOSITY, "--json", "--write", tmp_path / "new.toml")
    assert found.exit_code == 0, found.output
    told = json.loads(found.stdout)
    assert list(told["estimates"]) == [f"{VISCOSITY}@oil", f"{VISCOSITY}@syrup"]
    assert any(remark.startswith("oil: ") for remark in told["remarks"])
    for k, name in enumerate(told["estimates"], 1):
        again = Scene.load(tmp_path / f"new-{k}.toml")
        assert again.entries[VISCOSITY] == pytest.approx(told["estimates"][name]["value"], rel=1e-5)
