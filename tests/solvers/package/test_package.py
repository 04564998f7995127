"""`import wetdoublet`: what it offers, what it costs, and what type checkers see of it."""

from __future__ import annotations

import ast
import json
import os
import pkgutil
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
import wetdoublet as wd
from wetdoublet import solvers
from wetdoublet.solvers.engines.taylor.build import kernel_supports

ROOT = Path(__file__).resolve().parents[3]
BUILD = """
import setuptools  # whose distutils it is
from distutils.core import run_setup
print(*run_setup("setup.py", stop_after="init").packages)
"""


def loaded(*programs: str, **settings: str) -> list[set[str]]:
    """The modules, of packages outside the standard library, that a process has loaded at the end of each program."""
    tell = "print(json.dumps(sorted(sys.modules)))"
    text = "\n".join(["import json, sys", *(f"{program}\n{tell}" for program in programs)])
    command, env = [sys.executable, "-c", text], os.environ | settings
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=env)
    told = [{*json.loads(line)} for line in done.stdout.splitlines() if line.startswith('["')]
    return [
        {name for name in found if name.split(".")[0] not in sys.stdlib_module_names}
        | ({"logging", "tempfile", "argparse"} & found)
        for found in told
    ]


def test_dir_is_the_public_names() -> None:
    """`dir()` is `__version__` and what `wetdoublet.solvers` offers; each name is the same object."""
    assert dir(wd) == sorted([*solvers.__all__, "__version__"])
    assert all(getattr(wd, name) is getattr(solvers, name) for name in solvers.__all__)
    assert dir(wd) == sorted([*solvers.__all__, "__version__"])  # what was loaded does not add to it
    modules = {module.name for module in pkgutil.iter_modules(solvers.__path__)}
    assert not modules & set(solvers.__all__)  # a module of that name would take its place once it is imported


def test_docstring_and_version() -> None:
    """The docstring says what the package is for; the version is the distribution's."""
    assert wd.__doc__ is not None
    assert "liquid-coated particles" in wd.__doc__
    assert wd.__version__ == version("wetdoublet")


def test_a_name_that_is_not_there() -> None:
    """An unknown attribute is an AttributeError that names it."""
    with pytest.raises(AttributeError, match="'wetdoublet' has no attribute 'colide'"):
        _ = wd.colide  # type: ignore[attr-defined]  # misspelt


COMMAND = """
import runpy
sys.argv = ["wetdoublet", {}]
try:
    runpy.run_module("wetdoublet", run_name="__main__")
except SystemExit as done:
    assert not done.code
"""
HEAVY = {"sympy", "pint", "xarray", "matplotlib", "scipy", "dask", "distributed", "zarr", "loky", "jax", "torch"}
LOADING = [  # one after another in a process: what each needs, and what none has loaded by then
    [
        ("import wetdoublet", {"wetdoublet"}, HEAVY | {"numpy", "casadi", "click"}),
        (COMMAND.format('"scenes"'), {"click"}, HEAVY | {"casadi"}),
        (COMMAND.format('"collide", "pendulum", "--json"'), {"casadi", "numpy"}, HEAVY),
        (
            COMMAND.format('"map", "granulation", "--stokes", "0.02:0.1:2", "--angle", "60"'),
            {"xarray"}, HEAVY - {"xarray"},
        ),
    ],
    [("import wetdoublet as w\nfor name in w.__all__: getattr(w, name)", {"numpy"}, HEAVY - {"scipy"})],
]  # fmt: skip


@pytest.mark.parametrize("steps", LOADING, ids=["commands", "public names"])
def test_loads_nothing_heavy(steps: list[tuple[str, set[str], set[str]]]) -> None:
    """What makes a start fast; `python -m wetdoublet` is the command."""
    for (_, needed, without), modules in zip(steps, loaded(*(program for program, *_ in steps)), strict=True):
        packages = {module.split(".")[0] for module in modules} - {"__main__", "_distutils_hack"}  # of setuptools
        assert needed <= packages
        assert not packages & without
        assert "wetdoublet" not in needed or packages == needed


@pytest.mark.skipif(not kernel_supports(wd.Scene.load("granulation")), reason="no C compiler")
def test_a_first_collision_loads_what_it_computes_with(tmp_path: Path) -> None:
    """No package but numpy and casadi, no engine that does not answer; with a kernel, no temporary files."""
    program = "import wetdoublet as wd\nwd.collide('granulation', stokes=0.3, angle=0.5)"
    first, (casadi, then) = (
        loaded(*each, WETDOUBLET_CACHE=str(tmp_path)) for each in ([program], ["import casadi", program])
    )
    assert not first[0] & (HEAVY | {"h5py", "click", "tqdm", "argparse"})
    assert {name.split(".")[0] for name in then - casadi} == {"wetdoublet"}


def test_type_checkers_see_every_public_name() -> None:
    """The imports under TYPE_CHECKING in `wetdoublet.solvers` are the public names, and the package imports those."""
    for module, expected in ((wd, ["*"]), (solvers, solvers.__all__)):
        assert module.__file__ is not None
        tree = ast.parse(Path(module.__file__).read_text(encoding="utf-8"))
        (block,) = [node for node in tree.body if isinstance(node, ast.If) and isinstance(node.test, ast.Name)]
        names = [alias.name for node in block.body if isinstance(node, ast.ImportFrom) for alias in node.names]
        assert sorted(names) == sorted(expected)


def test_every_folder_is_packaged() -> None:
    """The build finds each folder of the three trees that holds Python or C files, and none that holds neither."""
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", BUILD], check=True, capture_output=True, text=True, cwd=ROOT, timeout=600
    )
    folders = {
        path.parent.relative_to(ROOT).as_posix()
        for top in ("derive", "generated", "solvers")
        for path in (ROOT / top).rglob("*.*")
        if path.suffix in {".py", ".h", ".toml"}
    }
    expected = {f"wetdoublet.{folder.replace('/', '.')}" for folder in folders - {"solvers/package"}} | {"wetdoublet"}
    assert set(done.stdout.split()) == expected
