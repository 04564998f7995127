"""Boundaries as small tables for a notebook."""

from __future__ import annotations

import math

from ..collision.text import name_of
from ..formatting.notebook import view
from .found import Curves, Lines
from .plane import ANGLE


def html(found: Lines) -> str:
    """Changes of outcome line by line, or the curves of an atlas and where they meet."""
    name = name_of(found.scene) if found.scene is not None else "scene"
    if isinstance(found, Curves):
        return _atlas(found, name)
    rows = []
    for angle, line, failure in zip(found.angles, found.changes, _failures(found), strict=True):
        at = f"{math.degrees(angle):.6g}"
        rows += [
            (at, f"{one.stokes:.8g}", "-" if one.centrifugal is None else f"{one.centrifugal:.6g}",
             f"{found.speed_at(one.stokes, angle):.6g}", f"{one.before} → {one.after}", one.kind)
            for one in line
        ]  # fmt: skip
        rows += [] if line else [(at, failure or f"no change for {found.range_text}", "", "", "", "")]
    head = ("angle (deg)", "St", "Ce", found.speed_heading, "change", "kind")
    notes = [f"{found.collisions} collisions, {found.range_text}"]
    return view(f"{name}: boundaries between outcomes", rows, head, notes)


def _failures(found: Lines) -> tuple[str, ...]:
    return found.failures or ("",) * len(found.angles)


def _atlas(found: Curves, name: str) -> str:
    scale = math.degrees(1.0) if found.over == ANGLE else 1.0
    rows = [
        (f"{one.before} → {one.after}", one.kind,
         f"{scale * one.x[0]:.6g} ... {scale * one.x[-1]:.6g}", f"{one.stokes[0]:.6g} ... {one.stokes[-1]:.6g}")
        for one in found.curves
    ]  # fmt: skip
    rows += [("point", one.kind, f"{scale * one.x:.6g}", f"{one.stokes:.6g}") for one in found.points]
    x = "angle (deg)" if found.over == ANGLE else found.over
    notes = [f"not settled at {scale * at:.6g}, St {stokes:.6g}: {why}" for at, stokes, why in found.unsettled]
    return view(f"{name}: atlas of boundaries", rows, ("curve", "kind", x, "St"), notes)
