"""Writes the symbolic verdicts that come with the package into `proved.json`.

    python -m wetdoublet.solvers.verify.build

To be run after a change of the derivation; it proves only what the file lacks, and a test names what is missing or left
over.
"""

import json

from ...derive.checks.symbolic import Proof
from ..scene.scene import Scene
from ..scene.scenefile import PRESETS
from .verdicts import PROVED, key, laws_of, proofs_of, proved, shipped


def needed() -> dict[str, Proof]:
    """The proofs of all laws of the library, and of the choices of the presets, by their keys."""
    choices = ({}, *(laws_of(Scene.load(name)) for name in PRESETS))
    return {key(proof): proof for laws in choices for proof in proofs_of(laws)}


if __name__ == "__main__":
    rows = {name: shipped().get(name) or proved(proof) for name, proof in needed().items()}
    lines = (f'"{name}": {json.dumps(row, ensure_ascii=False)}' for name, row in rows.items())
    PROVED.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
