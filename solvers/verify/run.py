"""From scenes to a report."""

from __future__ import annotations

from collections.abc import Iterator

from ..scene import Scene
from ..scenefile import PRESETS
from .identities import symbolic
from .laws import numeric
from .region import grid
from .report import Finding, Report


def verify(scene: Scene | str | None = None) -> Report:
    """Check the laws, and the numbers of a scene.

    Arguments:
        scene: a Scene, a file or a preset's name; None for all presets and their head-on variants.

    Returns:
        The Report; `report.ok` tells whether all that is held to something holds.
    """
    if scene is None:
        return Report((*symbolic(), *_presets()))
    loaded = Scene.load(scene)
    budget = grid(loaded)
    return Report((*symbolic(loaded), *numeric(loaded, budget=budget)), budget)


def _presets() -> Iterator[Finding]:
    for name in PRESETS:
        preset = Scene.load(name)
        yield from numeric(preset)
        yield from numeric(preset, head_on=True)
