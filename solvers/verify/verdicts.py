"""Symbolic verdicts in the user's cache, computed again only if something they depend on has changed.

The name of an entry is a digest of everything they depend on: the derivation's sources, the versions of sympy, Python
and the libraries below, and the selected laws. The cache verifies an entry's content, so a damaged one is computed
again.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, fields, replace
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from ..host import user_cache
from ..host.emitted import derivation
from .report import Finding

_BENEATH = ("mpmath", "gmpy2", "python-flint")  # what sympy computes with, as far as it is installed


def symbolic_key(laws: Mapping[str, str]) -> str:
    """Digest of all that the symbolic verdicts on some laws depend on.

    Arguments:
        laws: slot -> name of the law that is asked about; all of the library's in a slot that is left out.
    """
    told = {
        "derivation": derivation(),
        "python": platform.python_implementation() + platform.python_version(),
        "beneath": {name: _version(name) for name in _BENEATH},
        "settings": {name: value for name, value in os.environ.items() if name.startswith("SYMPY_")},
        "laws": dict(laws),
        "finding": [field.name for field in fields(Finding)],
        "judged by": hashlib.sha256(Path(__file__).with_name("identities.py").read_bytes()).hexdigest(),
    }
    return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()[:32]


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return ""


def kept_verdicts(key: str, made: Callable[[], Iterable[Finding]], recompute: bool = False) -> Iterator[Finding]:
    """The findings of a key, as an earlier run has made them, or else one by one as they are made, and then kept.

    Arguments:
        key: digest of everything that they depend on.
        recompute: make them in any case.
    """
    name = f"verdicts-{key}.json"
    content = None if recompute else user_cache.found(name)
    if content is not None:
        yield from (replace(Finding(**{**one, "about": tuple(one["about"])}), kept=True) for one in json.loads(content))
        return
    findings = []
    for finding in made():
        findings.append(finding)
        yield finding
    text = json.dumps([asdict(finding) for finding in findings])
    user_cache.kept(name, text.encode)
