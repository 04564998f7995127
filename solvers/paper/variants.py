"""The paper's scenes and their variants: choices that the paper leaves open, each changed alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..scene.scene import Scene

BRIDGED, DRY, PENDULUM = "granulation", "granulation-dry-bridge", "pendulum"
AS_PRINTED = "preset"

_SHARED: dict[str, dict[str, Any]] = {
    "arm surface": {"model.arm": "surface"},
    "log film": {"model.tangential": "film"},
    "glass film-corrected": {"model.glass": "film-corrected"},
}
BRIDGE_VARIANTS: Mapping[str, dict[str, Any]] = {
    AS_PRINTED: {},
    **_SHARED,
    "arm surface, log film": {**_SHARED["arm surface"], **_SHARED["log film"]},
    "mikami-log10": {"bridge.law": "mikami-log10"},
}
STRING_VARIANTS: Mapping[str, dict[str, Any]] = {
    AS_PRINTED: {},
    **_SHARED,
    "l = 0.4 m": {"pendulum.length": "0.4 m"},
    "l = 0.7 m": {"pendulum.length": "0.7 m"},
    "l = 1 m": {"pendulum.length": "1 m"},
    "small-angle strings": {"pendulum.law": "small-angle"},
}


def variant(preset: str, changes: Mapping[str, Any]) -> Scene:
    """A preset with some entries changed."""
    return Scene.load(preset).with_entries(changes)


def described(scene: Scene) -> str:
    """Text of a scene's choices that the paper leaves open: lever arm, logarithm and glass; bridge law or strings."""
    said = ", ".join((scene.model.arm, scene.model.tangential, scene.model.glass))
    if scene.bridge is not None:
        said += f"; {scene.bridge.law}"
    if scene.pendulum is not None:
        said += f"; {scene.pendulum.law} strings, l = {scene.pendulum.length:g} m"
    return said
