"""JSON objects of results: declared keys, and where the numbers come from."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cache
from operator import attrgetter
from typing import Any, ClassVar, dataclass_transform

import numpy as np

from ..formatting.tables import NotebookTable
from .items import documented, item
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


@dataclass_transform(frozen_default=True, field_specifiers=(item, field))
class Record:
    """A frozen dataclass that has a JSON object and declared items, whose meanings its docstring gets.

    `_keys` are the keys of the object in order, `key` or `key=attribute`; else they are the fields. The origin of its
    scene follows.

    Arguments:
        of: what stands before the names of its fields in `DEFINITIONS`, as "energy.".
    """

    _keys: ClassVar[str] = ""
    __dataclass_fields__: ClassVar[dict[str, Any]]  # for type checkers

    def __init_subclass__(cls, kw_only: bool = False, of: str = "") -> None:
        dataclass(frozen=True, kw_only=kw_only)(cls)
        cls.__doc__ = documented(cls, of)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of the command: SI units and radians, null where there is no value."""
        keys = self._keys or " ".join(entry.name for entry in fields(self) if entry.name != "scene")
        pairs = [key.partition("=") for key in keys.split()]
        scene = getattr(self, "scene", None)
        provenance = origin(scene) if isinstance(scene, Scene) else {}
        present = [(key, name or key) for key, _, name in pairs if key not in self._absent]
        return {key: plain(attrgetter(name)(self)) for key, name in present} | provenance

    @property
    def _absent(self) -> Collection[str]:
        """Keys that the JSON object has not."""
        return ()


class Result(Record, NotebookTable):
    """A record with a text, which a notebook shows as a table."""


def plain(value: Any, gaps: bool = False) -> Any:
    """A value as JSON has it: results by their own object, other data classes by their fields.

    Arguments:
        gaps: numbers that are not finite stand for what is not there, and become null.
    """
    if hasattr(value, "to_dict"):
        return value.to_dict()
    if is_dataclass(value):
        return {entry.name: plain(getattr(value, entry.name), gaps) for entry in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(member, gaps) for key, member in value.items()}
    if hasattr(value, "_asdict"):  # a named tuple
        return plain(value._asdict(), gaps)
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist(), gaps)
    if isinstance(value, (list, tuple)):
        return [plain(member, gaps) for member in value]
    return None if gaps and isinstance(value, float) and not math.isfinite(value) else value
