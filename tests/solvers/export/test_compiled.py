"""The exported law called from Python by what its page shows; what jax and torch bring is asked for by name."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from wetdoublet.solvers import Scene, collide_many
from wetdoublet.solvers.export.extras import required

from ...helpers.exported_law import FOUND, written
from ...helpers.flags import QUICK

PAGE = Path(__file__).resolve().parents[3] / "docs/how-to/c-law.md"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The granulation's law, made as the page says."""
    above = tmp_path_factory.mktemp("from-python")
    written(Scene.load("granulation"), above / "law")
    flags = f"CFLAGS={QUICK} -DGRANULATION_LANES=1"
    subprocess.run(["make", "-s", "-C", "law", "shared", flags], cwd=above, check=True)
    return above


@pytest.mark.slow
@pytest.mark.skipif(not FOUND, reason="no C compiler")
def test_the_page_calls_the_law(folder: Path) -> None:
    """By ctypes, on numpy's arrays: as `collide_many` has it."""
    section = PAGE.read_text(encoding="utf-8").partition("## From Python\n")[2].partition("\n## ")[0]
    [text] = re.findall(r"^```python\n(.*?)^```", section, re.DOTALL | re.MULTILINE)
    program = f"{text}\nprint(*found['restitution'])"
    done = subprocess.run([sys.executable, "-c", program], cwd=folder, capture_output=True, text=True, check=True)
    expected = collide_many("granulation", speed=3.0, angle=[0.2, 0.6, 1.0]).restitution.values
    assert [*map(float, done.stdout.split())] == pytest.approx(expected, rel=1e-7)


def test_a_missing_extra_is_named_with_its_commands() -> None:
    """Both that of an installation and that of a clone."""
    with pytest.raises(ImportError, match=r"pip install 'wetdoublet\[jax\]'.*pip install -e '\.\[jax\]'"):
        required("a_module_that_nobody_has", "jax")
