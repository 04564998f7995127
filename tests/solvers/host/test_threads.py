"""Any number of threads: the same numbers as one, nothing built twice, nothing shared that may not be."""

import contextlib
import io
import os
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from casadi import SX
from wetdoublet.solvers import Scene
from wetdoublet.solvers.host.casadi_calls import captured_stderr
from wetdoublet.solvers.host.thread_caches import once, own_cache
from wetdoublet.solvers.model.model import Model, load, select_model


def together(count: int, go: Callable[[], Any]) -> list[Any]:
    """What `go` gives in so many threads that start at one time."""
    ready, found = threading.Barrier(count), []

    def run() -> None:
        ready.wait()
        found.append(go())

    threads = [threading.Thread(target=run) for _ in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == count
    return found


_CALLS = """
import sys
import threading
import wetdoublet as wd
from wetdoublet.solvers.scene.scenefile import PRESETS

IMPACT = {"stokes": 0.05, "angle": "60 deg"}
MANY = {"stokes": [0.02, 0.05, 0.1, 0.3] * 40, "angle": 0.9}
CALLS = {
    "cvodes": lambda: wd.collide("granulation", engine="cvodes", **IMPACT).to_dict(),
    "rosenbrock": lambda: wd.collide("granulation", engine="rosenbrock", **IMPACT).to_dict(),
    "taylor": lambda: wd.collide("granulation", trajectory=True, **IMPACT).trajectory.to_dict(),
    "strings": lambda: wd.collide("pendulum", stokes=1.3, angle="45 deg").to_dict(),
    "a picture": lambda: len(wd.collide("granulation", trajectory=True, **IMPACT).plot().axes),
    "scenes": lambda: [wd.Scene.load(name).with_entries({"liquid.viscosity": "3 Pa s"}).to_toml() for name in PRESETS],
    "few": lambda: wd.collide_many("granulation", engine="rosenbrock", stokes=[0.02, 0.1], angle=0.9).to_dict(),
    "many": lambda: wd.collide_many("granulation", of=("rotation", "contact_time"), **MANY).to_dict(),
    "a map": lambda: wd.regime_map("granulation", stokes=[0.02, 0.05, 0.3], angle=[0.2, 0.9]).to_dict(),
    "boundary": lambda: wd.boundary("granulation", angle=[0.6, 0.9], rtol=1e-8).to_dict(),
    "sensitivities": lambda: wd.sensitivities("granulation", engine="rosenbrock", **IMPACT).to_dict(),
    "gradients": lambda: wd.gradients_many("granulation", wrt="liquid.viscosity", **MANY).to_dict(),
}
names, found, ready = list(CALLS), {}, threading.Barrier(4)

def go(own):
    ready.wait()
    for name in names[3 * own : 3 * own + 3]:
        found[name] = repr(CALLS[name]())

threads = [threading.Thread(target=go, args=(own,)) for own in range(4)]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
sys.exit(", ".join(name for name in names if found.get(name) != repr(CALLS[name]())) or 0)
"""


@pytest.mark.slow
def test_public_functions_from_several_threads():
    """In a cold process, four threads share the public functions and give what one thread gives, to the last bit, and
    print nothing; a crash would be told with every thread's place.
    """
    command = [sys.executable, "-X", "faulthandler", "-W", "ignore", "-c", _CALLS]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, ""), done.stdout + done.stderr


_IMPORTS = """
import sys
from pathlib import Path
from wetdoublet.solvers import Scene
from wetdoublet.solvers.host.emitted import DERIVING
from wetdoublet.solvers.verify.verdicts import findings

class Unlocked:
    def find_spec(self, name, path=None, target=None):
        if name.startswith("wetdoublet.derive") and not DERIVING._is_owned():
            print(name)

sys.meta_path.insert(0, Unlocked())
Scene.load("granulation", model=Path(sys.argv[1]))
next(findings({}))
"""


@pytest.mark.slow
def test_the_derivation_is_imported_by_one_thread_at_a_time(tmp_path: Path):
    """Two that import its modules from different sides may each find one of the other's half made: an ImportError."""
    (tmp_path / "mine.py").write_text(
        "from wetdoublet.derive.user import *\nlaw('bridge', 'mine', force=2*pi*a*sigma)\n"
    )
    command = [sys.executable, "-c", _IMPORTS, str(tmp_path / "mine.py")]
    environment = os.environ | {"WETDOUBLET_CACHE": str(tmp_path / "cache")}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_a_model_is_a_threads_own():
    """Threads that live together have different symbols and functions of one model, and each always the same."""
    choice, leave = select_model(Scene.load("granulation"), oblique=True), threading.Barrier(3)

    def go() -> tuple[Model, SX]:
        found = load(choice), load(choice).column
        leave.wait()
        return found

    first = load(choice)
    models = together(3, go)
    assert len({id(first), *(id(model) for model, _ in models)}) == 4
    assert all(model.column is column for model, column in models)


def test_an_ended_threads_cache_goes_to_the_next():
    """One thread after another builds once: what the first had is handed on."""
    built: list[int] = []

    @own_cache(8)
    def cell(number: int) -> object:
        built.append(number)
        return object()

    first, second = (together(1, lambda: cell(1))[0] for _ in range(2))
    assert first is second
    assert built == [1]
    assert cell(1) is not first


def test_what_is_built_once_is_built_by_one_thread():
    """Eight threads that ask at one time get one object; another argument has its own; an error is tried again."""
    built: list[str] = []

    @once
    def heavy(name: str) -> object:
        built.append(name)
        if name == "bad" and built.count("bad") == 1:
            raise ValueError(name)
        return object()

    assert len({id(found) for found in together(8, lambda: heavy("one"))}) == 1
    assert heavy("two") is not heavy("one")
    assert built == ["one", "two"]
    with pytest.raises(ValueError, match="bad"):
        heavy("bad")
    assert heavy("bad") is heavy("bad")


def test_a_thread_hears_only_itself():
    """While one thread listens, others print as ever; whoever stops first, `sys.stderr` is what it was."""
    shown = io.StringIO()
    inside, leave, heard = threading.Event(), threading.Event(), []

    def other() -> None:
        with captured_stderr() as mine:
            sys.stderr.write("other ")
            inside.set()
            leave.wait()
            sys.stderr.write("again")
        heard.append(mine.getvalue())

    with contextlib.redirect_stderr(shown):
        thread = threading.Thread(target=other)
        with captured_stderr() as mine:
            thread.start()
            inside.wait()
            sys.stderr.write("own")
        sys.stderr.write("shown")
        leave.set()
        thread.join()
        assert sys.stderr is shown
    assert (mine.getvalue(), heard, shown.getvalue()) == ("own", ["other again"], "shown")
