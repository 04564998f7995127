"""Many collisions at once: the same as one by one, whatever the engine, the cores and the compiler."""

import sys
import warnings
from functools import partial
from importlib.metadata import version

import numpy as np
import pint
import pytest
import wetdoublet
import xarray as xr
from loky import process_executor
from wetdoublet.solvers import ModelWarning, Scene, collide, collide_many, gradients_many
from wetdoublet.solvers.errors import ComputationError, InputError
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.many import compute
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.results import BY_DEFAULT, REQUESTED, REVERSALS

PRESETS = {"granulation": (0.005, 0.5), "pendulum": (0.1, 10.0), "granulation-dry-bridge": (0.005, 0.5)}
EVERYTHING = tuple(BY_DEFAULT)


def impacts(preset, count, seed):
    """Random impacts of a preset, one of them head-on."""
    draw = np.random.default_rng(seed)
    low, high = np.log(PRESETS[preset])
    angle = draw.uniform(0.0, np.radians(85), count)
    angle[0] = 0.0
    return np.exp(draw.uniform(low, high, count)), angle


def test_a_failure_is_marked_and_the_rest_go_on(monkeypatch):
    """A collision that raises has outcome -1, NaN and its reason, even for a defect; its neighbours are unharmed."""
    scene = Scene.load("granulation")
    bad = {
        nondimensionalise(scene, scene.speed_of(0.02), 1.0).groups["stokes"]: ComputationError("no luck"),
        nondimensionalise(scene, scene.speed_of(0.03), 1.0).groups["stokes"]: ZeroDivisionError("oops"),
    }

    def integrated(problem, *rest):
        if problem.groups["stokes"] in bad:
            raise bad[problem.groups["stokes"]]
        return real(problem, *rest)

    real = compute.integrated
    plain = collide_many(scene, stokes=[0.01, 0.2], angle=1.0, engine="rosenbrock")
    monkeypatch.setattr(compute, "integrated", integrated)
    data = collide_many(scene, stokes=[0.01, 0.02, 0.03, 0.2], angle=1.0, engine="rosenbrock")
    assert data.outcome.values.tolist() == [plain.outcome.values[0], -1, -1, plain.outcome.values[1]]
    assert data.reason.values.tolist() == ["", "no luck", "internal error: ZeroDivisionError: oops", ""]
    assert np.isnan(data.restitution.values[1:3]).all()
    assert (data.restitution.values[[0, 3]] == plain.restitution.values).all()


@pytest.mark.parametrize("compute", [collide_many, partial(gradients_many, wrt="liquid.viscosity")])
def test_results_share_nothing(compute):
    """What is done to one result, its labels included, leaves the next as it would have been."""
    first = compute("granulation")
    first.outcome.attrs["flag_values"][:] = 7
    first.stokes.attrs["units"] = "spoilt"
    second = compute("granulation")
    assert second.outcome.attrs["flag_values"].tolist() == [-1, 0, 1, 2]
    assert second.stokes.attrs["units"] == "1"


def test_vary():
    """An entry or law that varies is that of each scene; where it makes none, that collision is marked."""
    vary = {"liquid.viscosity": [1.0, 2.0, 3.0], "bridge.law": ["mikami", "willett", "mikami"]}
    data = collide_many("granulation", stokes=0.1, angle="75 deg", vary=vary)
    for k, entries in enumerate(dict(zip(vary, row)) for row in zip(*vary.values())):
        one = collide(Scene.load("granulation").with_entries(entries), stokes=0.1, angle="75 deg", engine="rosenbrock")
        assert data.restitution.values[k] == pytest.approx(one.restitution, rel=1e-8)
    assert {name: data[name].values.tolist() for name in vary} == vary
    rough = collide_many("granulation", vary={"particles.roughness": ["0.2 um", "9 um"]})
    assert rough.outcome.values.tolist()[1] == -1
    assert "particles.roughness" in str(rough.reason.values[1])


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
@pytest.mark.parametrize("preset", ["granulation", pytest.param("pendulum", marks=pytest.mark.slow)])
def test_every_result_is_that_of_collide(preset, engine):
    """All that may be asked for, terms of the ledger included, is what `collide` gives; NaN stands for None."""
    stokes, angle = [0.004, 0.05, 0.4, 0.4], np.radians([60, 75, 20, 0])
    asked = [name for name in REQUESTED if name not in ("outcome", "certified", "reason", "validity")]
    data = collide_many(preset, stokes=stokes, angle=angle, engine=engine, of=asked)
    for k in range(4):
        one = collide(preset, stokes=stokes[k], angle=angle[k], engine=engine)
        for name in asked:
            table, _, term = name.rpartition(".")
            value = getattr(getattr(one, table) if table else one, term)
            if name == "reversal":
                value = -1 if value is None else REVERSALS.index(value)
            value = np.nan if value is None else value
            assert data[name].values[k] == pytest.approx(value, rel=1e-6, abs=1e-12, nan_ok=True), name


def test_arrays_are_broadcast():
    """A column against a row is their grid, as numpy has it, each result where its impact is."""
    stokes, angle = np.array([[0.02], [0.05]]), np.array([0.2, 1.0, 1.3])
    grid = collide_many("granulation", stokes=stokes, angle=angle)
    flat = collide_many("granulation", stokes=np.repeat(stokes, 3), angle=np.tile(angle, 2))
    assert grid.restitution.dims == ("dim_0", "dim_1")
    assert (grid.restitution.values.ravel() == flat.restitution.values).all()
    assert grid.stokes.dims == ("dim_0",)


def test_data_arrays_are_broadcast_by_name():
    """Dimensions and coordinates of DataArrays stay; their units are heeded, and so are those of pint quantities."""
    stokes = xr.DataArray([0.02, 0.05], {"run": ["a", "b"]})
    angle = xr.DataArray([20.0, 60.0, 80.0], {"tilt": [20, 60, 80]}, attrs={"units": "deg"})
    data = collide_many("granulation", stokes=stokes, angle=angle)
    plain = collide_many("granulation", stokes=[[0.02], [0.05]], angle=np.radians([20.0, 60.0, 80.0]))
    assert data.outcome.dims == ("run", "tilt")
    assert data.run.values.tolist() == ["a", "b"]
    assert (data.restitution.values == plain.restitution.values).all()
    turned = collide_many("granulation", stokes=stokes, angle=pint.UnitRegistry().Quantity(60.0, "deg"))
    assert (turned.restitution.values == plain.restitution.values[:, 1]).all()


def test_a_choice_that_its_scene_cannot_have_is_marked():
    """A choice with which the scene is none fails alone; if none of them can be, it is refused."""
    vary = {"bridge.law": ["mikami", "mikami", "willett"], "particles.roughness": ["0.2 um", "0.1 um", "9 um"]}
    data = collide_many("granulation", stokes=0.02, angle=1.3, vary=vary)
    assert data.outcome.values.tolist() == [1, 1, -1]
    with pytest.raises(InputError, match="roughness"):
        collide_many("granulation", stokes=0.02, vary={"bridge.law": "willett", "particles.roughness": "9 um"})


@pytest.mark.slow
def test_parallel_equals_serial(monkeypatch):
    """The number of worker processes changes nothing, to the last bit; idle ones are not killed, for which loky needs
    what slim systems lack.
    """
    stokes, angle = impacts("granulation", 105, 2)
    killed, data = [], []
    kill = process_executor.kill_process_tree
    monkeypatch.setattr(
        process_executor, "kill_process_tree", lambda one, **how: (killed.append(one), kill(one, **how))
    )
    for cores in (2, 1):
        monkeypatch.setattr(compute, "usable_cores", lambda cores=cores: cores)
        data.append(collide_many("granulation", stokes=stokes, angle=angle, engine="rosenbrock", of=EVERYTHING))
    xr.testing.assert_identical(*data)
    assert not killed


def test_without_a_compiler(monkeypatch):
    """A kernel that is not shipped is an error that says what to install; one that is answers."""
    scene = Scene.load("granulation").with_entries({"particles.friction": 0.3, "model.film": "infinite"})
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setitem(sys.modules, "ziglang", None)  # as if not installed
    compiler.cache_clear()
    try:
        assert compiler() is None
        with pytest.raises(ComputationError, match="no C compiler answers here; .*compiler"):
            collide_many(scene, stokes=[0.1, 0.2], angle=0.5, rtol=3e-5)
    finally:
        compiler.cache_clear()


def test_validity_of_laws_that_vary():
    """Where laws vary, each collision is held to the limits of its own: to the flags of a batch of that law alone."""
    laws = ["mikami", "willett"]
    wide = Scene.load("granulation").with_entries({"bridge.volume": 0.4})
    with pytest.warns(ModelWarning):
        both = collide_many(wide, stokes=0.3, angle=1.0, vary={"bridge.law": laws}, of="validity")
    for k, law in enumerate(laws):
        single = wide.with_entries({"bridge.law": law})
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)  # said above
            alone = collide_many(single, stokes=0.3, angle=1.0, of="validity")
        assert both.validity.values[k] == alone.validity.values[0]
        assert both.validity.attrs["flag_meanings"] == alone.validity.attrs["flag_meanings"]


def test_every_dataset_says_which_version_made_it():
    """Of many impacts, of pairs in space, of gradients, and of results that become one."""
    made = [
        wetdoublet.collide_many("granulation", angle=[0.3, 0.4]),
        wetdoublet.collide_pair("granulation", [1.0, 0, 0], [[0.5, 0, 0], [-0.5, 0, 0]], np.zeros((2, 3))),
        wetdoublet.gradients_many("granulation", of=["restitution"], wrt=["liquid.viscosity"], angle=[0.3]),
        wetdoublet.sensitivities("granulation", of=["restitution"], wrt=["liquid.viscosity"]).to_dataset(),
        wetdoublet.boundary("granulation", angle=0.3, stokes=(0.01, 1.0)).to_dataset(),
    ]
    assert {data.attrs["version"] for data in made} == {version("wetdoublet")}
    assert {Scene.from_toml(data.attrs["scene"]) for data in made} == {Scene.load("granulation")}
