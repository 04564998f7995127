"""A table of the granulation preset across three outcomes, its files and readers, against collisions."""

import ctypes
import math
import re
import shutil
import subprocess
from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, Table, boundary, collide_many, gradients_many, table
from wetdoublet.solvers.tables.attack import attack

from ...helpers.command import run
from ...helpers.shared import made_once

STOKES, ANGLE, ERROR = (0.05, 0.4), (math.radians(18), math.radians(35)), 1e-3


@pytest.fixture(scope="module")
def law(tmp_path_factory: pytest.TempPathFactory) -> Table:
    """The table: a triple point, a graze, a separatrix and a rebound at initial contact lie inside."""
    over = {"stokes": STOKES, "angle": ANGLE}
    return made_once(tmp_path_factory, "table", lambda: table("granulation", over=over, error=ERROR, attack=20_000))


def impacts(count: int, seed: int = 7) -> tuple[np.ndarray, np.ndarray]:
    """Random Stokes numbers and angles inside the table."""
    random = np.random.default_rng(seed)
    return np.exp(random.uniform(*np.log(STOKES), count)), random.uniform(*ANGLE, count)


def test_a_table_gives_the_outcomes_and_results_of_collisions(law: Table) -> None:
    """At random impacts outcomes are those of `collide_many`, and results are within the stated error."""
    stokes, angle = impacts(3000)
    said = law(stokes, angle)
    right = collide_many("granulation", stokes=stokes, angle=angle, of=law.of)
    np.testing.assert_array_equal(said.outcome, right.outcome)
    assert set(np.unique(right.outcome)) == {0, 1, 2}
    for name in law.of:
        np.testing.assert_allclose(said[name], right[name], atol=ERROR, rtol=ERROR)


def test_both_sides_of_a_traced_boundary_are_told_apart(law: Table) -> None:
    """At 1e-6 relative below and above each change that `boundary` finds, its two outcomes."""
    angle = 0.55
    changes = boundary("granulation", angle=angle, stokes=STOKES).changes[0]
    for one in changes:
        said = law([one.stokes * (1 - 2e-6), one.stokes * (1 + 2e-6)], angle).outcome.values
        assert [("stick", "stick-rotate-separate", "bounce")[k] for k in said] == [one.before, one.after]


def test_derivatives_are_those_of_the_kernel(law: Table) -> None:
    """By Stokes number and angle, those of e_n agree with `gradients_many`."""
    stokes, angle = np.array([0.08, 0.1, 0.15, 0.2, 0.3]), np.array([0.6, 0.58, 0.4, 0.5, 0.35])
    said = law(stokes, angle, slopes=True)
    wrt = ["impact.stokes", "impact.angle"]
    right = gradients_many("granulation", stokes=stokes, angle=angle, wrt=wrt, hold="stokes")
    expected = right.gradient.sel(quantity="restitution").transpose("collision", "parameter")
    np.testing.assert_allclose(said["d_restitution"], expected, rtol=0.02, atol=0.02)


def test_a_wrong_table_loses_the_attack(law: Table) -> None:
    """A boundary that is moved by 1e-4, or a result by twice the error, is found."""
    moved, raised = deepcopy(law.data), deepcopy(law.data)
    moved.shapes.coefficients[moved.shapes.start[moved.shapes.child[moved.edges[0]]]] += 1e-4
    raised.results.coefficients[raised.results.start] += np.float32(2 * ERROR)
    for wrong in (moved, raised):
        assert attack(wrong, law.scene, None, law.of, ERROR, law.rtol, 1500).failed > 0
    found = attack(law.data, law.scene, None, law.of, ERROR, law.rtol, 1500, seed=99)
    assert found.failed == 0
    assert found.largest <= ERROR


def test_the_attack_accepts_either_side_within_1e_6_of_a_boundary(law: Table) -> None:
    """A boundary moved by 3e-7 in ln St still answers with collisions at most 1e-6 away."""
    moved = deepcopy(law.data)
    moved.shapes.coefficients[moved.shapes.start[moved.shapes.child[moved.edges]]] += 3e-7
    assert attack(moved, law.scene, None, law.of, ERROR, law.rtol, 1500).failed == 0


def test_impacts_outside_are_refused(law: Table) -> None:
    """Outside the ranges the outcome is -1 and results are NaN; at their ends there is an answer."""
    low, high = STOKES
    said = law(
        [low, high, low * (1 - 1e-12), high * (1 + 1e-12), 0.1, 0.1], [0.4] * 4 + [ANGLE[0] - 1e-9, ANGLE[1] + 1e-9]
    )
    assert (said.outcome.values[:2] >= 0).all()
    assert (said.outcome.values[2:] == -1).all()
    assert np.isnan(said.restitution.values[2:]).all()


def test_netcdf_keeps_the_table(law: Table, tmp_path: Path) -> None:
    """A table read back gives the same bits, ranges and errors."""
    law.save(tmp_path / "law.nc")
    again = Table.load(tmp_path / "law.nc")
    assert law(*impacts(500), slopes=True).identical(again(*impacts(500), slopes=True))
    assert (again.range, again.error, again.found.largest, again.of) == (
        law.range,
        law.error,
        law.found.largest,
        law.of,
    )
    assert again.to_dataset().attrs["largest_error_found"] == law.found.largest


def test_a_damaged_netcdf_is_refused(law: Table, tmp_path: Path) -> None:
    """A file with a flipped bit, cut short, empty, of an older version or of another program: one error names it."""
    file = tmp_path / "law.nc"
    law.save(file)
    content = file.read_bytes()
    draw = np.random.default_rng(3)
    cases = [(content[:cut], "damaged") for cut in (len(content) - 1, len(content) - 40, len(content) // 2)]
    cases += [(b"", "no table"), (b"CDF" + bytes(400), "no table")]
    cases += [(content[: content.rindex(b"\nwetdoublet")].replace(b"table 2", b"table 1"), "older version")]
    for place, bit in zip(draw.integers(len(content), size=400).tolist(), draw.integers(8, size=400).tolist()):
        flipped = bytearray(content)
        flipped[place] ^= 1 << bit
        cases.append((bytes(flipped), "damaged"))
    for wrong, problem in cases:
        file.write_bytes(wrong)
        with pytest.raises(InputError, match=problem) as caught:
            Table.load(file)
        assert str(file)[:60] in str(caught.value)  # a long value is shortened
    file.write_bytes(content)
    assert law(*impacts(5)).identical(Table.load(file)(*impacts(5)))


PROGRAM = """#include "law.h"
void query(int count, const double *stokes, const double *angle, int *outcome, double *value, double *slope)
{
    int k, m;
    for (k = 0; k < count; ++k) {
        granulation_answer one;
        granulation_slopes by;
        granulation_table_slopes(stokes[k], angle[k], &one, &by);
        outcome[k] = granulation_table(stokes[k], angle[k], &one) == GRANULATION_TABLE_OK ? one.outcome : -1;
        for (m = 0; m < 2; ++m) {
            value[2 * k + m] = one.value[m];
            slope[4 * k + 2 * m] = by.by[m][0];
            slope[4 * k + 2 * m + 1] = by.by[m][1];
        }
    }
}
"""


@pytest.mark.parametrize(
    "compiler", ["gcc -std=c99", "clang -std=c99", "g++ -std=c++11 -x c++", "clang++ -std=c++11 -x c++"]
)
def test_the_reader_in_c_gives_what_the_reader_in_python_gives(law: Table, tmp_path: Path, compiler: str) -> None:
    """Without a warning, as C and as C++; outside and at the ends of the ranges too."""
    command = compiler.split()
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]} is not installed")
    law.save(tmp_path / "law.h")
    (tmp_path / "query.c").write_text(PROGRAM if "++" not in command[0] else f'extern "C" {{\n{PROGRAM}}}\n')
    strict = ["-O1", "-pedantic", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
    built = [*command, *strict, "query.c", "-o", "query.so", "-lm"]
    if "++" in command[0]:  # a linker's flags are not C++ text
        built = [*command[:2], *strict, *command[2:], "query.c", "-x", "none", "-o", "query.so", "-lm"]
    subprocess.run(built, cwd=tmp_path, check=True, timeout=300)
    stokes, angle = (
        np.concatenate([one, two]) for one, two in zip(impacts(400), ([0.05, 0.4, 0.3, 9.0], [0.4, 0.4, 1.2, 0.4]))
    )
    outcome, value, slope = np.zeros(stokes.size, np.int32), np.zeros((stokes.size, 2)), np.zeros((stokes.size, 2, 2))
    arrays = (one.ctypes.data_as(ctypes.c_void_p) for one in (stokes, angle, outcome, value, slope))
    ctypes.CDLL(str(tmp_path / "query.so")).query(stokes.size, *arrays)
    said = law(stokes, angle, slopes=True)
    np.testing.assert_array_equal(outcome, said.outcome)
    np.testing.assert_allclose(value, np.stack([said[name] for name in law.of], axis=1), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(slope, np.stack([said[f"d_{name}"] for name in law.of], axis=1), rtol=1e-9, atol=1e-9)


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc is not installed")
def test_a_damaged_header_is_refused(law: Table, tmp_path: Path) -> None:
    """A coefficient changed in its last digit: every answer is a status and NaN."""
    law.save(tmp_path / "law.h")
    text = (tmp_path / "law.h").read_text()
    number = re.search(r"granulation_series\[\d+\] = \{\s+-?\d\.(\d+)", text)
    assert number is not None
    last = number.start(1)
    (tmp_path / "law.h").write_text(text[:last] + str((int(text[last]) + 1) % 10) + text[last + 1 :])
    (tmp_path / "status.c").write_text(
        '#include "law.h"\nint main(void)\n{\n    granulation_answer one;\n'
        "    int status = granulation_table(0.2, 0.4, &one);\n"
        "    return !(status == GRANULATION_TABLE_DAMAGED && one.outcome == -1 && one.value[0] != one.value[0]);\n}\n"
    )
    subprocess.run(["gcc", "-std=c99", "-w", "status.c", "-o", "status", "-lm"], cwd=tmp_path, check=True)
    subprocess.run([str(tmp_path / "status")], check=True)


def test_a_third_variable() -> None:
    """Over the dry restitution as well, results agree with collisions of scenes with other values of it."""
    over = {"stokes": (0.15, 0.2), "angle": (0.3, 0.4), "particles.dry_restitution": (0.7, 0.8)}
    law = table("granulation", over=over, error=ERROR, attack=2000)
    random = np.random.default_rng(3)
    stokes, angle, dry = (random.uniform(*ends, 200) for ends in over.values())
    right = collide_many("granulation", stokes=stokes, angle=angle, vary={"particles.dry_restitution": dry})
    np.testing.assert_allclose(law(stokes, angle, dry).restitution, right.restitution, atol=ERROR)
    with pytest.raises(InputError, match="third variable"):
        law(0.17, 0.35)


@pytest.mark.parametrize(
    ("over", "name"),
    [
        ({"stokes": (0.1, 0.2)}, "over"),
        ({"stokes": (0.2, 0.1), "angle": (0.1, 0.2)}, "impact.stokes"),
        ({"stokes": (0.1, 0.2), "angle": (0.1, 1.6)}, "impact.angle"),
        ({"stokes": (0.1, 0.2), "angle": (0.1, 0.2), "bridge.law": (1, 2)}, "over"),
    ],
)
def test_wrong_ranges_are_bad_input(over: dict[str, tuple[float, float]], name: str) -> None:
    """The error names the range."""
    with pytest.raises(InputError) as error:
        table("granulation", over=over)
    assert error.value.field == name


def test_head_on_without_attraction_is_refused() -> None:
    """There e_n falls to 0 with a power of the angle."""
    with pytest.raises(InputError, match=r"impact\.angle"):
        table("granulation-dry-bridge", over={"stokes": (0.1, 0.2), "angle": (0.0, 0.2)})


def test_the_command_writes_a_table_and_draws_it(tmp_path: Path) -> None:
    """`wetdoublet table` says the largest error, writes the file and the picture."""
    file, picture = tmp_path / "law.h", tmp_path / "law.png"
    done = run("table", "granulation", "--over", "stokes=0.15:0.2,angle=20:25", "--error", "1e-3", "--attack", "2000",
               "-o", file, "--plot", picture)  # fmt: skip
    assert done.exit_code == 0, done.output
    assert "largest of 2000 queries" in done.output
    assert "Largest error found" in file.read_text()
    factor = re.search(r"#define GRANULATION_TABLE_STOKES_PER_SPEED (\S+)", file.read_text())
    assert factor is not None
    scene = Scene.load("granulation")
    mass, radius, viscosity = (scene.material[name] for name in ("reduced_mass", "reduced_radius", "viscosity"))
    assert float(factor[1]) == pytest.approx(mass / (6 * math.pi * viscosity * radius**2), rel=1e-14)
    assert picture.stat().st_size > 10_000
