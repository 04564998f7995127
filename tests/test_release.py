"""The parts of a release agree: versions, bounds, supported Pythons, instruction sets; and its files can be read."""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from wetdoublet.solvers.engines.machine import SETS

yaml = pytest.importorskip("yaml")
ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.yml"))
WHEEL = """
import setuptools  # whose distutils it is
from distutils.core import run_setup

made = run_setup("setup.py", ["bdist_wheel"], stop_after="commandline")
wheel = made.get_command_obj("bdist_wheel")
wheel.ensure_finalized()
print(*wheel.get_tag(), wheel.root_is_pure, made.has_ext_modules())
"""


def read(path: Path):
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def test_versions_agree() -> None:
    """Of the package, its citation, the recipe and the newest release in the changelog, with its date."""
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    newest, date = re.findall(r"^## (\d\S*), (\S+)$", changelog, re.MULTILINE)[0]
    citation, recipe = read(ROOT / "CITATION.cff"), read(ROOT / ".conda/recipe.yaml")
    versions = {PROJECT["project"]["version"], citation["version"], recipe["context"]["version"], newest}
    assert len(versions) == 1
    assert str(citation["date-released"]) == date


def test_the_recipe_has_the_bounds_of_the_package() -> None:
    """Run and build dependencies, and the oldest Python; conda-forge's matplotlib without a window is another name."""
    recipe, project = read(ROOT / ".conda/recipe.yaml"), PROJECT["project"]

    def plain(names):
        return {name.replace(" ", "").replace("matplotlib-base", "matplotlib") for name in names}

    needed = recipe["requirements"]
    assert f">={recipe['context']['python_min']}" == project["requires-python"]
    assert plain(needed["run"][1:]) == plain(project["dependencies"])
    assert plain(needed["host"][2:]) == plain(PROJECT["build-system"]["requires"])


def test_the_supported_pythons_are_tested() -> None:
    """Those of the classifiers, from the oldest that is accepted; the oldest and newest on every system."""
    stated = [name.rpartition(" ")[2] for name in PROJECT["project"]["classifiers"] if re.search(r":: 3\.\d+$", name)]
    matrix = read(ROOT / ".github/workflows/tests.yml")["jobs"]["tests"]["strategy"]["matrix"]
    assert matrix["python"] == stated
    assert PROJECT["project"]["requires-python"] == f">={stated[0]}"
    for system in ("macos-latest", "windows-latest"):
        assert {each["python"] for each in matrix["include"] if each["os"] == system} >= {stated[0], stated[-1]}


def test_wheels_and_recipe_name_all_instruction_sets_of_x86() -> None:
    """So that the widest that a processor has is there; and wheels of other machines name theirs, for all kernels."""
    wheels, *others = PROJECT["tool"]["cibuildwheel"]["overrides"]
    names = {each.name for family in SETS.values() for each in family}
    assert {each["environment"]["WETDOUBLET_INSTRUCTION_SETS"] for each in others} == names - {"x86-64-v3", "x86-64-v4"}
    recipe = (ROOT / ".conda/recipe.yaml").read_text(encoding="utf-8")
    in_recipe, *of_others = re.findall(r"WETDOUBLET_INSTRUCTION_SETS=(\S+)", recipe)
    assert set(of_others) == names - {"x86-64-v3", "x86-64-v4"}
    expected = {each.name for each in SETS["x86_64"]}
    for named in (wheels["environment"]["WETDOUBLET_INSTRUCTION_SETS"], in_recipe):
        assert set(named.split(",")) == expected


def test_only_the_last_job_may_publish() -> None:
    """Workflows read; the job with a trusted publisher's token runs for tags alone, after the others."""
    for path in WORKFLOWS:
        workflow = read(path)
        assert workflow["permissions"] == {"contents": "read"}
        trusted = {name: job for name, job in workflow["jobs"].items() if "permissions" in job}
        assert set(trusted) <= {"publish"}
        for job in trusted.values():
            assert set(job["needs"]) == set(workflow["jobs"]) - {"publish"}
            assert job["if"] == "github.event_name == 'push'"
            assert workflow[True]["push"] == {"tags": ["v*"]}  # yaml's reading of `on`


@pytest.mark.parametrize(("sets", "platform"), [("x86-64", None), ("", "any")])
def test_a_wheel_with_kernels_is_for_one_platform(sets: str, platform: str | None) -> None:
    """Its files lie in platlib, where wheel repair accepts libraries; without kernels it is for any platform."""
    env = os.environ | {"WETDOUBLET_INSTRUCTION_SETS": sets}
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", WHEEL], capture_output=True, text=True, check=True, cwd=ROOT, env=env
    )
    *tag, pure, with_libraries = done.stdout.split()
    assert tag[:2] == ["py3", "none"]
    assert (tag[2] == "any") == (platform == "any")
    assert (pure, with_libraries) == (("True", "False") if platform == "any" else ("False", "True"))


@pytest.mark.skipif(os.name != "posix", reason="names of executables as on POSIX")
@pytest.mark.parametrize(
    ("named", "there", "sets", "fetched"),
    [
        ("", "", None, True),
        ("nonsense", "", None, True),
        ("", "", "", False),  # no kernels
        ("", "gcc", None, False),
        ("x86_64-conda-cc -O2", "x86_64-conda-cc", None, False),
    ],
)
def test_a_compiler_is_fetched_where_there_is_none(
    named: str, there: str, sets: str | None, fetched: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither in CC nor on the path; and only for a wheel with kernels."""
    if there:
        (tmp_path / there).touch(mode=0o700)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("CC", named)
    monkeypatch.delenv("WETDOUBLET_INSTRUCTION_SETS", raising=False)
    if sets is not None:
        monkeypatch.setenv("WETDOUBLET_INSTRUCTION_SETS", sets)
    spec = importlib.util.spec_from_file_location("backend", ROOT / ".build/backend.py")
    assert spec is not None
    assert spec.loader is not None
    backend = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(backend)
    monkeypatch.setattr(backend.build_meta, "get_requires_for_build_wheel", lambda settings: [])
    assert backend.get_requires_for_build_wheel() == (["ziglang"] if fetched else [])
