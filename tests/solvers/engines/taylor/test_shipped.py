"""Kernels that come compiled with the package: which they are, and what is never loaded."""

import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines import machine, ship
from wetdoublet.solvers.engines.kernels import needed
from wetdoublet.solvers.engines.settings import RTOL
from wetdoublet.solvers.engines.taylor import shipped
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.scene.scenefile import PRESETS

V3 = "abm avx2 bmi1 bmi2 f16c fma movbe"
V4 = f"{V3} avx512bw avx512cd avx512dq avx512f avx512vl"
COLLIDED = """
import pathlib, sys

sys.modules["ziglang"] = None  # as if not installed
import wetdoublet as wd
from wetdoublet.solvers.engines import machine, ship

if sys.argv[2:]:
    lesser = machine.sets_of(sys.argv[2], [])
    machine.own_sets = lambda: lesser
from wetdoublet.solvers.engines import ship
from wetdoublet.solvers.engines.taylor import build, shipped

shipped.FOLDER = pathlib.Path(sys.argv[1])
one = wd.collide("granulation", stokes=0.3, angle=0, ledger=False)
values = [each for each in ship.variants() if each.choice.structure == "head_on_bridge" and not each.gradients]
sizes = [build.size_of(each) for each in values]
print(one.engine, one.restitution.hex(), min(sizes))
"""
needs_compiler = pytest.mark.skipif(compiler() is None, reason="no C compiler")


@pytest.mark.parametrize(
    ("kind", "features", "expected"),
    [
        ("x86_64", "fpu sse sse2 ssse3", ["x86-64"]),
        ("x86_64", "fpu sse2 avx avx2 fma", ["x86-64"]),  # some of the third level is missing
        ("AMD64", f"sse2 {V3}", ["x86-64-v3", "x86-64"]),
        ("x86_64", f"sse2 {V4}", ["x86-64-v4", "x86-64-v3", "x86-64"]),
        ("arm64", "fp asimd evtstrm aes", ["armv8-a"]),
        ("riscv64", "", ["scalar"]),
    ],
)
def test_a_processor_has_the_instruction_sets_of_its_features(kind: str, features: str, expected: list[str]) -> None:
    """As the x86-64 psABI lists them; each set below the widest one too."""
    assert [each.name for each in machine.sets_of(kind, features.split())] == expected


def test_lanes_are_the_doubles_in_a_register() -> None:
    """Of 512, 256 and 128 bits."""
    assert {each.name: 64 * each.lanes for family in machine.SETS.values() for each in family} == {
        "x86-64-v4": 512, "x86-64-v3": 256, "x86-64": 128, "armv8-a": 128,
    }  # fmt: skip


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the shipped kernels of head-on values with a bridge, as the package's build compiles them."""
    return build(tmp_path_factory.mktemp("shipped") / "kernels")


def build(folder: Path, *sets: str) -> Path:
    command = [sys.executable, "-m", ship.__name__, str(folder), *sets]
    subprocess.run([*command, "--structure", "head_on_bridge"], env=without_flags(), check=True)
    return folder


def without_flags(**more: str) -> dict[str, str]:
    """The environment without the suite's compiler flags, with which nothing shipped is used."""
    return {name: value for name, value in os.environ.items() if name != "WETDOUBLET_CFLAGS"} | more


def collided(folder: Path, tmp_path: Path, *lesser: str) -> tuple[str, str]:
    """Output and remarks of a process without compiler whose shipped kernels are in a folder.

    Arguments:
        lesser: kind of a machine whose processor has no more than the least of its instruction sets.
    """
    env = without_flags(PATH=str(tmp_path), WETDOUBLET_CACHE=str(tmp_path / "cache")) | {"CC": ""}
    command = [sys.executable, "-c", COLLIDED, str(folder), *lesser]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=env)
    return done.stdout, done.stderr


@pytest.mark.slow
@needs_compiler
def test_without_a_compiler_the_shipped_kernel_answers(built: Path, tmp_path: Path) -> None:
    """And nothing is said, compiled or kept; nor for the sizes that `wetdoublet compile` shows."""
    said, remarks = collided(built, tmp_path)
    assert (said.split()[0], remarks) == ("taylor", "")
    assert int(said.split()[2]) > 0
    assert not (tmp_path / "cache").exists()


@pytest.mark.slow
@needs_compiler
@pytest.mark.skipif(machine.sets_of(platform.machine(), [])[0].name != "x86-64", reason="one instruction set only")
def test_a_lesser_processor_loads_the_baseline(built: Path, tmp_path: Path) -> None:
    """Of x86-64, where the wheel has wider sets too: its digits are those of the wider to rounding."""
    several = shutil.copytree(built, tmp_path / "several")
    for path in build(tmp_path / "baseline", "x86-64").iterdir():
        shutil.copy(path, several)
    wide, narrow = (collided(several, tmp_path, *lesser)[0].split() for lesser in ((), ("x86_64",)))
    assert narrow[0] == "taylor"
    assert float.fromhex(narrow[1]) == pytest.approx(float.fromhex(wide[1]), rel=1e-9)  # the tolerance
    with pytest.raises(subprocess.CalledProcessError):
        build(tmp_path / "unknown", "x86-64-v9")


@pytest.mark.slow
@needs_compiler
def test_a_damaged_or_stale_library_is_not_loaded(built: Path, tmp_path: Path) -> None:
    """One flipped bit is named; a library of other equations is no library of these. Then no kernel is there."""
    shutil.copytree(built, damaged := tmp_path / "damaged")
    for path in damaged.iterdir():
        content = bytearray(path.read_bytes())
        content[len(content) // 2] ^= 1
        path.write_bytes(content)
    shutil.copytree(built, stale := tmp_path / "stale")
    for path in list(stale.iterdir()):
        name, digest, _ = path.name.split(".")
        path.rename(path.with_name(f"{name[:-1]}{'0' if name[-1] != '0' else '1'}.{digest}.so"))
    for folder, expected in ((damaged, "is damaged"), (stale, "no C compiler")):
        with pytest.raises(subprocess.CalledProcessError) as stopped:
            collided(folder, tmp_path)
        assert expected in stopped.value.stderr
        assert "the kernel for this scene is not shipped" in stopped.value.stderr


@needs_compiler
def test_beside_a_compiler_an_installation_has_the_kernels_of_its_first_questions(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Those of oblique collisions of granulation, without derivatives, which the README's commands ask for."""
    wanted = {variant for _, oblique, variant in needed(Scene.load("granulation"), [RTOL], False) if oblique}
    assert {*ship.values_for_here()} == wanted
    if shipped.FOLDER.is_dir():
        monkeypatch.delenv("WETDOUBLET_CFLAGS")  # with which nothing shipped is used
        assert all(map(shipped.is_shipped, wanted))


def test_without_a_compiler_an_installation_has_the_values_of_every_preset(monkeypatch: pytest.MonkeyPatch) -> None:
    """At the default tolerance; a wheel that is published has derivatives, too (.ci/installed.py)."""
    monkeypatch.setattr(ship, "compiler", lambda: None)
    there = {*ship.values_for_here()}
    assert {variant for name in PRESETS for _, _, variant in needed(Scene.load(name), [RTOL], False)} == there
