"""`verify`: all checks of a scene or of all presets; if one raises an error, the others still run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache

from ..errors import WetDoubletError
from ..host.arguments import check_flag
from ..scene.scene import Scene
from ..scene.scenefile import OF_THE_PAPER
from .audit import stick_audit
from .conserved import conserved
from .identities import symbolic
from .region import argument, beside_cvodes, grid
from .report import Finding, Report
from .sample import WHOLE, Extent, collisions


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
    check_flag(recompute, "recompute")
    findings: list[Finding] = []

    def take(results: Iterator[Finding]) -> None:
        for finding in results:
            findings.append(finding)
            if progress:
                progress(finding)

    take(symbolic(loaded, recompute))
    if loaded is None:
        for preset in map(Scene.load, OF_THE_PAPER):
            take(numeric(preset))
            take(numeric(preset, head_on=True))
    else:
        take(numeric(loaded))
    return Report(tuple(findings))


def numeric(scene: Scene, head_on: bool = False, extent: Extent = WHOLE) -> Iterator[Finding]:
    """Findings of all numerical checks of a scene, in the order of the report.

    Arguments:
        head_on: check the head-on variant, without rotation.
        extent: size of the samples.
    """
    group = f"Numeric: {scene.name or 'scene'}{', head-on' * head_on}"
    angles = (0.0,) if head_on else None
    sample = collisions(scene, angles, extent)
    checks: dict[str, Callable[[], Iterator[Finding]]] = {
        "conservation": lambda: conserved(sample),
        "stick certificate": lambda: stick_audit(scene, angles, extent.audited),
    }
    if not head_on:
        data = cache(lambda: grid(scene, extent))
        checks["cvodes, on the grid"] = lambda: beside_cvodes(data())
        checks["e_n > 1"] = lambda: argument(data())
    for name, check in checks.items():
        try:
            for finding in check():
                yield replace(finding, group=group)
        except WetDoubletError as failure:
            yield Finding(group, name, "the check is completed", f"not completed: {failure}", "", False)
