"""Names that mean something to an engine: the kernel and the exported law compile, and the engines agree."""

import math
import shutil
import subprocess
from pathlib import Path

import pytest
from wetdoublet.derive.user.names import EMITTED, taken
from wetdoublet.derive.vocabulary.quantities import VOCABULARY
from wetdoublet.solvers import Scene, collide

from ...helpers.command import run

pytestmark = pytest.mark.slow
WORDS = sorted(word for word in taken() if word.islower() and word not in VOCABULARY and "_" not in word)[::8]
SHORT = ["c", "of", "s", "v", "vec", "y"]  # arguments of the functions in C
ALL = '''"""Parts and quantities that bear every word that means something."""
from wetdoublet.derive.user import *

parts = [let(word, h * (k + 1)) for k, word in enumerate({words})]
own = [quantity(word, unit="m", default="1 um") for word in {names}]
law("bridge", "all", force=2*cos(phi)*exp(-sum(parts)/1e6 - sum(own)/R/1e3))
'''


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs a C compiler")
def test_every_word_compiles(tmp_path: Path):
    """Kernel and exported law of a model that bears all words; the kernel agrees with CVODES, which has no C."""
    path = tmp_path / "words.py"
    names = [word for word in SHORT if taken()[word] == EMITTED]
    path.write_text(ALL.format(words=sorted({*WORDS, *SHORT, "gap_over_radius"} - {*names}), names=names))
    scene = Scene.load("granulation", model=path).with_impact(stokes=0.06, angle=math.radians(60))
    found = collide(scene, engine="taylor", ledger=False)
    assert found.engine == "taylor"
    assert found.restitution == pytest.approx(collide(scene, engine="cvodes", ledger=False).restitution, rel=1e-7)
    done = run("export", "granulation", "--model", str(path), "--to", "c", "--out", str(tmp_path / "law"))
    assert done.exception is None, done.exception
    for language in ("c", "c++"):
        command = ["gcc", "-fsyntax-only", "-x", language, str(tmp_path / "law" / "granulation.c")]
        assert subprocess.run(command, capture_output=True, text=True, check=False).stderr == ""
