"""Symbolic identities of the derivation, as findings; computed again only if something they depend on has changed.

Those of a scene are kept in the user's cache as a whole, which needs no sympy; otherwise they are those of the package
or are proved (`verdicts`). The name of an entry is a digest of everything they depend on: the derivation's sources,
the versions of sympy, Python and the libraries below, and the selected laws. The cache verifies an entry's content, so
a damaged one is computed again.
"""

import hashlib
import json
import os
import platform
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, fields, replace
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from ..host import user_cache
from ..host.emitted import DERIVING, derivation
from ..scene.scene import Scene
from ..scene.user_model import Package
from .report import Finding
from .verdicts import findings, laws_of

_BENEATH = ("mpmath", "gmpy2", "python-flint")  # what sympy computes with, as far as it is installed


def symbolic(scene: Scene | None = None, recompute: bool = False) -> Iterator[Finding]:
    """Findings of `derive.checks` for the laws of `scene`, or for all laws of the library.

    sympy is imported only to compute them. The checks of a user's laws follow these and are always computed, because a
    model file may import modules that no digest covers.

    Arguments:
        recompute: compute them even if they are kept.
    """
    chosen = laws_of(scene)
    yield from kept_verdicts(symbolic_key(chosen), lambda: findings(chosen, recompute), recompute)
    if scene is not None and scene.package is not None:
        yield from of_the_model(scene.package)


def of_the_model(package: Package) -> Iterator[Finding]:
    """Findings of the checks of a user's model, from its model file."""
    with DERIVING:
        from ...derive.checks.user import model_checks

        _, checks = model_checks(Path(f"{package.name}.py"), package.source, package.name)
    for check in checks:
        yield Finding(f"Model: {package.name}", check.name, check.statement, check.figure, "", check.ok)


def symbolic_key(laws: Mapping[str, str]) -> str:
    """Digest of all that the symbolic verdicts on some laws depend on.

    Arguments:
        laws: slot -> name of the law that is asked about; all of the library's in a slot that is left out.
    """
    digested = {
        "derivation": derivation(),
        "python": platform.python_implementation() + platform.python_version(),
        "beneath": {name: _version(name) for name in _BENEATH},
        "settings": {name: value for name, value in os.environ.items() if name.startswith("SYMPY_")},
        "laws": dict(laws),
        "finding": [field.name for field in fields(Finding)],
        "judged by": hashlib.sha256(Path(__file__).read_bytes()).hexdigest(),
    }
    return hashlib.sha256(json.dumps(digested, sort_keys=True).encode()).hexdigest()[:32]


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return ""


def kept_verdicts(key: str, compute: Callable[[], Iterable[Finding]], recompute: bool = False) -> Iterator[Finding]:
    """The findings of a key as an earlier run has kept them, or else one by one as they are computed, and then kept.

    Arguments:
        key: digest of everything that they depend on.
        recompute: compute them in any case.
    """
    name = f"verdicts-{key}.json"
    content = None if recompute else user_cache.lookup(name)
    if content is not None:
        yield from (replace(Finding(**{**row, "about": tuple(row["about"])}), kept=True) for row in json.loads(content))
        return
    results = []
    for finding in compute():
        results.append(finding)
        yield finding
    text = json.dumps([asdict(finding) for finding in results])
    user_cache.fetch(name, text.encode)
