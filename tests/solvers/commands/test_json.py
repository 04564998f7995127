"""What JSON objects say of where their numbers come from."""

import json
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.export.differences import Differences
from wetdoublet.solvers.results import UNITS

from ...helpers.command import run

SMALL = ("--stokes", "0.02:0.2", "--rtol", "2e-9")
COMMANDS = {
    "collide": ("collide", "granulation", "--rtol", "2e-9"),
    "sensitivity": ("sensitivity", "granulation", "--wrt", "liquid.viscosity,impact.angle", "--rtol", "2e-9"),
    "boundary": ("boundary", "granulation", "--angle", "50:50:1", *SMALL),
    "boundary, moving": ("boundary", "granulation", "--angle", "50:50:1", *SMALL, "--wrt", "liquid.viscosity"),
    "atlas": ("boundary", "granulation", "--angle", "50:50.5", "--stokes", "0.1:0.14", "--rtol", "2e-9"),
}
EXPECTED = {
    "collide": {"contact_time": "s", "energy": "J", "final_spin": "rad/s", "restitution": "1"},
    "sensitivity": {"restitution": "1", "liquid.viscosity": "Pa s", "impact.angle": "rad"},
    "boundary": {"angles": "rad", "stokes": "1"},
    "boundary, moving": {"angles": "rad", "liquid.viscosity": "Pa s"},
    "atlas": {"x": "rad", "stokes": "1"},
}


@pytest.fixture(scope="module", params=COMMANDS)
def told(request: pytest.FixtureRequest) -> tuple[str, dict[str, Any]]:
    """A command, and its JSON object for granulation with another viscosity."""
    done = run(*COMMANDS[request.param], "--set", "liquid.viscosity=3 Pa s", "--json")
    assert done.exit_code == 0, done.stderr
    return request.param, json.loads(done.stdout)


def test_version_scene_and_tolerance(told: tuple[str, dict[str, Any]]) -> None:
    """The version, the scene's entries in SI as changed, and the tolerance that was asked for."""
    scene = Scene.load("granulation").with_entries({"liquid.viscosity": "3 Pa s"})
    assert told[1]["version"] == version("wetdoublet")
    assert told[1]["scene"] == dict(scene.si)
    assert told[1]["rtol"] == 2e-9


def test_units(told: tuple[str, dict[str, Any]]) -> None:
    """Units are given by key, of parameters by their dotted name."""
    name, found = told
    assert EXPECTED[name].items() <= found["units"].items()


def test_every_number_of_a_collision_has_a_unit() -> None:
    """Each key of the object that holds a number has a unit, and no other has one but events and energy."""
    for scene in ("granulation", "pendulum"):
        found = collide(scene).to_dict()
        numbers = {
            key for key, value in found.items() if isinstance(value, int | float) and not isinstance(value, bool)
        }
        assert numbers <= set(found["units"]) <= set(UNITS) & set(found)


@pytest.mark.parametrize(
    "words",
    [
        ("map", "granulation", "--stokes", "0.05:0.3:2", "--angle", "10:80:3"),
        ("averages", "granulation", "--speeds", "1.5 m/s", "--tolerance", "1e-2"),
    ],
)
def test_a_dataset_is_read_back(words: tuple[str, ...], tmp_path: Path) -> None:
    """The object of a command with -o FILE.nc is the dataset of that file, null in the place of NaN."""
    done = run(*words, "--json", "-o", tmp_path / "data.nc")
    assert done.exit_code == 0, done.stderr
    found, file = xarray.Dataset.from_dict(json.loads(done.stdout)), xarray.open_dataset(tmp_path / "data.nc")
    assert {*found.variables} == {*file.variables}
    for name, column in file.variables.items():
        if column.dtype.kind == "f":
            np.testing.assert_array_equal(found[name].values.astype(float), column.values)
        else:
            assert found[name].values.tolist() == column.values.tolist()


def test_differences_as_an_object() -> None:
    """The law that is another, and the largest change of e_n where it is said to be."""
    done = run("diff", "granulation", "granulation", "--set", "bridge.law=willett", "--json")
    found = json.loads(done.stdout)
    assert any(change["before"] != change["after"] for change in found["changes"])
    off, stokes, angle = found["on_map"]["farthest"]
    scenes = [Scene.load("granulation").with_entries(entries) for entries in ({}, {"bridge.law": "willett"})]
    first, other = (collide(scene, stokes=stokes, angle=angle) for scene in scenes)
    assert first.outcome == other.outcome
    assert other.restitution - first.restitution == pytest.approx(off, abs=1e-8)


def test_differences_name_entries(mine: Path) -> None:
    """The default of a model's quantity, and what is changed; the speeds compared are those of both sides."""
    scene = Scene.load("granulation", model=mine)
    text = str(Differences(("A", "B"), (), None, (scene, scene.with_entries({"custom.yield_stress": 5}))))
    assert "entries that differ:\n\nentry                A     B\ncustom.yield_stress  0 Pa  5.0 Pa" in text
    text = str(Differences(("A", "B"), (), None, (scene, scene.with_entries({"liquid.viscosity": 3}))))
    assert "impact" not in text


def test_a_collision_can_be_repeated_from_its_object() -> None:
    """The scene, the tolerance and the engine of the object give the same numbers again."""
    first = collide("granulation", stokes=0.05, angle="40 deg", rtol=1e-8).to_dict()
    scene = Scene("", tuple(first["scene"].items()))
    assert collide(scene, rtol=first["rtol"], engine=first["engine"]).to_dict() == first
