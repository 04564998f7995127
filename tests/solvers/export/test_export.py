"""`diff`: exactly the terms that differ, and what they do; `export`: equations that read, C that computes the same."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from matplotlib.mathtext import MathTextParser
from wetdoublet.derive.emit.casadi.modules import law_module
from wetdoublet.derive.emit.compare import compare, equations, plain, same
from wetdoublet.derive.emit.read import ReadError, functions
from wetdoublet.derive.laws.modelfile import read
from wetdoublet.solvers import Scene, collide, collide_many
from wetdoublet.solvers.export import differences
from wetdoublet.solvers.export.functions import texts as c_texts
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model

from ...helpers.command import run
from ...helpers.exported_law import FOUND, Law, law_alone
from .conftest import STRICT

GENERATED = Path(differences.__file__).parents[2] / "generated"
RULES = ("__init__.py", "assemble.py", "automaton.py", "references.py")  # no equations
MODULES = sorted(path for path in GENERATED.rglob("*.py") if path.name not in RULES)


def edited(path: str, before: str, after: str):
    """Changes found when `before` stands as `after` in an emitted module."""
    text = (GENERATED / path).read_text()
    assert before in text
    pair = (equations({"here": each}) for each in (text, text.replace(before, after)))
    return [(change.kind, change.equation, change.before, change.after) for change in compare(*pair)]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.stem)
def test_every_emitted_module_is_read_back(path: Path):
    """What is emitted is read as mathematics without being run: as many functions as it has, no change to itself."""
    text = path.read_text()
    assert len(functions(text)) == len(re.findall(r"^def ", text, re.MULTILINE)) > 0
    found = equations({"": text})
    assert compare(found, found) == ()


def test_a_law_with_a_kink_is_read_back():
    """A law that ends at a gap, and one of a power of the speed: read as one equation and its parts, without guards."""
    forms = (
        '"bridge", "mine", force=pi*R*sigma*Max(0, 2 - x/x0/10)',
        '"film", "mine", resistance=mu*a*u*(Abs(u)/v0)**0.7',
    )
    for form in forms:
        [law] = read(Path("mine.py"), f"from wetdoublet.derive.user import *\nlaw({form})\n").laws
        text = law_module(law)
        assert law.functions[0].kinks and f"def {law.functions[0].name}_kinks(" in text
        assert [function.name for function in functions(text)] == [law.functions[0].name]


def test_an_added_and_a_removed_term():
    """A force more in the equation of motion is added to it; read the other way it is removed."""
    text = (GENERATED / "oblique_reduced.py").read_text()
    more = text.replace(
        '"normal_velocity": centrifugal_force - film_force', '"normal_velocity": centrifugal_force - film_force - gap'
    )
    assert more != text
    one, other = (equations({"": each}) for each in (text, more))
    [added] = compare(one, other)
    [removed] = compare(other, one)
    assert (added.kind, added.equation, plain(added.after)) == ("added", "d normal_velocity/dt", "-gap")
    assert (removed.kind, plain(removed.before)) == ("removed", "-gap")


def test_what_a_change_does_to_the_map():
    """Impacts that change outcome are counted along the boundary; the largest change of e_n is that of collisions."""
    thicker = {"liquid.viscosity": "2.1 Pa s"}
    on_map = differences.differences("granulation", "granulation", changes=thicker).on_map
    assert on_map is not None and on_map.impacts == 61**2 and 0 < sum(count for *_, count in on_map.moved) < 200
    off, stokes, angle = on_map.farthest
    ends = [collide(Scene.load("granulation").with_entries(each), stokes=stokes, angle=angle) for each in (thicker, {})]
    assert ends[0].outcome == ends[1].outcome
    assert off == pytest.approx(ends[0].restitution - ends[1].restitution, abs=1e-9)
    assert differences.differences("granulation", "granulation").on_map.moved == ()


def test_rearranging_is_no_difference():
    """The same mathematics written otherwise differs in no term; another sign does."""
    assert edited("laws/bridge_constant.py", "2*cos(contact_angle)", "cos(contact_angle)/0.5") == []
    assert len(edited("laws/bridge_constant.py", "2*cos(contact_angle)", "-2*cos(contact_angle)")) == 1
    x = sp.Symbol("x", positive=True)
    assert same((x + 1) ** 2, x**2 + 2 * x + 1)
    assert not same(sp.sin(x), x)


def test_foreign_code_is_not_read():
    """Text that is never emitted is an error that names its line."""
    with pytest.raises(ReadError, match="line 2"):
        functions("def f(x):\n    import os\n")
    with pytest.raises(ReadError, match=r"os\.system"):
        functions("def f(x):\n    return os.system(x)\n")


@pytest.mark.slow
def test_the_command_shows_terms_and_what_they_do():
    """Soulie instead of Mikami: two coefficients of B, one of C, the own rupture; Ce* falls, so that fewer stick."""
    done = run("diff", "granulation", "granulation", "--set", "bridge.law=soulie")
    assert done.exit_code == 0, done.output
    assert "3 equations differ" in done.output
    changed = re.findall(r"changed  (.*)\n +to   (.*)", done.output)
    assert ("0.0042*log_volume", "0.0018*log_volume") in changed
    assert ("-0.019*log_volume", "-0.0082*log_volume") in changed
    assert len(changed) == 4
    moved = re.findall(r"([\w-]+) -> ([\w-]+) \d+", done.output)
    assert ("stick", "stick-rotate-separate") in moved
    assert "stick" not in [after for _, after in moved]


@pytest.mark.slow
def test_folders_of_other_versions_are_compared(tmp_path: Path):
    """Two folders that `generate` made, one of them by other equations: the term is shown, nothing is computed."""
    for name in ("old", "new"):
        shutil.copytree(GENERATED, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__"))
    law = tmp_path / "new" / "laws" / "shear_film.py"
    law.write_text(law.read_text().replace("-log(gap)", "-log(gap) + aspect"))
    done = run("diff", str(tmp_path / "old"), str(tmp_path / "new"))
    assert done.exit_code == 0, done.output
    assert "1 equation differs" in done.output
    assert re.search(r"laws/shear_film: log_factor\n +added +aspect", done.output)


@pytest.mark.slow
def test_equations_are_exported(tmp_path: Path):
    """Every formula of the document parses as mathtext; strings appear where the scene has them and only there."""
    for scene in ("granulation", "pendulum"):
        assert run("export", scene, "--to", "latex", "--out", str(tmp_path)).exit_code == 0
        page = (tmp_path / f"{scene}.tex").read_text()
        formulas = re.findall(r"^  (\S.*?) &([=<]) (.*?)(?: &&.*| \\\\)?$", page, re.MULTILINE)
        assert len(formulas) > 15
        for formula in formulas:
            MathTextParser("path").parse(f"${' '.join(formula)}$")
        assert ("F_{S,n}" in page) == (scene == "pendulum")
        assert ("F_c" in page) == (scene == "granulation")
        assert r"\end{document}" in page


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
def test_exported_c_is_the_model(tmp_path: Path):
    """The C of the right-hand side, compiled by itself, gives what CasADi gives, in every region."""
    scene = Scene.load("granulation")
    for name, text in c_texts(scene).items():
        (tmp_path / name).write_text(text)
    state = [0.4, -0.3, 17.0, 0.02]
    suffixes = {"": (1, 1), "_beyond_film": (0, 1), "_beyond_shear": (1, 0), "_beyond_both": (0, 0)}
    calls = "".join(
        f'granulation_right_hand_side{suffix}(arg, res, iw, w, 0); for (k = 0; k < 4; ++k) printf("%.17g ", f[k]);\n'
        for suffix in suffixes
    )
    (tmp_path / "main.c").write_text(
        '#include <stdio.h>\n#include "granulation.h"\n'
        "int main(void) { int k; double f[4], w[999]; long long int iw[99];\n"
        f"double y[4] = {{{', '.join(map(repr, state))}}};\n"
        f"const double *arg[9] = {{y, granulation_groups}}; double *res[9] = {{f}};\n{calls} return 0; }}\n"
    )
    program = tmp_path / "program"
    subprocess.run(
        ["cc", "-Wall", "-Werror", "-o", program, tmp_path / "main.c", tmp_path / "granulation.c", "-lm"], check=True
    )
    found = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    model = load(select_model(scene, oblique=True, full=True))
    groups = model.group_values(nondimensionalise(scene, scene.need_impact()[0], scene.need_impact()[1]).groups)
    expected = [
        value
        for film, shear in suffixes.values()
        for value in model.values("right_hand_side", np.array(state), groups, film, shear).values()
    ]
    np.testing.assert_allclose([float(word) for word in found], expected, rtol=1e-13)


@pytest.mark.skipif("gcc" not in FOUND, reason="needs gcc and g++")
@pytest.mark.slow
def test_the_law_of_a_model_with_declared_events_does_as_its_kernel(tmp_path: Path):
    """Head-on and oblique kernels in one file of plain doubles, without a warning; outcomes and proofs are the same."""
    snap = 'event("snap", guard=limit - u/x, where="opening beyond the film", ends="separated")\n'
    limit = 'limit = quantity("limit", unit="1/s", default="1e4 1/s")\n'
    (tmp_path / "snap.py").write_text("from wetdoublet.derive.user import *\n" + limit + snap)
    scene = Scene.load("granulation", model=tmp_path / "snap.py")
    law = Law(scene, law_alone(scene, tmp_path), *STRICT, "-DGRANULATION_LANES=1")
    stokes, angles = np.array([0.02, 0.08, 0.2, 0.05, 0.3]), np.radians([60, 60, 60, 0, 0])
    found = law.collide(law.impacts(speed=scene.speed_of(1.0) * stokes, angle=angles))
    expected = collide_many(scene, stokes=stokes, angle=angles, of=("outcome", "restitution", "certified"))
    assert collide(scene, stokes=stokes[1], angle=angles[1], ledger=False).events[-1].kind == "snap"
    for name in ("outcome", "certified"):
        np.testing.assert_array_equal(found[name], expected[name])
    assert found["certified"].any()
    np.testing.assert_allclose(found["restitution"], expected["restitution"], rtol=1e-9, atol=0)
