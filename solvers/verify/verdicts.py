"""Symbolic verdicts one by one: those that come with the package, those of earlier runs, and those yet to be proved.

A verdict is kept under a digest of all that its proof uses: the sources of the derivation that its module imports,
itself or by others, the laws that it is asked about, and sympy. So it is never taken for another expression, and
a change elsewhere leaves it valid. `build` writes those that come with the package.
"""

from __future__ import annotations

import ast
import hashlib
import json
import os
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from ..host import user_cache
from ..host.emitted import DERIVE, DERIVING
from ..model.model import select_model
from ..scene.scene import Scene
from .report import Finding

if TYPE_CHECKING:
    from ...derive.checks.symbolic import Proof

PROVED = Path(__file__).with_name("proved.json")
Row = tuple[str, str, str, bool | None]  # name, statement, figure, success
_FOUND = ("import_module", "iter_modules")  # what a file has that imports all files beside it


def laws_of(scene: Scene | None) -> dict[str, str]:
    """The laws of a scene by slot, with which its proofs are made; none for all of the library's."""
    return dict(select_model(scene, oblique=True, full=True).laws) if scene is not None else {}


def findings(laws: Mapping[str, str], recompute: bool = False) -> Iterator[Finding]:
    """The findings of all proofs one by one, each locked against derivations in other threads.

    Arguments:
        laws: of the scene; see `laws_of`.
        recompute: prove them all here.
    """
    remaining = proofs_of(laws)
    while True:
        with DERIVING:
            if (proof := next(remaining, None)) is None:
                return
            of_package = None if recompute else shipped().get(name := key(proof))
            of_cache = None if recompute or of_package else user_cache.lookup(f"verdict-{name}.json")
            rows = of_package or (json.loads(of_cache) if of_cache else proved(proof))
        if not (recompute or of_package or of_cache):
            user_cache.fetch(f"verdict-{name}.json", json.dumps(rows).encode)
        for title, statement, figure, ok in rows:
            yield Finding(
                "Symbolic", title, statement, figure, "", ok, kept=bool(of_cache), shipped=of_package is not None
            )


def proofs_of(laws: Mapping[str, str]) -> Iterator[Proof]:
    """The proofs for laws by slot, all of the library's in a slot that is left out (imports sympy)."""
    from ...derive.checks.symbolic import proofs
    from ...derive.laws import LAWS

    return proofs({slot: LAWS[slot][name] for slot, name in laws.items() if name in LAWS[slot]})


def proved(proof: Proof) -> list[Row]:
    """The verdicts of a proof, made here."""
    return [(check.name, check.statement, check.figure, check.ok) for check in proof.checks()]


@cache
def shipped() -> dict[str, list[Row]]:
    """The verdicts that come with the package, by their keys."""
    content: dict[str, list[Row]] = json.loads(PROVED.read_bytes()) if PROVED.is_file() else {}
    return content


def key(proof: Proof) -> str:
    """Digest of all that a proof uses."""
    module = proof.function.__module__.rpartition(".derive.")[2]
    settings = {name: value for name, value in os.environ.items() if name.startswith("SYMPY_")}
    used = json.dumps([proof.digest, _digest_of_sources(module), settings], sort_keys=True)
    return hashlib.sha256(used.encode()).hexdigest()[:32]


@cache
def _digest_of_sources(module: str) -> str:
    files, outside = sources(DERIVE.joinpath(*module.split(".")).with_suffix(".py"))
    digest = hashlib.sha256(json.dumps({name: version(name) for name in sorted(outside)}).encode())
    for file in sorted(files):
        digest.update(file.relative_to(DERIVE).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


def sources(file: Path) -> tuple[set[Path], set[str]]:
    """A file of the derivation with all that it imports, itself or by others, and the packages outside of it."""
    files, outside, todo = set[Path](), set[str](), [file]
    while todo:
        if (new := todo.pop()) not in files:
            files.add(new)
            inside, packages = _imports(new)
            todo += inside
            outside |= packages
    return files, outside


@cache
def _imports(file: Path) -> tuple[set[Path], set[str]]:
    """What a file imports anywhere in its text: files of the derivation, and packages that are not Python's own."""
    text = file.read_text(encoding="utf-8")
    beside = {*file.parent.glob("*.py"), *file.parent.glob("*/__init__.py")}
    files = beside if any(word in text for word in _FOUND) else set[Path]()
    files |= {folder / "__init__.py" for folder in file.parents if folder.is_relative_to(DERIVE)}
    outside = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            outside |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            name = node.module or ""
            if not node.level and not name.startswith("wetdoublet.derive"):
                outside.add(name.partition(".")[0])
                continue
            base = file.parents[node.level - 1] if node.level else DERIVE
            place = base.joinpath(*name.removeprefix("wetdoublet.derive").strip(".").split("."))
            for target in (place, *(place / alias.name for alias in node.names)):
                files |= {path for path in (target.with_suffix(".py"), target / "__init__.py") if path.is_file()}
    return files, outside - {*sys.stdlib_module_names}
