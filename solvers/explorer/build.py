"""Writes the modules that come with the package into `built`: of the presets, and of choices on the template.

    python -m wetdoublet.solvers.explorer.build

To be run with ziglang whenever the text of a law changes; a test names the modules that are missing or left over.
"""

import gzip
from collections.abc import Iterator

from ..engines.ship import pack
from ..host.compiler import webassembly
from ..scene.scene import Scene
from ..scene.scenefile import PRESETS, template
from .module import BUILT, FLAGS, SUFFIX, compilation
from .page_of_scene import law_of

_CHOICES: tuple[dict[str, str | float], ...] = (
    {"bridge.law": "willett"},
    {"bridge.law": "rabinovich"},
    {"partner.wall": "true", "partner.coating_thickness": "0 um"},
    {"particles.friction": 0.3},
    {"attraction.hamaker": "1e-19 J"},
)


def scenes() -> Iterator[Scene]:
    """Scenes of all laws whose modules are shipped: the presets, and a scene of one's own with one choice made."""
    yield from map(Scene.load, PRESETS)
    own = Scene.from_toml(template("template"))
    yield from (own.with_entries(choice) for choice in ({}, *_CHOICES))
    yield Scene("", tuple(entry for entry in own.given if not entry[0].startswith("bridge.")))


def texts() -> dict[str, str]:
    """The C of every module, by its digest."""
    return {digest: text for text, digest in (compilation(*law_of(scene)[:2]) for scene in scenes())}


if __name__ == "__main__":
    wanted = texts()
    pack(BUILT, SUFFIX, wanted, lambda digest: gzip.compress(webassembly(wanted[digest], FLAGS), 9, mtime=0))
