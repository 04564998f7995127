"""Small requests of a user's model have kernels of their own, which the request alone decides."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide_many, regime_map
from wetdoublet.solvers.engines.machine import own_sets
from wetdoublet.solvers.engines.settings import RTOL, SMALL
from wetdoublet.solvers.engines.taylor.call import variant
from wetdoublet.solvers.engines.taylor.source import flags
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.many.blocks import blocks
from wetdoublet.solvers.many.by_kernel import impacts_of
from wetdoublet.solvers.many.regime_map import Grid

CUSTOM = {"custom.yield_stress": 50.0}


def levels(scene: Scene) -> dict[str, str]:
    """The level of optimization by kind of kernel."""
    kinds = {"large": {}, "small": {"small": True}, "steps": {"trajectory": True}}
    found = {name: flags(variant(scene, True, RTOL, **options), own_sets()[0]) for name, options in kinds.items()}
    return {name: next(flag for flag in given if flag.startswith("-O")) for name, given in found.items()}


def test_only_of_a_users_model_they_are_others(mine: Path) -> None:
    """Kernels of the library are what the package brings; those of a model that records steps are of one collision."""
    assert levels(Scene.load("granulation", model=mine)) == {"large": "-O1", "small": "-Og", "steps": "-Og"}
    assert levels(Scene.load("granulation")) == {"large": "-O2", "small": "-O2", "steps": "-O1"}


@pytest.mark.parametrize("size", [SMALL // 100, SMALL])
def test_a_block_of_a_map_has_the_kernel_of_the_map(mine: Path, size: int) -> None:
    """However it is cut into blocks, or parts of them that are missing."""
    scene = Scene.load("granulation", model=mine).with_entries(CUSTOM)
    axes = {"impact.angle": np.linspace(0.1, 1.4, size), "impact.stokes": np.geomspace(0.01, 0.3, 101)}
    columns = {name: ((name,), axis) for name, axis in axes.items()}
    whole = Grid(scene, columns, tuple(axes), (size, 101), RTOL, "taylor", small=size * 101 <= SMALL)
    for block in (whole.block(at) for at in blocks(whole.shape, "taylor")):
        assert impacts_of(block.subset(np.arange(3)))[0].small == whole.small


@pytest.mark.skipif(compiler() is None, reason="no C compiler")
def test_a_small_map_is_that_of_a_large_request(mine: Path) -> None:
    """The same outcomes as many collisions have, which the other kernel computes, and e_n within the tolerance."""
    scene = Scene.load("granulation", model=mine).with_entries(CUSTOM)
    stokes, angle = np.geomspace(0.01, 0.4, 12), np.linspace(0.0, 1.4, 12)
    of_map = regime_map(scene, stokes=stokes, angle=angle)
    many = collide_many(scene, stokes=np.tile(stokes, 12), angle=np.repeat(angle, 12))
    assert (of_map.outcome.values.ravel() == many.outcome.values).all()
    assert set(many.outcome.values) == {0, 1, 2}
    assert of_map.restitution.values.ravel() == pytest.approx(many.restitution.values, abs=1e-9, nan_ok=True)


_ASKED = """
from wetdoublet.solvers import Scene, collide, collide_many, compile_kernels, regime_map, sensitivities
scene = Scene.load("granulation", model={!r}).with_entries({!r})
assert all(each.already for each in compile_kernels(scene))
collide(scene, angle=0.5), collide(scene, angle=0.5, trajectory=True), collide(scene, angle=0.5, ledger=False)
collide_many(scene, stokes=[0.1, 0.2], angle=0.5), regime_map(scene, stokes=[0.1, 0.2], angle=[0.5])
sensitivities(scene, of=["restitution"], stokes=0.1, angle=0.5)
"""


@pytest.mark.slow
@pytest.mark.skipif(compiler() is None, reason="no C compiler")
def test_compile_has_the_kernels_of_small_requests(mine: Path, tmp_path: Path) -> None:
    """None is compiled for what is asked afterwards."""
    environment = os.environ | {"WETDOUBLET_CACHE": str(tmp_path / "cache")}
    compiled = (sys.executable, "-m", "wetdoublet.solvers", "compile", "granulation", "--model", str(mine))
    options = ("--derivatives", "--set", "custom.yield_stress=50 Pa", "--json")
    done = subprocess.run((*compiled, *options), env=environment, capture_output=True, text=True, check=True)
    there, said = {path.name for path in (tmp_path / "cache").glob("taylor-*.so")}, json.loads(done.stdout)["kernels"]
    assert {use for each in said for use in each["serves"]} >= {"collide", "collide_many", "map", "boundary"}
    assert all(each["seconds"] > 0 and each["bytes"] > 1000 and not each["already"] for each in said)
    assert len(there) == len(said)
    subprocess.run((sys.executable, "-c", _ASKED.format(str(mine), CUSTOM)), env=environment, check=True)
    assert {path.name for path in (tmp_path / "cache").glob("taylor-*.so")} == there
