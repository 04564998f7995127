"""A scene: two particles, their liquid film and the forces that act on them; immutable and validated."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, Self

from ..errors import InputError
from ..formatting.tables import NotebookTable
from ..host.arguments import check_mapping
from . import entry_rules as rules
from . import scenefile
from .fields import Field, Raw
from .groups import System, check_criteria, natural
from .held import adjusted_impact, held_quantity, impact_quantity
from .liquids import is_named, liquid
from .quantities import SHADOW, Ways, coating_fraction, tables
from .schema import FIELDS, LEAST_ANGLE, LIQUIDS, NEWTONIAN, SPEEDS, TABLES, Impact
from .user_model import Package, fields
from .user_model_source import liquid_package, open_package

_SMALLER = (1.0, 0.1, 0.01)  # parts of the value at which a quantity's group is 1: a criterion's gap is below the film


@dataclass(frozen=True)
class Scene(System, NotebookTable):
    """A colliding pair and its impact, in SI units and radians.

    A scene stores its entries as the file or the caller gave them; the tables are derived from those, so the two cannot
    disagree. Two scenes are equal if their names and SI entries are.

    Arguments:
        name: any text, may be empty.
        given: (dotted name, value) in the order of the file; text carries its unit, a plain number is SI.
        comments: (dotted name, comment) of the file; `assumed ...` marks an assumed value.
        package: a user's model, whose quantities and laws the entries may name.
        held: what stayed of the impact when other entries changed (`with_entries`), in words; empty where all did.

    Raises:
        InputError: names the first wrong entry, its value, and what is accepted.

    >>> from wetdoublet import Scene
    >>> scene = Scene.load("granulation").with_entries({"liquid.viscosity": "3 Pa s"})
    >>> scene.liquid.viscosity
    3.0
    """

    def __post_init__(self) -> None:
        """Read the tables and check the rules."""
        rules.check_arguments(self.name, self.given, self.comments, self.package)
        entries = _grouped(dict(self.given))
        rules.refuse(rules.liquid_rules(entries, self.package), entries)
        law, package = entries.get("liquid.law", NEWTONIAN), self.package
        if package is None or package.table == "liquid":
            package = None if law == NEWTONIAN else liquid_package(law)
        if package is not None:
            entries = package.completed(entries)
        values = rules.check_entries(entries, package)
        rules.refuse(rules.missing(entries), entries)
        schema = fields(package)
        entries = {name: self._canonical(schema[name], raw) for name, raw in entries.items()}
        rules.refuse(rules.way_rules(entries, values), entries)
        ways = Ways.of(entries)
        chosen = {
            "package": package,
            "given": tuple(entries.items()),
            "ways": ways,
            "comments": tuple((name, text) for name, text in self.comments if name in entries),
            "si": tuple(values.items()),
            **tables(values, ways),
        }
        for name, value in chosen.items():
            object.__setattr__(self, name, value)
        for rule in rules.TOGETHER:
            rules.refuse(rule(self), self.given)
        check_criteria(self, self.speed)

    # ---- reading and writing

    @classmethod
    def load(
        cls, source: str | Path | Scene, model: str | Path | Package | None = None, free: Sequence[str] | str = ()
    ) -> Scene:
        """Return the scene of a file or preset; a Scene is returned as it is.

        Arguments:
            model: folder of a user's model (`wetdoublet generate MODEL.py --out DIR`), or the model file.
            free: entries that are looked for. A quantity of the model among them needs no value; it begins where its
                group is 1.

        Raises:
            InputError: no such file or preset (the nearest is named), broken TOML (file and line), bad entry.
        """
        if isinstance(source, Scene):
            if model is not None:
                return source.with_model(model)
            if (package := source.package) is not None:
                source = _with_first_values(source, free)
                package.demand(source.entries)
            return source
        text, origin = scenefile.read_text(source)
        if model is None:
            return _read(text, origin)
        package, tables = open_package(model, "model"), scenefile.parse(text, str(origin))
        entries = scenefile.flatten(tables, package)
        rules.check_entries(entries, package, from_file=True)
        for name, law in package.chosen(entries).items():  # before laws and tables are judged together
            table, _, key = name.partition(".")
            tables.setdefault(table, {})[key] = law
        return cls.from_dict(tables, from_file=True, comments=scenefile.remarks(text), package=package)

    @classmethod
    def from_toml(cls, text: str, origin: str = "scene", package: Package | None = None) -> Self:
        """Return the scene written in TOML; `origin` names the text in errors."""
        tables = scenefile.parse(text, str(origin))
        return cls.from_dict(tables, from_file=True, comments=scenefile.remarks(text), package=package)

    @classmethod
    def from_dict(
        cls,
        tables: Mapping[str, Any],
        *,
        from_file: bool = False,
        comments: Mapping[str, str] | None = None,
        package: Package | None = None,
    ) -> Self:
        """Return the scene of nested tables, `{"liquid": {"viscosity": "2 Pa s", ...}, ...}`.

        Plain numbers are SI and radians, unless they come from a file, where a quantity must carry its unit.
        """
        rules.check_arguments("", (), (), package)
        check_mapping(tables, "tables", "{'liquid': {'viscosity': '2 Pa s', ...}, ...}")
        check_mapping({} if comments is None else comments, "comments", "texts by dotted name")
        entries = scenefile.flatten(tables, package)
        rules.check_entries(entries, package, from_file=from_file)
        rules.refuse(rules.missing(entries, tables), entries)
        return cls(tables.get("name", ""), tuple(entries.items()), tuple((comments or {}).items()), package)

    def to_toml(self) -> str:
        """Return the scene as a TOML file, with units as given and comments on assumed values."""
        return self._written

    @cached_property
    def _written(self) -> str:
        """The scene file, cached because every result carries it; equal scenes may differ in units."""
        remarks = {f"impact.{impact_quantity(self)}": self.held} if self.held else {}
        return scenefile.write(self.name, dict(self.given), remarks | dict(self.comments))

    def to_dict(self) -> dict[str, Any]:
        """Return the nested tables as in a scene file (text carries units)."""
        tables: dict[str, Any] = {"name": self.name} if self.name else {}
        for entry, value in self.given:
            table, _, key = entry.partition(".")
            tables.setdefault(table, {})[key] = scenefile.written(entry, value)
        return tables

    def __str__(self) -> str:
        """The scene as a table: entries with their units, defaults and assumptions, and what follows from them."""
        from .listing import text

        return text(self)

    @property
    def custom(self) -> Mapping[str, Raw]:
        """Quantities declared by a user's model: name -> value with its unit, given or default."""
        return {name.partition(".")[2]: value for name, value in self.given if name.startswith("custom.")}

    def _canonical(self, entry: Field, raw: object) -> Raw:
        """A value as a scene stores it; a quantity of a user's model with its unit."""
        value = entry.canonical(raw)
        with_unit = entry.name not in FIELDS and entry.unit and not isinstance(value, str)
        return f"{value!r} {entry.unit}" if with_unit else value

    @property
    def guesses(self) -> tuple[tuple[str, str], ...]:
        """The comments on entries that are guesses: (dotted name, `assumed ...`)."""
        return tuple((name, text) for name, text in self.comments if re.match(r"assumed\b", text))

    @property
    def assumed(self) -> tuple[str, ...]:
        """One line for each assumed value of this scene."""
        entries = dict(self.given)
        sentences = [f"{name} = {scenefile.written(name, entries[name])} ({text})" for name, text in self.guesses]
        return (*sentences, *self._flowing(), *self._liquid())

    def _liquid(self) -> tuple[str, ...]:
        """The lines on a viscosity that is given by a liquid's name, and on where a liquid that thins has it."""
        text = dict(self.given)["liquid.viscosity"]
        lines = (f'liquid.viscosity = "{text}" ({liquid(str(text)).origin})',) if is_named(text) else ()
        if self.package is None or self.package.table != "liquid":
            return lines
        name, where = "liquid.reference_rate", "at rest"
        if "reference_rate" in LIQUIDS[self.package.name.replace("_", "-")]:
            default = "" if name in self.entries else " (default)"
            where = f"at {name} = {self.entries.get(name, FIELDS[name].default):.6g} 1/s{default}"
        return (*lines, f"liquid.viscosity is that {where}; St and Ca are of it, not of the rates in the film")

    def _flowing(self) -> tuple[str, ...]:
        """The line on the part of the coatings that is assumed to flow into the bridge; none if its volume is given."""
        if self.bridge is None or self.ways.volume != "coating":
            return ()
        fraction, ratio = self.entries.get("bridge.coating_fraction"), self.radius_ratio
        if fraction is not None:
            text = f"{fraction:.3g} of each coating"
        elif ratio is None:
            text = f"0.5 of the sphere's coating and the wall's layer beneath the sphere, {SHADOW}"
        elif ratio == 1:
            text = f"{coating_fraction(ratio):.3g} of each coating, {SHADOW}"
        else:
            parts = f"{coating_fraction(ratio):.3g} and {coating_fraction(1 / ratio):.3g}"
            text = f"{parts} of the coatings, {SHADOW}"
        return (f"bridge.volume = {self.bridge.volume:.4g} (assumed: {text})",)

    # ---- changed copies

    def with_model(self, model: str | Path | Package) -> Self:
        """Return the scene with a user's model: its laws fill their slots, its quantities take their defaults.

        Later changes (`with_entries({"bridge.law": "willett"})`) override these choices.

        Raises:
            InputError: no such model, a stale one, or a scene without the table that a law needs.
        """
        package = open_package(model, "model")
        old = {
            name: value for name, value in self.given if name.partition(".")[0] != "custom" or package == self.package
        }
        entries = {**old, **package.chosen(old)}
        return type(self)(self.name, tuple(entries.items()), self.comments, package, self.held)

    def with_entries(self, changes: Mapping[str, Any], hold: str | None = None) -> Self:
        """Return the scene with entries replaced or added, by dotted name; text carries its unit.

        Arguments:
            hold: quantity of the impact that stays, "speed", "stokes" or "relative_speed"; None for the relative speed
                where the scene gives that, else the normal speed. Without effect where `changes` names one of them.
        """
        changes = dict(check_mapping(changes, "changes", "entries by dotted name, {'liquid.viscosity': '3 Pa s'}"))
        name = changes.pop("name", self.name)
        rules.check_entries(changes, self.package)
        rules.check_replaced(dict(self.given), changes)
        hold, quantity = held_quantity(self, hold), impact_quantity(self)
        comments = tuple((entry, text) for entry, text in self.comments if entry not in changes)
        replaced = not {*SPEEDS}.isdisjoint(changes)
        entries = tuple({**dict(self.given), **changes}.items())
        changed = type(self)(name, entries, comments, self.package, "" if replaced else self.held)
        if replaced or quantity is None:
            return changed
        number, remark = adjusted_impact(self, changed, quantity, hold)
        if not remark:
            return changed
        entry = f"impact.{quantity}"
        read = {entry: number} if number != self.entries[entry] else {}
        entries = tuple((name, read.get(name, raw)) for name, raw in changed.given)
        return changed._at_impact(entries, read, remark)  # noqa: SLF001 # another of its kind

    def with_si(self, changes: Mapping[str, float], hold: str | None = None) -> Self:
        """Return the scene with numbers replaced or added as `si` has them: a volume in m^3 where it is given so."""
        return self.with_entries({name: self.as_given(name, float(value)) for name, value in changes.items()}, hold)

    def si_number(self, name: str, raw: object, label: str) -> float:
        """The number that `raw` gives for an entry, meant as the scene's own: a volume in m^3, or V/R^3.

        Raises:
            InputError: no acceptable number, or a volume where the scene gives V/R^3, or the reverse.
        """
        entry = fields(self.package)[name]
        absolute = bool(entry.or_unit) and self.ways.volume == "absolute"
        if entry.or_unit and entry.with_unit(raw) != absolute:
            own, problem = "a number V/R^3", "is a volume, where the scene gives V/R^3"
            if absolute:
                own, problem = "a volume with its unit", "is V/R^3, where the scene gives a volume"
            raise InputError(label, raw, f"{name} as the scene gives it: {own}", problem)
        return (entry.measured if absolute else entry).number(raw, label=label)

    def as_given(self, name: str, value: Any) -> Any:
        """A number or array as `si` has the entry, in a form that says what it is."""
        if name != "bridge.volume" or self.ways.volume != "absolute":
            return value
        return f"{value!r} m^3" if isinstance(value, float) else [f"{float(number)!r} m^3" for number in value]

    def with_impact(
        self,
        stokes: float | str | None = None,
        speed: float | str | None = None,
        angle: float | str | None = None,
        relative_speed: float | str | None = None,
    ) -> Self:
        """Return the scene with another impact; `stokes`, `speed` or `relative_speed` replaces any of the three.

        Plain numbers are SI and radians. InputError if two of the three are given.
        """
        impact = {"stokes": stokes, "speed": speed, "relative_speed": relative_speed, "angle": angle}
        changes = {f"impact.{name}": value for name, value in impact.items() if value is not None}
        if not changes:
            return self
        read, schema = rules.check_entries(changes, self.package), fields(self.package)
        replaced = {*SPEEDS} - {*changes} if {*changes} - {"impact.angle"} else set()
        entries = {name: value for name, value in self.given if name not in replaced}
        again = changes.keys() <= entries.keys()  # then the order is the same
        entries |= {name: self._canonical(schema[name], raw) for name, raw in changes.items()}
        entries = entries if again else _grouped(entries, {**dict(self.given), **changes})
        return self._at_impact(tuple(entries.items()), read, "" if replaced else self.held)

    def _at_impact(self, entries: tuple[tuple[str, Raw], ...], read: Mapping[str, float | str], held: str) -> Self:
        """Return the scene of these entries, of which only those of the impact differ; what has not changed is kept.

        Equal to the scene that `__post_init__` makes of the same entries, with the rules that concern an impact.

        Arguments:
            read: those that differ, SI.
            held: as of the new scene.
        """
        values = {**dict(self.si), **read}
        unchanged = {name for name, _ in entries} - read.keys()
        si = tuple((name, values[name]) for name, _ in entries)
        result = object.__new__(type(self))
        result.__dict__.update(self.__dict__)
        result.__dict__.pop("_written", None)
        result.__dict__.update(
            given=entries,
            comments=tuple((name, text) for name, text in self.comments if name in unchanged),
            si=si,
            held=held,
            impact=Impact.of(dict(si)),
        )
        rules.refuse(rules.speed_rules(result), entries)
        return result

    def need_impact(self) -> tuple[float, float]:
        """Return (normal speed in m/s, angle in rad or 0 below LEAST_ANGLE); InputError if the scene lacks one."""
        if self.speed is None and self.impact.relative_speed is None:
            accepted = 'stokes = 0.03 or speed = "0.54 m/s" in [impact], or --stokes, --speed, --relative-speed'
            raise InputError("impact.stokes", None, accepted)
        if self.angle is None:
            raise InputError("impact.angle", None, 'angle = "60 deg" in [impact], or --angle "60 deg"')
        assert self.speed is not None  # a relative speed has its normal component, now that there is an angle
        return self.speed, self.angle if self.angle >= LEAST_ANGLE else 0.0


def _with_first_values(scene: Scene, free: Sequence[str] | str) -> Scene:
    """The scene with values of those of its model's quantities that are looked for and have none.

    Who looks for them checks `free` later: until then it may be anything.
    """
    names = free.split(",") if isinstance(free, str) else free if isinstance(free, Sequence) else ()
    result, missing = scene, () if scene.package is None else scene.package.missing(scene.entries)
    for name in (name for name in missing if name in names):
        value = natural(scene, name.partition(".")[2])
        for factor in _SMALLER:
            with suppress(InputError):
                result = result.with_si({name: value * factor})
                break
    return result


@lru_cache(maxsize=32)
def _read(text: str, origin: str) -> Scene:
    """The scene of a TOML text, cached because scenes are immutable."""
    return Scene.from_toml(text, origin)


def _grouped(entries: Mapping[str, Any], like: Iterable[str] = ()) -> dict[str, Any]:
    """Return the entries by table, in order; or as `like` has the tables, with [impact] as the schema has it."""
    order = [*dict.fromkeys(name.partition(".")[0] for name in like or entries)]
    impact = TABLES["impact"] if like else ()

    def place(name: str) -> tuple[int, int]:
        return order.index(name.partition(".")[0]), impact.index(name) if name in impact else 0

    return {name: entries[name] for name in sorted(entries, key=place)}
