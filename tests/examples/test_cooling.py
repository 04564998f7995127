"""The example of a cooling gas: momentum, energy, and Haff's law where the restitution is constant."""

import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers.host.compiler import compiler

from ..helpers.exported_law import FOUND

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "cooling"
RESTITUTION = 0.9
# The part of an exported law that the example calls, for smooth spheres of one restitution.
CONSTANT = f"""
typedef struct {{ double reduced_radius, reduced_mass; }} granulation_material;
typedef struct {{ double position[3], velocity[3], spin[3]; }} granulation_particle;
typedef struct {{ int outcome; double time; }} granulation_pair_after;
enum {{ GRANULATION_STICK, GRANULATION_OK = 0, GRANULATION_BAD_RTOL = 100 }};
static granulation_material granulation_default_material(void)
{{
    granulation_material m = {{50e-6, 5.2e-9}};
    return m;
}}
static double granulation_contact_distance(const granulation_material *m) {{ return 4.0*m->reduced_radius; }}
static const char *granulation_message(int status) {{ return status ? "refused" : ""; }}
static int granulation_collide_particles(const granulation_material *m, granulation_particle *p,
    granulation_particle *q, double tolerance, double rtol, int budget, granulation_pair_after *after)
{{
    double n[3], r2 = 0.0, speed = 0.0;
    for (int k = 0; k < 3; k++) {{
        n[k] = q->position[k] - p->position[k];
        r2 += n[k]*n[k];
        speed += n[k]*(q->velocity[k] - p->velocity[k]);
    }}
    for (int k = 0; k < 3; k++) {{
        double kick = 0.5*(1.0 + {RESTITUTION})*speed*n[k]/r2;
        p->velocity[k] += kick;
        q->velocity[k] -= kick;
    }}
    after->outcome = 2;
    after->time = 0.0;
    return m && tolerance > 0.0 && rtol > 0.0 ? GRANULATION_OK : GRANULATION_BAD_RTOL;
}}
"""


@pytest.fixture(scope="module")
def cooling() -> object:
    """The script as a module."""
    pytest.importorskip("matplotlib")
    sys.path.insert(0, str(FOLDER))
    try:
        import cooling

        yield cooling
    finally:
        sys.path.remove(str(FOLDER))


@pytest.fixture(scope="module")
def folder(cooling, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The exported law, which programs are compiled with."""
    return cooling.exported(tmp_path_factory.mktemp("law"))


def test_constant_restitution_cools_by_haffs_law(cooling, tmp_path: Path) -> None:
    """T falls as exp(-(1 - e^2) C/3) with the collisions C of a sphere, and as 1/(1 + t/tau)^2 with Enskog's tau."""
    (tmp_path / "granulation.h").write_text(CONSTANT)
    flags = f"-std=c99 -O1 -I{tmp_path} {FOLDER}/cooling.c -lm -o cooling"
    subprocess.run([*compiler().command, *flags.split()], check=True, cwd=tmp_path)
    count, share = 3000, 0.02
    rows, _ = cooling.simulate(tmp_path / "cooling", count, share, 1.0, 30)
    part = rows["temperature"] / rows["temperature"][0]
    assert part == pytest.approx(np.exp(-(1 - RESTITUTION**2) * 2 * rows["bounce"] / count / 3), rel=0.02)
    radius, pairs = 100e-6, (1 - share / 2) / (1 - share) ** 3  # of Carnahan & Starling
    density = share / (4 / 3 * np.pi * radius**3)
    frequency = 4 * density * (2 * radius) ** 2 * pairs * np.sqrt(np.pi * rows["temperature"][0])
    late = rows["bounce"] > 4 * count
    assert (part[late] ** -0.5 - 1) / rows["time"][late] == pytest.approx(
        (1 - RESTITUTION**2) * frequency / 6, rel=0.03
    )


@pytest.mark.slow
def test_a_wet_gas_keeps_its_momentum_and_loses_energy(
    cooling, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Exported, compiled and run small: all three outcomes occur, and a doublet is no single sphere any more."""
    monkeypatch.setenv("CC", shlex.join(compiler().command))
    program = cooling.build(folder, "-O0")
    rows, snapshots = cooling.simulate(program, 200, 0.02, 2.0, 12)
    last = rows[-1]
    assert min(last["stick"], last["rotate"], last["bounce"]) > 10
    assert last["single"] == 200 - 2 * (last["stick"] + last["undecided"])
    assert np.all(np.diff(rows["energy"]) <= 0)
    mass = rows["energy"][0] / (1.5 * 200 * rows["temperature"][0])
    for axis in "xyz":
        assert np.abs(rows[f"momentum_{axis}"]).max() < 1e-12 * 200 * mass * 2.0
    stuck = [np.count_nonzero(snapshots["stuck"][snapshots["number"] == k]) for k in np.unique(snapshots["number"])]
    assert stuck == sorted(stuck)
    assert stuck[-1] == 200 - last["single"]
    for name, draw in (("cooling.png", cooling.draw_cooling), ("strip.png", cooling.draw_strip)):
        draw(rows if name == "cooling.png" else snapshots, tmp_path / name)
        assert (tmp_path / name).stat().st_size > 10_000


@pytest.mark.slow
def test_agglomerates_are_the_same_in_one_lane_and_many(cooling, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Momenta to rounding, energy never grows, and the same bits in one lane and many."""
    texts = []
    for name in FOUND[:1]:
        for flag in ("-march=native", "-DGRANULATION_LANES=1"):
            monkeypatch.setenv("CC", f"{name} {flag}")
            rows, sizes = cooling.agglomerate(cooling.build(folder, "-O0", "agglomerates"), 300, 3, 60)
            last = rows[-1]
            assert last["agglomerates"] < 50
            assert last["rotate"] + last["bounce"] > 200
            assert max(rows["momentum"].max(), rows["angular_momentum"].max()) < 1e-14
            assert np.all(np.diff(rows["energy"]) < 1e-14)
            assert float(sizes.split()[3]) < 1e-14  # of the energy, in a step
            texts.append((sizes, rows.tobytes()))
    assert len(set(texts)) == 1
