"""Writes the modules that come with the package into `built`: of the presets, and of choices on the template.

    python -m wetdoublet.solvers.explorer.build

To be run with ziglang whenever the text of a law changes; a test names the modules that are missing or left over.
"""

import gzip
from collections.abc import Iterator

from ..host.compiler import webassembly
from ..host.user_cache import digest_of
from ..scene.scene import Scene
from ..scene.scenefile import PRESETS, template
from .module import BUILT, SUFFIX, compilation
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
    dry = (entry for entry in own.given if not entry[0].startswith("bridge."))
    yield Scene("", tuple(dry))


def compilations() -> dict[str, tuple[str, tuple[str, ...]]]:
    """Text and flags of every module, by their digest."""
    wanted = (compilation(*law_of(scene)[:2]) for scene in scenes())
    return {digest_of("\0".join([text, *flags]).encode()): (text, flags) for text, flags in wanted}


if __name__ == "__main__":
    missing = compilations()
    for path in BUILT.glob(f"*{SUFFIX}"):
        if missing.pop(path.name.partition(".")[0], None) is None:
            path.unlink()
    for digest, (text, flags) in missing.items():
        packed = gzip.compress(webassembly(text, flags), 9, mtime=0)
        (BUILT / f"{digest}.{digest_of(packed)}{SUFFIX}").write_bytes(packed)
