"""All numerical checks of a scene, in the order of the report; if one raises an error, the others still run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from ..errors import WetDoubletError
from ..scene.scene import Scene
from .audit import stick_audit
from .backward import backward
from .closed import closed_forms
from .conserved import conserved
from .order import convergence
from .region import argument, beside_cvodes, grid
from .report import Finding
from .sample import WHOLE, Extent, collisions
from .surface import surface_arm

if TYPE_CHECKING:
    import xarray


def numeric(
    scene: Scene, head_on: bool = False, budget: xarray.Dataset | None = None, extent: Extent = WHOLE
) -> Iterator[Finding]:
    """Findings of all numerical checks of a scene.

    Arguments:
        head_on: check the head-on variant, without rotation.
        budget: budget of the scene, if already computed.
        extent: size of the samples.
    """
    group = f"Numeric: {scene.name or 'scene'}{', head-on' * head_on}"
    sample = collisions(scene, (0.0,) if head_on else None, extent)
    laws: list[tuple[str, Callable[[], Iterator[Finding]]]] = [
        ("conservation", lambda: conserved(group, sample)),
        ("surface arm", lambda: surface_arm(group, sample)),
        ("forward-back", lambda: backward(group, sample)),
        ("closed forms", lambda: closed_forms(group, scene, head_on)),
        ("convergence", lambda: convergence(group, sample, extent.tolerances)),
        ("stick certificate", lambda: stick_audit(group, scene, (0.0,) if head_on else None, extent.audited)),
    ]
    if not head_on:
        laws.append(("e_n > 1", lambda: _grid(group, scene, grid(scene, extent) if budget is None else budget)))
    for name, law in laws:
        try:
            yield from law()
        except WetDoubletError as failure:
            yield Finding(group, name, "the check is completed", f"not completed: {failure}", "", False)


def _grid(group: str, scene: Scene, data: xarray.Dataset) -> Iterator[Finding]:
    yield from beside_cvodes(group, scene, data)
    yield from argument(group, scene, data)
