"""The exported law: it builds everywhere, is our kernel to the last digits, refuses bad input, and shares nothing."""

import importlib.util
import math
import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.generated.automaton import LAST_ANSWER, Status
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.engines.settings import KERNEL_STEPS
from wetdoublet.solvers.engines.taylor.build import kernel
from wetdoublet.solvers.engines.taylor.call import KernelImpacts, task
from wetdoublet.solvers.engines.taylor.layout import ANSWER
from wetdoublet.solvers.export.law.kernels import kernels
from wetdoublet.solvers.export.law.material import results
from wetdoublet.solvers.export.law.texts import law_name

from ...helpers.exported_law import COMPILERS, FOUND, Law, written
from ...helpers.flags import CALLS, QUICK
from .conftest import SPHERES
from .test_law_in_space import arrivals

GRANULATION = Scene.load("granulation")
NEED = pytest.mark.skipif("gcc" not in FOUND, reason="needs gcc and g++")


def random_impacts(law: Law, count: int) -> np.ndarray:
    """Impacts of all outcomes, half of them spinning, some along the line of centres."""
    draw = np.random.default_rng(17)
    speed = 10 ** draw.uniform(-3, 1, count)
    spins = np.where(draw.random((count, 1)) < 0.5, draw.normal(size=(count, 2)), 0.0) * (speed / 1e-4)[:, None]
    angle = np.where(draw.random(count) < 0.2, 0.0, draw.uniform(0, 1.5, count))
    return law.impacts(speed=speed, angle=angle, spin=spins[:, 0], partner_spin=spins[:, 1])


@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.slow
def test_builds_and_checks(compiler: str, folder: Path, tmp_path: Path):
    """As strict C99 in lanes and C++ in plain doubles, without a warning; the vectors of impacts and pairs agree."""
    if compiler not in FOUND:
        pytest.skip(f"{compiler} or {COMPILERS[compiler]} is missing")
    copy = shutil.copytree(folder, tmp_path / "law", ignore=shutil.ignore_patterns("*.so", "mixture*"))
    names = {each.name for each in copy.iterdir()}
    strict = f"-std=c++11 {QUICK} -pedantic -Werror -DGLASS_BEADS_WATER_LANES=1"
    flags = [f"CFLAGS={QUICK} -Werror", f"CXXFLAGS={strict}", f"CC={compiler}", f"CXX={COMPILERS[compiler]}"]
    command = ["make", "-s", "check", "check-cpp", *flags]
    done = subprocess.run(command, cwd=copy, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.count("0 of ") == 4
    subprocess.run(["make", "-s", "clean"], cwd=copy, check=True)
    assert {each.name for each in copy.iterdir()} == names
    flags = "-std=c++20 -pedantic -Wall -Wextra -Werror -DGLASS_BEADS_WATER_LANES=2 -fsyntax-only"
    subprocess.run([COMPILERS[compiler], "-x", "c++", *flags.split(), "glass_beads_water.c"], cwd=copy, check=True)


@NEED
@pytest.mark.slow
def test_is_not_exported_without_a_compiler(tmp_path: Path):
    """Test vectors come from the kernel: what is missing is named."""
    without = os.environ | {"CC": "", "WETDOUBLET_NO_COMPILER": "1", "WETDOUBLET_CACHE": str(tmp_path / "cache")}
    words = ["export", "pendulum", "--to", "c", "--out", tmp_path / "law"]
    done = subprocess.run(
        [sys.executable, "-m", "wetdoublet.solvers", *words], env=without, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "install gcc or clang" in done.stderr


def test_is_our_kernel(law: Law, monkeypatch: pytest.MonkeyPatch):
    """The same variant without contraction gives the same numbers to 1e-12, and the same outcomes."""
    monkeypatch.setenv("WETDOUBLET_CFLAGS", f"{os.environ['WETDOUBLET_CFLAGS']} -ffp-contract=off")
    kernel.cache_clear()  # of those compiled for the test vectors
    impacts = random_impacts(law, 400)
    found = law.collide(impacts)
    assert set(found["outcome"]) == {0, 1, 2}
    which = (impacts["angle"] > 0) | (impacts["spin"] != 0) | (impacts["partner_spin"] != 0)
    own = kernels(SPHERES, 1e-9)[1]
    library, answers = kernel(own.variant), np.zeros(np.count_nonzero(which), ANSWER)
    assert library is not None
    these, found, x0 = impacts[which], found[which], SPHERES.liquid.film_thickness
    others = {"impact_spin": these["spin"].copy(), "impact_partner_spin": these["partner_spin"].copy()}
    at = KernelImpacts(own.scene, these["speed"].copy(), these["angle"].copy(), others)
    task(library, at, 1e-9, KERNEL_STEPS, answers).run()
    assert np.array_equal(found["outcome"], answers["outcome"])
    assert np.array_equal(found["certified"], answers["certified"])
    away = answers["outcome"] > 0
    for name, expected in (
        ("restitution", answers["shown"][:, 0]),
        ("contact_time", answers["time"] * x0 / these["speed"]),
        ("smallest_gap", answers["smallest_gap"] * x0),
        ("rotation", answers["turned"]),
    ):
        np.testing.assert_allclose(found[name][away], expected[away], rtol=1e-12, atol=0)
    kernel.cache_clear()


def test_one_by_one_is_the_batch(law: Law):
    """A single call gives the bits of the batch, of impacts and of pairs; eight threads at once those of one."""
    impacts, pairs = random_impacts(law, 80), law.pairs(*arrivals(SPHERES, 60, seed=5))
    whole = law.collide(impacts).tobytes()
    assert b"".join(law.one(impact[None]).tobytes() for impact in impacts) == whole
    apart = [law.collide_pairs(pairs[k : k + 1]).tobytes() for k in range(pairs.size)]
    assert b"".join(apart) == law.collide_pairs(pairs).tobytes()
    with ThreadPoolExecutor(8) as pool:
        assert all(each.tobytes() == whole for each in pool.map(lambda _: law.collide(impacts), range(8)))


def test_a_budget_ends_what_takes_longer(law: Law):
    """What has more steps is undecided and says so; what has fewer is as without a budget, to the last bit."""
    spent, longer = law.number("UNDECIDED_NO_BUDGET"), 1 << 30
    pairs = law.pairs(*arrivals(SPHERES, 100, seed=5))
    for rows, answers in ((random_impacts(law, 200), law.collide), (pairs, law.collide_pairs)):
        whole, shares = answers(rows), list[float]()
        for budget in (1, 100, longer):
            found = answers(rows, budget=budget)
            over = found["status"] == spent
            for name in whole.dtype.names or ():
                np.testing.assert_array_equal(found[name][~over], whole[name][~over])
            assert np.all(found["outcome"][over] == law.number("UNDECIDED"))
            shares.append(over.mean())
        assert shares[0] > shares[1] > shares[2] == 0
        assert np.all(answers(rows, budget=-1)["status"] == law.number("BAD_BUDGET"))
    contact = law.begin(law.impacts(speed=1.0, angle=0.5), budget=1)
    assert law.advance(contact, 1.0) == spent
    assert contact["motion"][0] == law.number("LOST")


def test_in_pieces_a_contact_is_the_collision(law: Law):
    """Interrupted at random times, it takes the same steps: the numbers at separation are those of one call."""
    draw, apart = np.random.default_rng(3), law.number("APART")
    separated = 0
    for impact in random_impacts(law, 100):
        whole, contact = law.one(impact[None])[0], law.begin(impact[None])
        end = whole["contact_time"] if whole["outcome"] > 0 else 3 * 5e-6 / impact["speed"]
        for time in [*np.sort(draw.uniform(0, end, draw.integers(0, 9))).tolist(), end * (1 + 1e-9)]:
            assert law.advance(contact, time) == 0
        assert (contact["motion"][0] == apart) == (whole["outcome"] > 0)
        if contact["motion"][0] != apart:
            continue
        separated += 1
        assert contact["outcome"][0] == whole["outcome"]
        opening = contact["normal_velocity"][0] / impact["speed"]
        assert opening == pytest.approx(whole["restitution"], rel=1e-8)
        for name, of_whole in (("time", "contact_time"), ("gap", "final_gap"), ("spin", "final_spin")):
            assert contact[name][0] == pytest.approx(whole[of_whole], rel=1e-8)
    assert 10 < separated < 90


@NEED
@pytest.mark.parametrize("stokes", [0.1, 9.0])
def test_a_contact_is_where_the_trajectory_is(law: Law, stokes: float):
    """At times of a trajectory by CasADi, that of a stick also long after its proof."""
    speed, sticks = SPHERES.speed_of(stokes), stokes < 1
    until = 2e-3 if sticks else None
    path = collide(SPHERES, stokes=stokes, angle=1.0, engine="rosenbrock", trajectory=True, until=until).trajectory
    contact = law.begin(law.impacts(speed=speed, angle=1.0))
    for k in range(1, path.time.size - 1, 7):
        if path.time[k] in (path.time[k - 1], path.time[k + 1]):
            continue  # an event, before or after which the velocity is another
        assert law.advance(contact, float(path.time[k])) == 0
        assert contact["gap"][0] == pytest.approx(float(path.gap[k]), rel=1e-6)
        for name, scale in (("normal_velocity", speed), ("rotation_rate", 1e4), ("spin", 1e4), ("rotation", 1.0)):
            assert contact[name][0] == pytest.approx(float(path[name][k]), abs=1e-6 * scale, rel=1e-6)
    assert (contact["outcome"][0], contact["certified"][0]) == ((0, 1) if sticks else (law.number("UNDECIDED"), 0))
    assert law.advance(contact, float(path.time[1])) == law.number("BAD_TIME")


@pytest.mark.slow
def test_shares_no_data(folder: Path, tmp_path: Path):
    """The compiled law has no variable outside its functions: any number of threads may call it."""
    if shutil.which("nm") is None:
        pytest.skip("nm is missing")
    subprocess.run(
        ["gcc", "-std=c99", *QUICK.split(), "-c", "-o", tmp_path / "law.o", folder / "glass_beads_water.c"], check=True
    )
    listed = subprocess.run(["nm", tmp_path / "law.o"], check=True, capture_output=True, text=True).stdout
    kinds = {line.split()[-2]: line.split()[-1] for line in listed.splitlines()}
    assert {"T", "U"} <= set(kinds) <= {"T", "U", "t", "r"}
    public = [line.split()[-1] for line in listed.splitlines() if " T " in line]
    assert all(name.startswith("glass_beads_water_") for name in public)
    called = {line.split()[-1] for line in listed.splitlines() if " U " in line}
    assert not called & {"malloc", "calloc", "free", "printf"}


def test_no_name_of_a_scene_is_one_within_the_law(folder: Path):
    """What the header declares has other names than what the law has for itself, whatever the scene is called."""
    header, prefix = (folder / "glass_beads_water.h").read_text(), "glass_beads_water_"
    public = set(re.findall(rf"\b{prefix}(\w+)", header))
    own = set(re.findall(r"\b[a-z]\w*", re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)))
    within = set(re.findall(r"\b[a-z]\w+", (folder / "glass_beads_water.c").read_text())) - own
    names = {word.removesuffix(f"_{end}") for word in within for end in public if word.endswith(f"_{end}")}
    names |= {path.stem for path in folder.iterdir() if path.suffix in (".c", ".h")} - {prefix[:-1]}
    assert {"check", "example", "vectors"} < names
    for name in names:
        assert law_name(Scene(name, GRANULATION.given)) not in names


@pytest.mark.parametrize(
    ("flags", "said"),
    [
        ("-ffast-math", "compile without"),
        ("-ffinite-math-only", "compile without"),
        ("-funsafe-math-optimizations", "compile without"),
        ("-fassociative-math -fno-signed-zeros -fno-trapping-math", "compile without"),
        ("-mfpmath=387", "rounded as they stand, to doubles"),  # x87 registers round to 64 bits
    ],
)
def test_other_arithmetic_is_not_compiled(flags: str, said: str, folder: Path):
    """By gcc's macros each option is refused that reorders sums, leaves out NaN and infinity or rounds otherwise."""
    command = ["gcc", "-std=c99", *flags.split(), "-fsyntax-only", str(folder / "glass_beads_water.c")]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if "387" in flags and "#error" not in done.stderr and done.returncode:
        pytest.skip("a processor without x87 registers")
    assert "error" in done.stderr and said in done.stderr


@pytest.mark.slow
def test_other_arithmetic_has_no_answers(tmp_path: Path):
    """No macro of clang says that NaNs are ignored: every call refuses, and `make check` fails with the reason."""
    if importlib.util.find_spec("ziglang") is None and shutil.which("clang") is None:
        pytest.skip("needs clang, or ziglang, which contains it")
    clang = ["clang"] if shutil.which("clang") else [sys.executable, "-m", "ziglang", "cc"]
    pendulum = written(Scene.load("pendulum"), tmp_path / "pendulum")  # whose law is in a plane
    options = ["-std=c99", "-O1", CALLS, "-w", "-DPENDULUM_LANES=1", "-fno-honor-nans"]
    files = [str(pendulum / name) for name in ("check.c", "pendulum.c")]
    subprocess.run([*clang, *options, *files, "-lm", "-o", tmp_path / "check"], check=True, capture_output=True)
    done = subprocess.run([tmp_path / "check"], check=False, capture_output=True, text=True)
    assert done.returncode > 0
    refused = [line for line in done.stdout.splitlines() if line.startswith("vector")]
    assert len(refused) > 50
    assert all("compiled with options that reorder sums or leave out NaN and infinity" in line for line in refused)


def test_bad_numbers_are_refused(law: Law):
    """Each number that is not finite, or outside its range, has a status that names it, and no answer."""
    impact = law.impacts(speed=1.0, angle=0.5)
    for structure, given in (("material", law.material()), ("impact", impact)):
        for name in given.dtype.names or ():
            for bad in (math.nan, math.inf, -math.inf, 1e40):
                wrong = given.copy()
                wrong[name] = bad
                if (name, bad) in (("glass_transition_pressure", 1e40), ("youngs_modulus", 1e40)):
                    continue  # as without such a criterion
                found = law.one(impact, material=wrong) if structure == "material" else law.one(wrong)
                assert found["status"][0] == law.number(f"BAD_{name.upper()}")
                assert name in law.message(int(found["status"][0]))
                assert found["outcome"][0] == law.number("UNDECIDED")
                assert math.isnan(found["restitution"][0])
    for rtol in (0.0, math.nan, 1.0):
        assert law.one(impact, rtol)["status"][0] == law.number("BAD_RTOL")


def test_numbers_that_do_not_fit_are_refused(law: Law):
    """Roughness above the film, a bridge that ruptures within it, and an approach that nothing stops."""
    impact = law.impacts(speed=1.0, angle=0.5)
    for changes, status in (
        ({"roughness": 8e-5}, "ROUGHNESS_BEYOND_FILM"),
        ({"volume": 1e-6}, "RUPTURE_WITHIN_FILM"),
        ({"roughness": 0.0, "youngs_modulus": 1e300, "glass_transition_pressure": 1e60}, "NOTHING_STOPS"),
    ):
        material = law.material()
        for name, value in changes.items():
            material[name] = value
        assert law.one(impact, material=material)["status"][0] == law.number(status)


def test_every_failure_of_a_kernel_has_a_message():
    """None is left without a number of its own."""
    failures = {status for status in Status if status > LAST_ANSWER}
    assert failures <= {one.number for one in results(())}
