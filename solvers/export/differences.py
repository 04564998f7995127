"""Differences between two models: terms of their equations, entries of their scenes, and outcomes on a map."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...generated.automaton import OUTCOMES
from ..errors import InputError, did_you_mean
from ..formatting.tables import aligned
from ..host import bounded
from ..host.emitted import text, with_imports
from ..many.collide_many import collide_many
from ..model.key import ModelKey
from ..model.model import select_model
from ..scene.origin import Result, origin, plain, release
from ..scene.scene import Scene
from ..scene.scenefile import PRESETS, written
from ..scene.schema import MEETING
from ..scene.user_model import Package
from ..scene.user_model_source import open_package

if TYPE_CHECKING:
    from ...derive.emit.compare import Change

LIBRARY = "library"
_SIDE, _DECADE, _STEEPEST = 61, 10.0, math.radians(85)  # of the map: impacts along it, St over the scene's, angle


@dataclass(frozen=True)
class Side:
    """One of the two models: texts of its emitted modules by name, and its scene if it can be computed."""

    name: str
    modules: dict[str, str]
    scene: Scene | None


class OnMap(NamedTuple):
    """What differs on a map: impacts by outcome with either model, and the largest other change of e_n, with place."""

    stokes: tuple[float, float]  # lowest and highest
    angle: tuple[float, float]  # rad
    impacts: int
    moved: tuple[tuple[str, str, int], ...]
    farthest: tuple[float, float, float] | None

    def __str__(self) -> str:
        low, high = map(math.degrees, self.angle)
        number = sum(count for *_, count in self.moved)
        text = "on the map St {:.4g} to {:.4g}, ".format(*self.stokes) + f"{low:g} to {high:g} deg, "
        text += f"{number} of {self.impacts} impacts change outcome"
        text += f" ({', '.join(f'{a} -> {b} {count}' for a, b, count in self.moved)})" * bool(number)
        if self.farthest and self.farthest[0]:
            off, stokes, angle = self.farthest
            at = f"at St {stokes:.4g}, {math.degrees(angle):.4g} deg"
            text += f";\nwhere they do not, e_n differs by at most {abs(off):.2g}, {at}"
        return text


class Differences(Result):
    """The differences; without a map where the models are not computed."""

    names: tuple[str, str]
    changes: tuple[Change, ...]
    on_map: OnMap | None = None
    scenes: tuple[Scene, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """The JSON object: names and entries of A and B, terms that differ as text, effects on the map."""
        changes = [
            {"equation": change.equation, "before": _text(change.before), "after": _text(change.after)}
            for change in self.changes
        ]
        entries = [origin(scene)["scene"] for scene in self.scenes]
        on_map = plain(self.on_map)
        return {"names": self.names, "on_map": on_map, "changes": changes, "version": release(), "scenes": entries}

    def __str__(self) -> str:
        from ...derive.emit.compare import count, in_lines  # imports sympy

        names = [scene.name for scene in self.scenes] or [""] * 2
        sides = zip("AB", self.names, names, strict=True)
        lines = [f"{side}: {model}" + f", in the scene {name}" * (name not in model) for side, model, name in sides]
        lines += ["", count(self.changes) + (":" if self.changes else ""), *in_lines(self.changes)]
        if entries := list(_entries(self.scenes)):
            lines += ["", "entries that differ:", "", *aligned([("entry", "A", "B"), *entries])]
        return "\n".join([*lines, "", str(self.on_map)] if self.on_map else lines)


def _text(term: Any) -> str | None:
    return None if term is None else str(term)


def _entries(scenes: Sequence[Scene]) -> Iterator[tuple[str, str, str]]:
    """Name and both values of entries that differ, as the scenes give them; impacts apart."""
    given = [dict(scene.given) for scene in scenes]
    values = [scene.entries for scene in scenes]
    for name in dict.fromkeys(name for side in values for name in side):
        first, other = (side.get(name) for side in values)
        if first != other and name not in MEETING:
            before, after = ("-" if name not in side else str(written(name, side[name])) for side in given)
            yield name, before, after


def differences(old: str, new: str, probe: str = "granulation", changes: dict[str, str] | None = None) -> Differences:
    """Compare two models; InputError for an argument that is none of these.

    Arguments:
        old, new: `library`, a preset, a scene file, a model's folder or file, or a folder of `generate`.
        probe: the scene into which models are put for the compared map.
        changes: entries to change in the second scene.
    """
    from ...derive.emit.compare import compare, equations  # imports sympy
    from ...derive.emit.read import ReadError

    sides = _sides(old, new, probe, changes or {})
    try:
        equation_changes = compare(*(equations(side.modules) for side in sides))
    except ReadError as error:
        raise InputError(
            "diff", None, "folders as `wetdoublet generate` emits them", f"cannot be read: {error}"
        ) from None
    scenes = tuple(side.scene for side in sides if side.scene is not None)
    names = sides[0].name, ", ".join([sides[1].name, *(f"{name} = {value}" for name, value in (changes or {}).items())])
    if len(scenes) < 2:
        return Differences(names, equation_changes)
    return Differences(names, equation_changes, _on_map(scenes), scenes)


def _sides(source: str, other: str, probe: str, changes: dict[str, str]) -> tuple[Side, Side]:
    if bounded.is_folder(source) and bounded.is_folder(other):
        try:
            packages = [open_package(source, "A"), open_package(other, "B")]
        except InputError:  # perhaps of another version: compare emitted texts, compute nothing
            return Side(source, _folder(source), None), Side(other, _folder(other), None)
        first, second = (Scene.load(probe, package) for package in packages)
    else:
        first, second = _scene(source, probe, "A"), _scene(other, probe, "B")
    second = second.with_entries(changes)
    return Side(source, _modules(first), first), Side(other, _modules(second), second)


def _scene(source: str, probe: str, label: str) -> Scene:
    if source == LIBRARY:
        return Scene.load(probe)
    if bounded.is_folder(source) or source.endswith(".py"):
        return Scene.load(probe, open_package(source, label))
    if source not in PRESETS and not bounded.exists(source):
        names = (LIBRARY, *PRESETS)
        accepted = f"{', '.join(names)}, a scene file, a folder of `generate`, or MODEL.py"
        raise InputError(label, source, accepted, "is none of these" + did_you_mean(source, names))
    return Scene.load(source)


def _modules(scene: Scene) -> dict[str, str]:
    """Emitted texts of the structure and laws of a scene's oblique collisions."""
    choice = select_model(scene, oblique=True, full=True)
    texts = {"": _structure(choice)}
    for slot, name in choice.laws:
        texts[slot] = _law(choice.package, slot, name)
    if choice.package is not None and choice.package.manifest["scaling"]:
        texts["scaling"] = choice.package.text_of("scaling.py")
    return texts


def _structure(choice: ModelKey) -> str:
    package = choice.package
    if package is not None and package.changes(tuple(slot for slot, _ in choice.laws)):
        return package.structure_text(choice.structure)
    return text(choice.structure)


def _law(package: Package | None, slot: str, name: str) -> str:
    if package is not None and name in package.laws(slot):
        return package.text_of(package.law_file(slot, name))
    return text(f"laws.{slot}_{name.replace('-', '_')}")


def _folder(path: str) -> dict[str, str]:
    """Texts of every law, structure and scaling in a folder written by `generate`."""
    folder = Path(path)
    accepted = "a folder made by `wetdoublet generate --out DIR`"
    try:
        listed = json.loads(bounded.text(folder / "manifest.json"))["files"]
        others = ("__init__.py", "assemble.py", "automaton.py", "model.py")  # which hold no equations
        names = [name for name in listed if name.endswith(".py") and not name.endswith(others)]
        texts = {name.removesuffix(".py"): bounded.text(folder / name) for name in names}
        return {name: with_imports(module, texts.__getitem__) for name, module in texts.items()}
    except (AttributeError, OSError, ValueError, KeyError, TypeError, SyntaxError):
        raise InputError("diff", path, accepted, "holds nothing emitted") from None


def _on_map(scenes: Sequence[Scene]) -> OnMap:
    stokes = (scenes[0].stokes or 1.0) * np.geomspace(1 / _DECADE, _DECADE, _SIDE)
    angle = np.linspace(0, _STEEPEST, _SIDE)
    first, other = (collide_many(scene, stokes=stokes[:, None], angle=angle) for scene in scenes)
    before, after = first["outcome"].values, other["outcome"].values
    mask = (before >= 0) & (after >= 0)
    pairs, counts = np.unique(np.stack([before, after])[:, mask & (before != after)], axis=1, return_counts=True)
    moved = tuple((OUTCOMES[a], OUTCOMES[b], int(n)) for a, b, n in zip(*pairs, counts, strict=True))
    off = np.where(mask & (before == after), other["restitution"].values - first["restitution"].values, np.nan)
    at = None if np.isnan(off).all() else np.unravel_index(np.nanargmax(np.abs(off)), off.shape)
    farthest = None if at is None else (float(off[at]), float(stokes[at[0]]), float(angle[at[1]]))
    ends = [(float(values[0]), float(values[-1])) for values in (stokes, angle)]
    return OnMap(ends[0], ends[1], int(mask.sum()), moved, farthest)
