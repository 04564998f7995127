"""A user's model: the output of `wetdoublet generate MODEL.py --out DIR`, verified before use.

A `Package` is identified by its manifest: the laws for slots and the quantities that scenes give in `[custom]`. Code is
read from its folder when a collision needs it, and only if the file has the digest given in the manifest.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

from ..errors import InputError, did_you_mean
from ..host import bounded
from ..host.emitted import LAWS, derived_once, executed
from .fields import Field, Raw
from .schema import FIELDS, TABLES
from .user_model_declared import TABLE, OwnCriterion, OwnEvent, Terms, field_of

ACCEPTED = "a folder made by `wetdoublet generate MODEL.py --out DIR`, or a model file MODEL.py"
ENTRIES = {entry.slot: name for name, entry in FIELDS.items() if entry.slot} | {"attraction": "attraction.law"}
"""Slot -> the scene's entry that says which law fills it, where scenes have one."""


@dataclass(frozen=True)
class Package:
    """A user's model as part of a scene.

    Arguments:
        text: the manifest, JSON.
        folder: the folder of the files, or the model file that they were derived from.
        files: texts by path, if the files are not in a folder.

    A model that is only described, as in a map file, has neither folder nor files.
    """

    text: str = field(repr=False)
    folder: Path | None = field(default=None, compare=False)
    files: Mapping[str, str] | None = field(default=None, compare=False, repr=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the arguments, not the loaded modules; a worker verifies the files again."""
        return Package, (self.text, self.folder, self.files)

    @cached_property
    def manifest(self) -> dict[str, Any]:
        content: dict[str, Any] = json.loads(self.text)
        return content

    @property
    def name(self) -> str:
        return str(self.manifest["name"])

    @cached_property
    def digest(self) -> str:
        return hashlib.sha256(self.text.encode()).hexdigest()

    # ---- entries of scenes

    @cached_property
    def fields(self) -> dict[str, Field]:
        """Entries of a scene with this model: the library's, with the model's laws added, and `[custom]`."""
        result = dict(FIELDS)
        if self.table != TABLE:
            return result
        for entry, names in ((ENTRIES.get(slot, ""), names) for slot, names in self._laws.items()):
            if entry in result:
                result[entry] = replace(result[entry], choices={**result[entry].choices, **dict.fromkeys(names, "")})
        for quantity in self.manifest["quantities"]:
            result[f"{TABLE}.{quantity['name']}"] = field_of(quantity)
        return result

    @property
    def table(self) -> str:
        """The table of a scene that has the model's quantities: a user's are custom."""
        return str(self.manifest.get("table", TABLE))

    @property
    def quantities(self) -> tuple[str, ...]:
        return tuple(quantity["name"] for quantity in self.manifest["quantities"])

    @property
    def defaults(self) -> dict[str, Raw]:
        """Entries of `[custom]` that have defaults."""
        values = {f"{TABLE}.{quantity['name']}": quantity["default"] for quantity in self.manifest["quantities"]}
        return {name: value for name, value in values.items() if value is not None}

    def completed(self, entries: Mapping[str, Any]) -> dict[str, Any]:
        return {**entries, **{name: value for name, value in self.defaults.items() if name not in entries}}

    def demand(self, entries: Mapping[str, Any]) -> None:
        """Raise InputError for a missing quantity without a default, or an event that the scene cannot have."""
        turning = next((event.word for event in self.events if event.rotates), None)
        if turning is not None and entries.get("partner.wall"):
            accepted = f"another partner, or a model without the event {turning}"
            raise InputError("partner.wall", True, accepted, "has no rotation, of which this event speaks")
        for name in self.missing(entries):
            raise InputError(name, None, self.fields[name].accepts)

    def missing(self, entries: Mapping[str, Any]) -> tuple[str, ...]:
        """Its quantities without a default that are not among the entries, by dotted name."""
        names = (f"{self.table}.{name}" for name in self.quantities)
        return tuple(name for name in names if name not in entries and self.fields[name].default is None)

    def chosen(self, entries: Mapping[str, Any]) -> dict[str, str]:
        """Entries that select the model's laws; InputError if the scene lacks the table that a law needs."""
        present = {name.partition(".")[0] for name in entries} | {"model"}
        result = {}
        for slot in self._laws:
            entry = ENTRIES.get(slot, "")
            if entry.partition(".")[0] not in present:
                table = entry.partition(".")[0] or slot
                raise InputError(
                    "--model", str(self.folder), f"a scene with a [{table}] table", f"has a law in the slot {slot}"
                )
            if entry in FIELDS and entries.get(entry) not in self.laws(slot):
                result[entry] = self.laws(slot)[0]
        return result

    @property
    def unnamed(self) -> tuple[str, ...]:
        """Slots of the model's laws that no entry of a scene selects."""
        return tuple(slot for slot in self._laws if ENTRIES.get(slot) not in FIELDS)

    # ---- emitted code

    @cached_property
    def _laws(self) -> dict[str, dict[str, dict[str, Any]]]:
        """The laws as the manifest has them, by slot and name."""
        slots: dict[str, dict[str, dict[str, Any]]] = {}
        for law in self.manifest["laws"]:
            slots.setdefault(law["slot"], {})[law["name"]] = law
        return slots

    def laws(self, slot: str) -> tuple[str, ...]:
        """Names of the model's laws for a slot; the first is the default."""
        return tuple(self._laws.get(slot, ()))

    def features(self, slot: str, name: str) -> tuple[str, ...]:
        """Functions that not every law of the slot has, and properties, of a law of the model or of the library."""
        own = self._laws.get(slot, {}).get(name)
        return tuple(LAWS[slot].get(name, ()) if own is None else own.get("features", ()))

    def extra(self, slot: str, function: str) -> tuple[str, ...]:
        """States and groups that a slot's function takes in addition to the slot's arguments."""
        return tuple(self.manifest["extra"].get(f"{slot}.{function}", ()))

    @cached_property
    def events(self) -> tuple[OwnEvent, ...]:
        return tuple(OwnEvent.from_manifest(entry) for entry in self.manifest.get("events", ()))

    @cached_property
    def terms(self) -> Terms | None:
        entry = self.manifest.get("terms")
        return None if entry is None else Terms(entry["rotates"], entry["drives"], entry["admits_barrier"])

    @cached_property
    def criteria(self) -> tuple[OwnCriterion, ...]:
        return tuple(OwnCriterion(**entry) for entry in self.manifest.get("criteria", ()))

    def touched(self, groups: Mapping[str, float]) -> str:
        """The word of the gap at which the solids meet by roughness or by a declared criterion, at these groups."""
        own = max(self.criteria, key=lambda criterion: groups[criterion.group], default=None)
        return own.word if own is not None and 0 < groups["rough_gap"] <= groups[own.group] else "rough"

    @property
    def bends(self) -> bool:
        """It declares what no margin, and no curve of an atlas, is known beside: events, terms or criteria."""
        return bool(self.events or self.criteria) or self.terms is not None

    def check_terms(self, structure: str) -> None:
        """InputError if the terms do not apply in a structure."""
        parts, terms = structure.split("_"), self.terms
        if terms is None:
            return
        if structure.startswith("head_on") and terms.drives:
            problem = "of a model whose terms turn what does not turn"
            raise InputError("impact.angle", "0 deg", "an angle above 0, or a spin", problem)
        other = next((name for name in ("pair", "wall", "space", "friction") if name in parts), None)
        if other is not None and terms.rotates:
            accepted = "equal spheres without friction in a plane, or terms of x and u on the gap"
            raise InputError("model", self.name, accepted, f"has terms on a rotation, which a {other} has not alone")

    def events_in(self, structure: str) -> tuple[OwnEvent, ...]:
        """The events that a structure can have: it needs their rotations, and the spin as a state if they change it."""
        head_on = structure.startswith("head_on")
        wall, reduced = (word in structure.split("_") for word in ("wall", "reduced"))
        return tuple(
            event
            for event in self.events
            if not ((event.turns and head_on) or (event.rotates and wall) or (event.spins and reduced))
        )

    @property
    def words(self) -> tuple[str, ...]:
        """Words by which results report the declared events; in the kernel they follow the library's."""
        return tuple(event.row.words[0] for event in self.events)

    def automaton_headers(self) -> tuple[str, str]:
        """C headers of the automaton with the declared events, for the kernel; derived on first use."""
        automaton = self._derived("automaton.h", "user_automaton_text", False)
        return automaton, self._derived("effects.h", "user_automaton_text", True)

    def changes(self, slots: tuple[str, ...]) -> bool:
        """True if this model changes the structure with these slots."""
        return bool(self.events) or self.terms is not None or bool(self.criteria) or self.widens(slots)

    def widens(self, slots: tuple[str, ...]) -> bool:
        """True if this model passes more arguments to the laws in these slots."""
        return bool({key.partition(".")[0] for key in self.manifest["extra"]} & set(slots))

    def law(self, slot: str, name: str) -> ModuleType:
        file = self.law_file(slot, name)
        return _module(self, file)

    def law_file(self, slot: str, name: str) -> str:
        """Path of one of the model's laws, relative to the folder."""
        return str(self._laws[slot][name]["file"])

    def text_of(self, path: str) -> str:
        """Text of one of the files, verified but not executed."""
        return self._verified(path).decode()

    def structure(self, name: str) -> ModuleType:
        """The module of a structure that the model changes; derived on first use if not emitted."""
        if name in self.manifest["structures"]:
            return _module(self, f"{name}.py")
        text = self.structure_text(name).encode()
        return executed(f"wetdoublet_model_{self.digest[:12]}.{name}", text)

    def structure_text(self, name: str) -> str:
        """Text of the module of a structure that the model changes."""
        if name in self.manifest["structures"]:
            return self.text_of(f"{name}.py")
        return self._derived(f"{name}.py", "user_structure_text", name)

    def structure_header(self, name: str, tangent: bool = False) -> str:
        """C header of a structure that the model changes, or of its tangent, for the kernel; derived on first use."""
        kind = "tangent-" if tangent else ""
        return self._derived(f"{kind}{name}.h", "user_structure_header_text", name, tangent)

    def law_header(self, slot: str, name: str, slopes: bool = False) -> str:
        """C header of a law as called by its structures, or of its derivatives; derived on first use."""
        kind = "slopes-" if slopes else ""
        return self._derived(f"{kind}{slot}_{name}.h", "user_law_header_text", slot, name, slopes)

    def _derived(self, file: str, function: str, *arguments: str | bool) -> str:
        """Text of a file that was not emitted, by a function of `derive.emit.first_use` that takes a model."""
        return derived_once(f"{self.digest[:16]}-{file}", function, self.source, self.name, *arguments)

    @cached_property
    def groups(self) -> dict[str, tuple[tuple[str, ...], Callable[..., Any]]]:
        """Groups of the model: name -> the quantities that its function takes, in order, and the function."""
        if not self.manifest["scaling"]:
            return {}
        scaling = _module(self, "scaling.py")
        return {name: (arguments, getattr(scaling, name)) for name, arguments in scaling.ARGUMENTS.items()}

    @property
    def plain(self) -> tuple[str, ...]:
        """Quantities of the model that are dimensionless groups as they are."""
        return tuple(item["name"] for item in self.manifest["quantities"] if item["group"] == item["name"])

    def group(self, quantity: str) -> str:
        """The name of a quantity's dimensionless group."""
        return next(str(item["group"]) for item in self.manifest["quantities"] if item["name"] == quantity)

    @property
    def source(self) -> str:
        """Text of the model file that the package was emitted from."""
        return self.text_of("model.py")

    def _verified(self, path: str) -> bytes:
        """Content of one of the files; InputError if its digest is not that of the manifest."""
        if self.folder is None:
            raise InputError("--model", self.name, ACCEPTED, "is only described here, its files are not at hand")
        file = self.folder / path
        content = None if self.files is None else self.files.get(path, "").encode()
        with suppress(InputError):
            content = bounded.read(file, bounded.LARGEST, "file", ACCEPTED) if content is None else content
        if content is None or hashlib.sha256(content).hexdigest() != self.manifest["files"].get(path):
            raise InputError(str(file), None, f"files as they were emitted: {self.remedy}", "is not what was emitted")
        return content

    @property
    def remedy(self) -> str:
        return f"run `wetdoublet generate {self.original or 'MODEL.py'} --out {self.folder}`"

    @property
    def original(self) -> Path | None:
        """Path of the model file that the package was emitted from, which may no longer exist."""
        origin = self.manifest["origin"]
        return Path(os.path.normpath(self.folder / origin)) if origin and self.folder is not None else None


@lru_cache(maxsize=256)
def _module(package: Package, path: str) -> ModuleType:
    content = package._verified(path)  # noqa: SLF001 # the same room
    dotted = path.removesuffix(".py").replace("/", ".")
    module = executed(f"wetdoublet_model_{package.digest[:12]}.{dotted}", content)
    digest = package.manifest["structures"].get(dotted)
    if digest is not None and digest != module.DIGEST:
        raise InputError(path, module.DIGEST, package.remedy, "comes from other equations than the manifest says")
    return module


def features(package: Package | None, slot: str, name: str) -> tuple[str, ...]:
    """The features of a law of the library or of a user's model."""
    return tuple(LAWS[slot].get(name, ())) if package is None else package.features(slot, name)


def fields(package: Package | None) -> Mapping[str, Field]:
    """All entries that a scene with this model may have."""
    return FIELDS if package is None else package.fields


def unknown(name: str, value: object, package: Package | None) -> InputError:
    """The error for an unknown entry, with the nearest known one."""
    table, _, key = name.partition(".")
    if table == TABLE and (package is None or package.table != TABLE):
        accepted = "a scene without [custom], or its model: --model DIR, Scene.load(..., model=DIR)"
        return InputError(name, value, accepted, "is a model's, and no model is given")
    if table == TABLE and package is not None:
        names = [f"{TABLE}.{quantity}" for quantity in package.quantities]
        accepted = ", ".join(names) or f"nothing: the model {package.name} declares no quantity"
        return InputError(name, value, accepted, "has an unknown name" + did_you_mean(name, names))
    here = TABLES.get(table, ())
    if here and not key:
        return InputError(name, value, ", ".join(here), "is given to a table, not to one of its entries")
    elsewhere = [entry for entry in FIELDS if entry.endswith("." + (key or table))]
    hint = f", did you mean {elsewhere[0]}?" if elsewhere else did_you_mean(name, here) or did_you_mean(name, FIELDS)
    accepted = ", ".join(here) if here else "entries TABLE.KEY of the tables " + ", ".join(TABLES)
    return InputError(name, value, accepted, "has an unknown name" + hint)
