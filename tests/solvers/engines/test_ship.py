"""Every question on every preset asks for a kernel that comes with the package."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from wetdoublet.solvers.engines import ship
from wetdoublet.solvers.scene.scenefile import PRESETS

ASKED = """
import itertools
import pathlib, sys

sys.modules["ziglang"] = None  # as if not installed
import numpy as np
import wetdoublet as wd
from wetdoublet.solvers.engines import ship
from wetdoublet.solvers.engines.taylor import build


class Asked(Exception):
    pass


def asked(variant):
    assert variant in there, variant
    raise Asked


there = set(ship.variants())
build.is_shipped, build.shipped = there.__contains__, asked
folder = pathlib.Path(sys.argv[1])
rows = ["speed [m/s],angle [deg],outcome,restitution,restitution_sd", "0.6,0,bounce,0.2,0.02", ""]
(folder / "impacts.csv").write_text(chr(10).join(rows))


def questions(scene, stokes, angle):
    yield lambda: wd.collide(scene, angle=angle)
    yield lambda: wd.collide(scene, angle=angle, ledger=False)
    yield lambda: wd.collide(scene, angle=angle, trajectory=True)
    yield lambda: wd.collide_many(scene, stokes=stokes, angle=angle)
    yield lambda: wd.collide_many(scene, stokes=stokes, angle=angle, of=("restitution", "rotation"))
    yield lambda: wd.regime_map(scene, stokes=stokes, angle=[angle])
    yield lambda: wd.boundary(scene, angle=[angle])
    yield lambda: wd.sensitivities(scene, of="restitution", angle=angle)
    yield lambda: wd.sensitivities(scene, of=("restitution", "contact_time"), angle=angle)
    yield lambda: wd.gradients_many(scene, stokes=stokes, angle=angle)
    yield lambda: wd.gradients_many(scene, stokes=stokes[:3], angle=angle, wrt=("liquid.viscosity",))
    yield lambda: wd.band(scene, {"liquid.viscosity": "5 %"}, "impact.stokes", stokes[:3], samples=16)
    yield lambda: wd.fit(scene, folder / "impacts.csv", free=["liquid.viscosity"])


for preset, angle in itertools.product(sys.argv[2:], (0.0, 0.5)):
    scene = wd.Scene.load(preset)
    stokes = (scene.stokes or 1.0) * np.linspace(0.5, 2.0, 101)
    for number, ask in enumerate(questions(scene, stokes, angle)):
        try:
            engine = ask().engine  # "taylor" where a stick needs no kernel
        except Asked:
            continue
        except AttributeError:
            engine = "another engine"
        if engine != "taylor":
            print(f"{preset}, question {number} at {angle} rad: {engine} answered")
"""


def test_the_list_is_what_the_questions_ask_for() -> None:
    """The committed list of kernels, from which the package is built without CasADi, is that of today's questions."""
    assert ship.variants() == ship.needed_by_questions()


@pytest.mark.slow
def test_without_a_compiler_no_question_goes_to_another_engine(tmp_path: Path) -> None:
    """Of any preset with default tolerances; gradients taken back and fits among them."""
    env = {name: value for name, value in os.environ.items() if name not in ("CC", "WETDOUBLET_CFLAGS")}
    env |= {"PATH": str(tmp_path), "WETDOUBLET_CACHE": str(tmp_path / "cache")}
    command = [sys.executable, "-W", "ignore", "-c", ASKED, str(tmp_path), *PRESETS]
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, ""), done.stdout + done.stderr
