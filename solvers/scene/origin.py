"""JSON objects of results: declared keys, and where the numbers come from."""

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from operator import attrgetter
from typing import Any, ClassVar

import numpy as np

from .scene import Scene


@cache
def release() -> str:
    """The version of the toolkit."""
    from importlib.metadata import version

    return version("wetdoublet")


def provenance(scene: Scene | None = None, **more: Any) -> dict[str, Any]:
    """Attributes of a Dataset: the version of the toolkit, the scene as TOML, and more."""
    return {"version": release()} | ({"scene": scene.to_toml()} if scene is not None else {}) | more


def origin(scene: Scene) -> dict[str, Any]:
    """`version` of the toolkit, `scene`, its entries by dotted name in SI units and radians, and `held` if it says so.

    A bridge volume that is no V/R^3 is text with its unit, so that the entries make the same scene again.
    """
    entries = {name: scene.as_given(name, value) for name, value in scene.si}
    return {"version": release(), "scene": entries} | ({"held": scene.held} if scene.held else {})


class Recorded:
    """A result whose JSON object is declared: keys in order, `key` or `key=attribute`; its scene's origin follows."""

    _keys: ClassVar[str]

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of the command: SI units and radians, null where there is no value."""
        pairs = [item.partition("=") for item in self._keys.split()]
        scene = getattr(self, "scene", None)
        provenance = origin(scene) if isinstance(scene, Scene) else {}
        return {key: plain(attrgetter(name or key)(self)) for key, _, name in pairs} | provenance


def plain(value: Any, gaps: bool = False) -> Any:
    """A value as JSON has it: results by their own object, other data classes by their fields.

    Arguments:
        gaps: numbers that are not finite stand for what is not there, and become null.
    """
    if hasattr(value, "to_dict"):
        return value.to_dict()
    if is_dataclass(value):
        return {item.name: plain(getattr(value, item.name), gaps) for item in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(item, gaps) for key, item in value.items()}
    if hasattr(value, "_asdict"):  # a named tuple
        return plain(value._asdict(), gaps)
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist(), gaps)
    if isinstance(value, (list, tuple)):
        return [plain(item, gaps) for item in value]
    return None if gaps and isinstance(value, float) and not math.isfinite(value) else value
