"""Writes the symbolic verdicts that come with the package into `proved.json`.

    python -m wetdoublet.solvers.verify.build

To be run after a change of the derivation; a test says when.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from ..scene.scene import Scene
from ..scene.scenefile import PRESETS
from .verdicts import PROVED, laws_of, of_here, proofs_of, proved

if TYPE_CHECKING:
    from ...derive.checks.symbolic import Proof


def needed() -> dict[str, Proof]:
    """The proofs of all laws of the library, and of the choices of the presets, by their digests."""
    choices = ({}, *(laws_of(Scene.load(name)) for name in PRESETS))
    return {proof.digest: proof for laws in choices for proof in proofs_of(laws)}


if __name__ == "__main__":
    rows = (f'"{name}": {json.dumps(proved(proof), ensure_ascii=False)}' for name, proof in needed().items())
    lines = ",\n".join(rows)
    PROVED.write_text(f'{{"of": {json.dumps(of_here())}, "verdicts": {{\n{lines}\n}}}}\n', encoding="utf-8")
