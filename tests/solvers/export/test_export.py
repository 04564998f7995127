"""`export`: equations that read, C that computes the same."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from matplotlib.mathtext import MathTextParser
from wetdoublet.solvers import Scene
from wetdoublet.solvers.export import functions
from wetdoublet.solvers.export.functions import functions as exported
from wetdoublet.solvers.export.functions import texts as c_texts
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model

from ...helpers.command import run

GENERATED = Path(functions.__file__).parents[2] / "generated"


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


def test_exported_friction_takes_its_impulse() -> None:
    """The impulse that sticks, handed to the exported jump, reverses the slip times beta_0 and keeps L."""
    entries = {"particles.friction": 0.4, "particles.contact_tangential_restitution": 0.3}
    scene = Scene.load("granulation").with_entries(entries)
    model = load(select_model(scene, oblique=True, full=True))
    found = {function.name().removeprefix("own_"): function for function in exported(model, "own")}
    groups = model.group_values(nondimensionalise(scene, *scene.need_impact()).groups)
    before = np.array([0.05, -0.3, 17.0, -0.2])
    slip, sticking, *_ = found["dry_slip"](before, groups).full().ravel()
    after = found["rubbed"](before, groups, sticking).full().ravel()
    assert found["dry_slip"](after, groups).full()[0, 0] == pytest.approx(-0.3 * slip, rel=1e-12)
    assert after[2] + 6.4 * after[3] == pytest.approx(before[2] + 6.4 * before[3], rel=1e-13)
    assert found["friction_loss"](before, groups, sticking).full()[0, 0] > 0


def test_the_manifest_covers_every_module():
    """Every emitted module and header has its digest in the manifest, against which it is held when it is loaded."""
    listed = json.loads((GENERATED / "manifest.json").read_text())["files"]
    emitted = [path for kind in ("*.py", "*.h") for path in GENERATED.rglob(kind)]
    assert set(listed) == {path.relative_to(GENERATED).as_posix() for path in emitted}
