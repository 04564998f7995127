"""`verify`: all checks of a scene or of all presets."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ..host.arguments import check_flag
from ..scene.scene import Scene
from ..scene.scenefile import OF_THE_PAPER
from .identities import symbolic
from .laws import numeric
from .region import grid
from .report import Finding, Report


def verify(
    scene: Scene | str | None = None, progress: Callable[[Finding], None] | None = None, recompute: bool = False
) -> Report:
    """Check the laws symbolically, and the collisions of a scene numerically.

    Arguments:
        scene: a Scene, a file or a preset's name; None for all presets and their head-on variants.
        progress: called with each finding as it is made.
        recompute: make the symbolic verdicts again, though an earlier run on the same equations has kept them.

    Returns:
        The Report; `report.ok` is True if all checks passed.
    """
    loaded = None if scene is None else Scene.load(scene)
    findings: list[Finding] = []

    def take(found: Iterator[Finding]) -> None:
        for finding in found:
            findings.append(finding)
            if progress:
                progress(finding)

    take(symbolic(loaded, check_flag(recompute, "recompute")))
    budget = None if loaded is None else grid(loaded)
    take(_presets() if loaded is None else numeric(loaded, budget=budget))
    return Report(tuple(findings), budget)


def _presets() -> Iterator[Finding]:
    for name in OF_THE_PAPER:
        preset = Scene.load(name)
        yield from numeric(preset)
        yield from numeric(preset, head_on=True)
