"""What every JSON object says of where its numbers come from."""

from typing import Any

from .scene import Scene


def origin(scene: Scene) -> dict[str, Any]:
    """`version` of the toolkit, `scene`, its entries by dotted name in SI units and radians, and `held` if it says so.

    A bridge volume that is no V/R^3 is text with its unit, so that the entries make the same scene again.
    """
    from importlib.metadata import version

    entries = {name: scene.as_given(name, value) for name, value in scene.si}
    return {"version": version("wetdoublet"), "scene": entries} | ({"held": scene.held} if scene.held else {})
