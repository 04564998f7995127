"""Exported laws under sanitizers: any bits at all are answered by numbers or refused, and nothing is undefined."""

import shutil
import subprocess
from pathlib import Path

import pytest
from wetdoublet.solvers.export.law.texts import law_name

from ...helpers.exported_law import FOUND, SANITIZED
from .conftest import SPHERES, STRICT

pytestmark = [pytest.mark.slow, pytest.mark.skipif("gcc" not in FOUND, reason="needs gcc and g++")]
HOSTILE = r"""
#include "NAME.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
static uint64_t seed = 1;
static uint64_t next(void) { seed ^= seed << 13; seed ^= seed >> 7; seed ^= seed << 17; return seed; }
static double number(void)
{
    static const double odd[] = {0.0, -0.0, 1e-308, 1e308, -1e308, 1e-30, 1e30, 5e-324, -1.0, (double)NAN, HUGE_VAL};
    if (next()%4 == 0) { double x; uint64_t bits = next(); memcpy(&x, &bits, 8); return x; }
    return next()%3 ? ((double)(next()%2000) - 1000.0)*1e-3 : odd[next()%11];
}
static void fill(void *at, size_t bytes)
{
    for (size_t k = 0; k + 8 <= bytes; k += 8) {
        double x = number();
        memcpy((char *)at + k, &x, 8);
    }
}
static void spoil(void *at, size_t bytes, unsigned count)
{
    while (count--) fill((char *)at + next()%(bytes/8)*8, 8);
}
int main(void)
{
    long wrong = 0, answered[4] = {0, 0, 0, 0};
    for (long k = 0; k < 4000; k++) {
        union { law_material m; double numbers[sizeof(law_material)/8]; } made;
        law_pair_entries entries = law_default_pair_entries();
        spoil(&entries, sizeof entries, (unsigned)(next()%3));
        int status = law_material_of(&entries, &made.m);
        double sum = 0.0;
        for (unsigned n = 0; n < sizeof made/8; n++) sum += fabs(made.numbers[n]);
        wrong += !(sum < HUGE_VAL) || (status != 0) != (sum == 0.0);
        answered[0] += status == 0;
        law_material m = next()%4 ? law_default_material() : made.m;
        spoil(&m, sizeof m, next()%4 == 0);
        law_impact i = {1.0, 0.5, 0.0, 0.0};
        spoil(&i, sizeof i, (unsigned)(next()%3));
        law_collision c;
        status = law_collide(&m, &i, next()%8 ? 1e-6 : number(), 20000, &c);
        wrong += status == 0 && !(fabs(c.restitution) + (c.outcome ? fabs(c.smallest_gap) : 0.0) < HUGE_VAL);
        answered[1] += status == 0;
#if LAW_IN_SPACE
        law_pair p;
        law_pair_after after;
        fill(&p, sizeof p);
        status = law_collide_pair(&m, &p, 1e-6, 20000, &after);
        wrong += status == 0 && !(fabs(after.velocities[0][0]) + fabs(after.spins[0][1]) < HUGE_VAL);
        answered[2] += status == 0;
#endif
#if LAW_FORCES
        law_pair_motion s;
        law_pair_history h;
        law_pair_force found;
        double dt = next()%2 ? 1e-6 : number(), r = law_contact_distance(&m);
        memset(&h, 0, sizeof h);
        fill(&s, sizeof s);
        if (next()%8 == 0) { fill(&h, sizeof h); h.joined = (int)(next()%3); }
        if (next()%2) { memset(s.forces, 0, sizeof s.forces); memset(s.torques, 0, sizeof s.torques); }
        if (next()%2) for (int n = 0; n < 3; n++) s.position[n] = (n == 0)*r*(1.0 - 0.1*(double)(next()%2));
        for (int step = 0; step < 20; step++) {
            if (law_contact_force(&m, &s, dt, &h, &found)) break;
            wrong += isnan(found.force[0] + found.force[1] + found.force[2] + found.torques[0][0]);
            answered[3]++;
            for (int n = 0; n < 3; n++) {
                s.velocity[n] += dt*found.force[n]/m.reduced_mass;
                s.position[n] += dt*s.velocity[n];
            }
        }
#endif
    }
    printf("%ld %ld %ld %ld %ld", wrong, answered[0], answered[1], answered[2], answered[3]);
    return 0;
}
"""


def test_hostile_numbers_under_sanitizers(folder: Path, tmp_path: Path) -> None:
    """Materials, impacts, pairs and forces of bad numbers; the law's own vectors in two lanes; no warning."""
    folder, name = Path(shutil.copytree(folder, tmp_path / "law")), law_name(SPHERES)
    text = HOSTILE.replace("LAW_", f"{name.upper()}_").replace("law_", f"{name}_").replace("NAME", name)
    (folder / "hostile.c").write_text(text)
    command = ["gcc", "-std=c99", *STRICT, "-fsyntax-only", f"{name}.c", "hostile.c", "check.c"]
    subprocess.run(command, cwd=folder, check=True)
    flags = ["-std=c99", *SANITIZED["gcc"], f"-D{name.upper()}_LANES=2"]
    built = subprocess.run(["gcc", *flags, "-c", f"{name}.c"], cwd=folder, check=False, capture_output=True, text=True)
    assert built.returncode == 0, built.stderr
    said = []
    for main in ("hostile", "check"):
        command = ["gcc", *flags, "-o", main, f"{main}.c", f"{name}.o", "-lm"]
        built = subprocess.run(command, cwd=folder, check=False, capture_output=True, text=True)
        if "cannot find" in built.stderr:
            pytest.skip("gcc has no sanitizers here")
        done = subprocess.run([f"./{main}"], cwd=folder, check=False, capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, ""), done.stderr[:2000]
        said.append(done.stdout)
    wrong, *answered = map(int, said[0].split())
    assert wrong == 0
    assert min(answered) > 50
