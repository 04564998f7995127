"""What every JSON object says of where its numbers come from."""

from __future__ import annotations

from typing import Any

from .scene import Scene


def origin(scene: Scene) -> dict[str, Any]:
    """`version` of the toolkit and `scene`, its entries by dotted name in SI units and radians."""
    from importlib.metadata import version

    return {"version": version("wetdoublet"), "scene": dict(scene.si)}
