"""What a command loads: a cold start pays only for what it needs."""

import json
import pkgutil
import subprocess
import sys

import pytest
from wetdoublet import solvers

CLUSTER = ("distributed", "zarr")
HEAVY = ("sympy", "pint", "xarray", "matplotlib", "loky", "scipy", "dask", *CLUSTER)
PROGRAM = """
import atexit, json, sys
atexit.register(lambda: sys.stderr.write("loaded " + json.dumps(sorted({m.split(".")[0] for m in sys.modules}))))
from wetdoublet.solvers.commands.cli import main
main(sys.argv[1:])
"""


def loaded(*arguments: str) -> tuple[str, set[str]]:
    """Standard output of a command in a fresh interpreter, and the packages in it at exit."""
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, *arguments], capture_output=True, text=True, check=True, timeout=900
    )
    return done.stdout, set(json.loads(done.stderr.partition("loaded ")[2]))


@pytest.mark.parametrize("name", ["granulation", "pendulum", "granulation-dry-bridge"])
def test_one_collision_loads_nothing_heavy(name: str) -> None:
    """`collide --json`: neither sympy, pint, xarray, matplotlib, loky, scipy nor Dask; it needs casadi and numpy."""
    out, packages = loaded("collide", name, "--json")
    assert json.loads(out)["outcome"] == "stick-rotate-separate"
    assert {"casadi", "numpy", "wetdoublet"} <= packages
    assert not packages & set(HEAVY)


def test_a_map_without_a_cluster_loads_nothing_of_one() -> None:
    """`map` loads neither Zarr nor Dask's scheduler; of Dask xarray itself loads what it can find."""
    _, packages = loaded("map", "granulation", "--stokes", "0.02:0.1:2", "--angle", "60")
    assert "xarray" in packages
    assert not packages & set(CLUSTER)


def test_an_input_error_loads_no_integrator() -> None:
    """`scenes` integrates nothing and does not load casadi."""
    out, packages = loaded("scenes")
    assert "granulation" in out
    assert not packages & {"casadi", *HEAVY}


def test_no_public_name_is_a_modules() -> None:
    """A module of the same name would take its place, once something had imported it."""
    modules = {module.name for module in pkgutil.iter_modules(solvers.__path__)}
    assert modules > {"scene", "errors"}
    assert not modules & set(solvers.__all__)
