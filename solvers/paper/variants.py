"""The paper's scenes and their variants: choices that the paper leaves open, each changed alone."""

from collections.abc import Mapping
from typing import Any

from ..scene.scene import Scene

BRIDGED, DRY, PENDULUM = "granulation", "granulation-dry-bridge", "pendulum"
AS_PRINTED = "preset"

_SHARED: dict[str, dict[str, Any]] = {
    "log film": {"model.tangential": "film"},
    "glass film-corrected": {"model.glass": "film-corrected"},
}
BRIDGE_VARIANTS: Mapping[str, dict[str, Any]] = {
    AS_PRINTED: {},
    **_SHARED,
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


_TANGENTIAL = {"immersed": "cut off at the particle radius", "film": "cut off at the film's edge"}
_GLASS = {"literal": "", "film-corrected": " above that at the rim"}


def described(scene: Scene) -> str:
    """The choices that the paper leaves open: lever arm, lubrication, glass criterion; bridge law or strings."""
    model = scene.model
    text = f"lever arm at mid-gap, tangential lubrication {_TANGENTIAL[model.tangential]}, glass transition where the "
    text += f"film pressure on the axis{_GLASS[model.glass]} reaches p_gt"
    if scene.bridge is not None:
        text += f"; {scene.bridge.law}"
    if scene.pendulum is not None:
        text += f"; {scene.pendulum.law} strings, l = {scene.pendulum.length:g} m"
    return text
