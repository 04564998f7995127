"""Settings, and shared data: the public reference collisions and boundaries, copied into the repository."""

import compileall
import gc
import os
import re
import signal
from collections import Counter
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
import wetdoublet
from hypothesis import HealthCheck, settings
from wetdoublet.solvers.engines.interval.build import engine
from wetdoublet.solvers.engines.taylor.build import kernel

from .helpers.data import BOUNDARIES, COLLISIONS
from .helpers.flags import OPTIMIZED, QUICK

# Some hundred kernels are compiled so. What users get is compiled by `test_kernel.py`.
os.environ.setdefault("WETDOUBLET_CFLAGS", QUICK)

# a shell starts what runs in the background with Ctrl-C ignored, and processes inherit that
signal.signal(signal.SIGINT, signal.default_int_handler)

# What is imported is hardly ever garbage, and looking for it takes a fifth of the time that collecting takes.
gc.disable()

# no test depends on how fast the machine is
settings.register_profile("unhurried", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("unhurried")

_SLOW = re.compile(r"^pytestmark = .*\bmark\.slow\b", re.MULTILINE)
_SOME_SLOW = re.compile(r"\bmark\.slow\b|^from \.scenes import .*\bparts\b", re.MULTILINE)  # `parts` has marks
_LONGEST = (
    "harness/test_mutants.py", "test_recipes.py", "explorer/test_bundle.py", "explorer/test_in_browser.py",
    "explorer/test_numbers_of_page.py", "checks/test_mutants.py", "verify/test_paper.py", "fitting/test_fit.py",
)  # fmt: skip
_IMPORTED = ("hypothesis", "pandas", "pint", "scipy.optimize", "sympy.physics.units", "xarray", "matplotlib.figure")


def pytest_configure(config: pytest.Config) -> None:
    """Compile to bytecode, before the workers start, what each of them would compile for itself at the same time."""
    if config.getoption("numprocesses", None) and not hasattr(config, "workerinput"):
        for folder in ("derive", "solvers"):
            compileall.compile_dir(Path(wetdoublet.__file__).parent / folder, quiet=2, workers=0)
        for name in _IMPORTED:
            import_module(name)


def pytest_collection_finish() -> None:
    """Leave what was imported alone when garbage is collected: expressions of sympy are many and small."""
    gc.freeze()
    gc.set_threshold(50_000, 50, 50)
    gc.enable()


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out files of which no test is asked for, as all are slow or none is: they need not even be imported."""
    asked = config.option.markexpr
    if asked not in ("slow", "not slow") or collection_path.suffix != ".py":
        return None
    text = collection_path.read_text(encoding="utf-8")
    left_out = _SLOW.search(text) if asked == "not slow" else not _SOME_SLOW.search(text)
    return bool(left_out) or None


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The files that take longest come first, then those with most tests, lest one processor waits at the end."""
    sizes = Counter(item.path for item in items)
    items.sort(key=lambda item: (not str(item.path).endswith(_LONGEST), -sizes[item.path]))


def _quick(config: pytest.Config) -> bool:
    """Whether slow tests are left out, or a mutant's first example that fails is enough."""
    return bool(config.option.markexpr == "not slow") or "WETDOUBLET_MUTANT" in os.environ


def _name(case: dict[str, Any]) -> str:
    return f"{case['name']} St {case['impact']['stokes']} {case['impact']['angle']}"


@pytest.fixture(params=COLLISIONS, ids=_name)
def reference(request: pytest.FixtureRequest) -> dict[str, Any]:
    """One reference collision: scene, impact, results, error estimate, conditioning."""
    case: dict[str, Any] = request.param
    return case


@pytest.fixture(scope="session")
def reference_boundaries() -> dict[str, Any]:
    """Changes of outcome of the presets at four angles."""
    return BOUNDARIES


@pytest.fixture(scope="module")
def optimized(pytestconfig: pytest.Config) -> Iterator[None]:
    """Kernels of this module are optimized, for its slow tests; quick ones share those that others compile."""
    yield from _compiled(OPTIMIZED, pytestconfig)


@pytest.fixture(scope="module")
def released(pytestconfig: pytest.Config) -> Iterator[None]:
    """What this module compiles for its slow tests is compiled as users do: enclosures are then ten times as fast."""
    yield from _compiled("", pytestconfig)


def _compiled(flags: str, config: pytest.Config) -> Iterator[None]:
    if _quick(config):
        yield
        return
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("WETDOUBLET_CFLAGS", flags)
        for known in (kernel, engine):
            known.cache_clear()
        yield
    for known in (kernel, engine):
        known.cache_clear()
