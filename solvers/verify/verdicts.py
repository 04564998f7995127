"""Symbolic verdicts: those that come with the package, and those yet to be proved.

A verdict is under the digest of what is asked; all are of one text of the derivation and of versions of what computes
them, and none is taken beside others. So it is never taken for another expression. `build` writes those that come with
the package.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..host.emitted import DERIVING, sources_of_derivation
from ..model.model import select_model
from ..scene.scene import Scene
from .report import Finding

if TYPE_CHECKING:
    from ...derive.checks.symbolic import Proof

PROVED = Path(__file__).with_name("proved.json")
Row = tuple[str, str, str, bool | None]  # name, statement, figure, success


def laws_of(scene: Scene | None) -> dict[str, str]:
    """The laws of a scene by slot, with which its proofs are made; none for all of the library's."""
    return dict(select_model(scene, oblique=True, full=True).laws) if scene is not None else {}


def findings(laws: Mapping[str, str], recompute: bool = False) -> Iterator[Finding]:
    """The findings of all proofs one by one, each locked against derivations in other threads.

    Arguments:
        laws: of the scene; see `laws_of`.
        recompute: prove them all here.
    """
    verdicts = {} if recompute else shipped()
    with DERIVING:
        remaining = proofs_of(laws)
    while True:
        with DERIVING:
            if (proof := next(remaining, None)) is None:
                return
            of_package = verdicts.get(proof.digest)
            rows = of_package or proved(proof)
        for title, statement, figure, ok in rows:
            yield Finding("Symbolic", title, statement, figure, "", ok, shipped=of_package is not None)


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
    """The verdicts that come with the package, by digests of proofs; none that was proved of or with anything else."""
    content: dict[str, Any] = json.loads(PROVED.read_bytes()) if PROVED.is_file() else {}
    usual = not any(name.startswith("SYMPY_") for name in os.environ)
    return content["verdicts"] if content and usual and content["of"] == of_here() else {}


def of_here() -> dict[str, str]:
    """What verdicts depend on: the text of the derivation, and versions of what computes them."""
    return {"derivation": sources_of_derivation()} | {name: version(name) for name in ("sympy", "casadi")}
