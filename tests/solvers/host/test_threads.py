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
from wetdoublet.solvers.host.captured_stderr import captured_stderr
from wetdoublet.solvers.host.thread_caches import once, own_cache
from wetdoublet.solvers.model.model import Model, load, select_model

SCRIPT = Path(__file__).parents[2] / "helpers" / "threads.py"


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


@pytest.mark.slow
def test_public_functions_from_several_threads():
    """In a cold process, four threads round the public functions give what one thread gives, to the last bit, and print
    nothing; a crash would be told with every thread's place.
    """
    command = [sys.executable, "-X", "faulthandler", str(SCRIPT), "4"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, ""), done.stdout + done.stderr


_IMPORTS = """
import sys
from pathlib import Path
from types import SimpleNamespace
from wetdoublet.solvers import Scene
from wetdoublet.solvers.host.emitted import DERIVING
from wetdoublet.solvers.verify.identities import of_the_model
from wetdoublet.solvers.verify.verdicts import findings

class Unlocked:
    def find_spec(self, name, path=None, target=None):
        if name.startswith("wetdoublet.derive") and not DERIVING._is_owned():
            print(name)

sys.meta_path.insert(0, Unlocked())
path = Path(sys.argv[1])
mine = SimpleNamespace(name="mine", source=path.read_text())
"""


@pytest.mark.parametrize(
    "asked",
    [
        "Scene.load('granulation', model=path)",
        pytest.param("next(findings({}))", marks=pytest.mark.slow),
        pytest.param("next(of_the_model(mine))", marks=pytest.mark.slow),
    ],
)
def test_the_derivation_is_imported_by_one_thread_at_a_time(asked: str, tmp_path: Path):
    """Two that import its modules from different sides may each find one of the other's half made: an ImportError."""
    (tmp_path / "mine.py").write_text(
        "from wetdoublet.derive.user import *\nlaw('bridge', 'mine', force=2*pi*a*sigma)\n"
    )
    command = [sys.executable, "-c", _IMPORTS + asked, str(tmp_path / "mine.py")]
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

    models = together(3, go)
    assert len({id(model) for model, _ in models}) == 3
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
